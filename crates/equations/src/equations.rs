//! The common form in which a formulation hands over its equations of motion.
//!
//! A state `y` moves by `ẏ = F(t, y, z)`, where `z` (accelerations, multipliers or their rates) solves a
//! small block `R(z; t, y) = 0` at every instant, nearly always linear in `z`. Nothing here steps time.

use std::collections::{BTreeMap, HashMap, HashSet};

use symbolic::{CompileError, Evaluator, Expr, Graph, Matrix, Scalar, Symbol, Tape};

use crate::chart::Chart;
use crate::definitions::{needed, symbols_behind};
use mechanics::{Removal, System};

/// The kind of a state variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// A coordinate `q`.
    Position,
    /// A velocity `v = q̇`.
    Velocity,
    /// A quasi-velocity `w`; the velocities are linear in them.
    QuasiVelocity,
    /// A displacement parameter `u`.
    DisplacementParameter,
    /// The rate `u̇` of a displacement parameter.
    ParameterRate,
    /// The second rate `ü`, a state only where `L` contains it.
    ParameterSecondRate,
    /// The momentum `G_u̇ − d/dt G_ü` that goes with `ü`.
    ParameterMomentum,
    /// A memory variable `w`.
    Memory,
    /// A memory costate `P`.
    MemoryCostate,
    /// A vakonomic multiplier `μ`.
    Multiplier,
    /// A costate `p = ∂𝓛/∂v`.
    Costate,
}

/// One state variable with its rate and its value at the start.
#[derive(Clone, Debug)]
pub struct StateVariable {
    /// Symbol.
    pub symbol: Symbol,
    /// What it is.
    pub role: Role,
    /// `ẏ`, an expression in `(t, y, z)` and the free constants.
    pub rate: Expr,
    /// `y(t₀)`, an expression in `(t₀, q₀, v₀)`, free constants and, with a removal, `(u, u̇, ü, w)` there.
    pub start: Expr,
}

impl StateVariable {
    /// One whose rate, and whose value at the start, are symbols.
    pub fn of(g: &Graph, symbol: Symbol, role: Role, rate: Symbol, start: Symbol) -> Self {
        StateVariable { symbol, role, rate: g.variable(rate), start: g.variable(start) }
    }
}

/// Unknowns `z` of one instant and the equations `R(z; t, y) = 0` that determine them.
#[derive(Clone, Debug)]
pub struct Block {
    /// `z`.
    pub unknowns: Vec<Symbol>,
    /// `R`, as many as unknowns.
    pub residuals: Vec<Expr>,
    /// A value of `z` near the solution at the start, in its symbols; used where `R` is not linear in `z`.
    pub guess: Vec<Expr>,
    /// Name of the matrix or quantity that has to be regular for the block to be solvable.
    pub regular: &'static str,
}

/// A constant that `(q₀, v₀)` does not determine.
#[derive(Clone, Debug)]
pub struct FreeConstant {
    /// Symbol of its value.
    pub symbol: Symbol,
    /// The quantity that vanishes at the horizon under the natural boundary condition, where there is one.
    pub natural: Option<Expr>,
    /// Index of the memory variable whose costate starts here, if it is one.
    pub memory: Option<usize>,
}

impl FreeConstant {
    /// One that no condition at the horizon belongs to.
    pub fn new(symbol: Symbol) -> Self {
        FreeConstant { symbol, natural: None, memory: None }
    }
}

/// A named expression in `(t, y, z)`.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name, ASCII.
    pub name: String,
    /// The expression.
    pub expression: Expr,
}

impl Named {
    /// Symbols, by their own names.
    pub fn symbols(g: &Graph, symbols: &[Symbol]) -> Vec<Self> {
        symbols.iter().map(|&s| Named { name: g.name(s), expression: g.variable(s) }).collect()
    }
}

/// Something that the equations did not need.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// The variables concerned; empty where it is not about variables.
    pub variables: Vec<Symbol>,
    /// What about them, and why.
    pub words: String,
}

/// An equation for the reader: `left = right`.
#[derive(Clone, Debug)]
pub struct Statement {
    /// The meaning of the equation.
    pub meaning: String,
    /// Left-hand side.
    pub left: Expr,
    /// Right-hand side.
    pub right: Expr,
}

/// Return onto the constraint: `v ← v + δv` with the smallest `δvᵀ M δv` such that `f(q, v, t) = 0`.
#[derive(Clone, Debug)]
pub struct ConstraintProjection {
    /// Velocity states that may be moved.
    pub velocities: Vec<Symbol>,
    /// `f`.
    pub constraints: Vec<Expr>,
    /// `A = ∂f/∂v`.
    pub jacobian: Matrix,
    /// `M`, the metric.
    pub metric: Matrix,
}

/// The constraint Jacobian `A = ∂f/∂v` along a motion.
#[derive(Clone, Debug)]
pub struct ConstraintRows {
    /// Rows of `A` in `(t, y, z)`: those whose rank may fall.
    pub jacobian: Matrix,
    /// Numbers of their constraints, from 1.
    pub numbers: Vec<usize>,
    /// Whether there are others that follow from these, and could be taken instead where these lose rank.
    pub replaceable: bool,
    /// Names of the coordinates, in the order of its columns.
    pub coordinates: Vec<String>,
}

/// Equations of motion as a formulation hands them over.
#[derive(Clone)]
pub struct Equations {
    /// Name of the formulation.
    pub formulation: &'static str,
    /// Where all expressions live.
    pub graph: Graph,
    /// Symbol of time.
    pub time: Symbol,
    /// Values of the parameters.
    pub parameters: HashMap<Symbol, f64>,
    /// `L`, `f` and `Q` as they were given: simplification may hide rapidly varying functions, for instance
    /// `1/(1 + u²)`.
    pub given: Vec<Expr>,
    /// Symbols of `q`, then of `q̇`, in these.
    pub own: Vec<Symbol>,
    /// Intermediate quantities in `(t, y, z)` and earlier ones, see [`crate::Definitions`]. Blocks and guards
    /// need only those without `z`.
    pub definitions: Vec<(Symbol, Expr)>,
    /// Definitions that are time derivatives along the motion, with what they are derivatives of: where the
    /// Taylor series of the latter is known one order ahead, it gives that of the former.
    pub derivatives: Vec<(Symbol, Expr)>,
    /// `y` with rates and start.
    pub states: Vec<StateVariable>,
    /// The equations of one instant.
    pub blocks: Vec<Block>,
    /// Constants that the start data leave free.
    pub free_constants: Vec<FreeConstant>,
    /// `q` in `(t, y)`; at first their symbols.
    pub coordinates: Vec<Expr>,
    /// `q̇` in `(t, y, z)`; at first their symbols.
    pub velocities: Vec<Expr>,
    /// Multipliers or costates, whatever the formulation has.
    pub multipliers: Vec<Named>,
    /// Quantities that stay constant along the motion.
    pub invariants: Vec<Named>,
    /// How many of these, the last ones, are the user's own: their names may be any.
    pub watched: usize,
    /// Projection onto the constraint, where the states can leave it.
    pub projection: Option<ConstraintProjection>,
    /// Whether the motion has slip, `f = −λ/N`, instead of exact constraints.
    pub creeps: bool,
    /// Expressions in `(t, y)` whose zero is a singularity of the equations.
    pub guards: Vec<Expr>,
    /// Those of the guards at which formulas, as they were written, cease to have values.
    pub domains: Vec<Expr>,
    /// Those of the guards at which an angle jumps, and momenta or constraints with it.
    pub cuts: Vec<Expr>,
    /// `A = ∂f/∂v` of the constraints of the system in `(t, y, z)`: where it loses rank along a motion,
    /// several motions go on, or none. `None` where it is constant, or there is no constraint.
    pub rows: Option<ConstraintRows>,
    /// By which pivots they were derived, where these may become small along a motion and others be taken;
    /// never where the outputs are other coordinates than those of the system.
    pub chart: Option<Chart>,
    /// The derived equations, for the reader.
    pub statements: Vec<Statement>,
    /// Variables and equations that this system did not need.
    pub left_out: Vec<LeftOut>,
    /// Error of velocities and momenta in units in the last place; 1 unless constraints nearly depend.
    pub lost_digits: f64,
    /// In which variables they are written, where there was a choice, and why.
    pub chosen: Vec<String>,
    /// The removal behind the equations, whose parameters and memory variables have to be started.
    pub removal: Option<Removal>,
}

impl Equations {
    /// Equations without content for `system`; a derivation fills the fields, the graph last.
    pub fn new(formulation: &'static str, system: &System) -> Self {
        Equations {
            formulation,
            graph: Graph::new(),
            time: system.time,
            parameters: system.parameter_values(),
            given: system.written(),
            own: [system.positions(), system.velocities()].concat(),
            definitions: Vec::new(),
            derivatives: Vec::new(),
            states: Vec::new(),
            blocks: Vec::new(),
            free_constants: Vec::new(),
            coordinates: system.graph.variables(&system.positions()),
            velocities: system.graph.variables(&system.velocities()),
            multipliers: Vec::new(),
            invariants: Vec::new(),
            watched: 0,
            projection: None,
            creeps: false,
            guards: Vec::new(),
            domains: Vec::new(),
            cuts: Vec::new(),
            rows: None,
            chart: None,
            statements: Vec::new(),
            left_out: Vec::new(),
            lost_digits: 1.0,
            chosen: Vec::new(),
            removal: None,
        }
    }

    /// Whether an expression of the graph `g`, which is handed over last, has no symbols but parameters.
    pub fn is_constant(&self, g: &Graph, e: Expr) -> bool {
        g.symbols_of(e).iter().all(|s| self.parameters.contains_key(s))
    }

    /// Expressions, not constant, that vanish where these expressions of `g` are singular: denominators and
    /// arguments of kinks.
    pub fn singularities(&self, g: &Graph, of: &[Expr]) -> Vec<Expr> {
        let mut found = [g.denominators(of), g.kinks(of), g.radicands(of)].concat();
        found.retain(|&e| !self.is_constant(g, e));
        found
    }

    /// Guards against what these expressions of `g` are singular by, and singular equations of the instant.
    pub fn guard(&mut self, g: &Graph, of: &[Expr]) {
        self.guards = self.singularities(g, of);
        self.guard_determinants(g, |role| matches!(role, Role::Multiplier | Role::MemoryCostate));
    }

    /// Guards against equations of the instant that become singular along a motion; of more than twelve
    /// unknowns, whose determinants are too long, only what they divide by is watched.
    pub fn guard_regular(&mut self, g: &Graph) {
        if self.blocks.iter().all(|block| block.unknowns.len() <= 12) {
            self.guard_determinants(g, |role| matches!(role, Role::Position | Role::Velocity));
        }
    }

    /// Guards against singular equations of the instant where their matrix `∂R/∂z`, in the graph `g`, depends
    /// on such states: its determinant may change its sign along a motion, or touch zero, and a step that
    /// passes over that goes on in one of several motions.
    fn guard_determinants(&mut self, g: &Graph, of: impl Fn(Role) -> bool) {
        let moving: HashSet<Symbol> = self.states.iter().filter(|y| of(y.role)).map(|y| y.symbol).collect();
        for block in &self.blocks {
            let entries = g.sparse_jacobian(&block.residuals, &block.unknowns);
            let symbols: HashSet<Symbol> = entries.iter().flatten().flat_map(|&(_, e)| g.symbols_of(e)).collect();
            if !symbols.is_disjoint(&moving) && block.unknowns.iter().all(|z| !symbols.contains(z)) {
                let matrix = g.jacobian(&block.residuals, &block.unknowns);
                let rows: Vec<Vec<Expr>> = (0..matrix.rows()).map(|i| matrix.row(i).to_vec()).collect();
                self.guards.push(determinant(g, &rows));
            }
        }
    }

    /// Adds the states `q` with rate `v` and `v` with rate `a`, started at `(q₀, v₀)`.
    pub fn add_positions_and_velocities(&mut self, system: &System) {
        let g = &system.graph;
        let state = |symbol, role, rate| StateVariable::of(g, symbol, role, rate, symbol);
        let coordinates = &system.coordinates;
        self.states.extend(coordinates.iter().map(|c| state(c.position, Role::Position, c.velocity)));
        self.states.extend(coordinates.iter().map(|c| state(c.velocity, Role::Velocity, c.acceleration)));
    }

    /// A tape for `outputs`, with parameters folded in, by way of those definitions that it needs.
    ///
    /// # Errors
    /// [`CompileError`] where a symbol is neither input nor parameter nor definition.
    pub fn tape(&self, inputs: &[Symbol], outputs: &[Expr]) -> Result<Tape, CompileError> {
        self.tape_by(&self.definitions, inputs, outputs)
    }

    /// [`Equations::tape`] with other definitions.
    pub(crate) fn tape_by(
        &self,
        definitions: &[(Symbol, Expr)],
        inputs: &[Symbol],
        outputs: &[Expr],
    ) -> Result<Tape, CompileError> {
        let definitions = needed(&self.graph, definitions, inputs, outputs);
        self.graph.compile_with(inputs, &definitions, outputs, &self.parameters)
    }

    /// [`Equations::tape`], ready to be evaluated.
    pub(crate) fn evaluator<T: Scalar>(
        &self,
        inputs: &[Symbol],
        outputs: &[Expr],
    ) -> Result<Evaluator<T>, CompileError> {
        self.evaluator_by(&self.definitions, inputs, outputs)
    }

    /// [`Equations::evaluator`] with other definitions.
    pub(crate) fn evaluator_by<T: Scalar>(
        &self,
        definitions: &[(Symbol, Expr)],
        inputs: &[Symbol],
        outputs: &[Expr],
    ) -> Result<Evaluator<T>, CompileError> {
        Ok(Evaluator::new(self.tape_by(definitions, inputs, outputs)?))
    }

    /// Symbols of `y`.
    pub fn state_symbols(&self) -> Vec<Symbol> {
        self.states.iter().map(|s| s.symbol).collect()
    }

    /// Symbols of `z`, block after block.
    pub fn unknowns(&self) -> Vec<Symbol> {
        self.blocks.iter().flat_map(|b| b.unknowns.iter().copied()).collect()
    }

    /// Symbols of the free constants.
    pub fn constant_symbols(&self) -> Vec<Symbol> {
        self.free_constants.iter().map(|c| c.symbol).collect()
    }

    /// Symbols of `t`, `y` and the free constants: what is known when an instant is solved.
    pub fn known_symbols(&self) -> Vec<Symbol> {
        let mut known = vec![self.time];
        known.extend(self.state_symbols());
        known.extend(self.constant_symbols());
        known
    }

    /// The symbols in `roots`, and in the definitions that these use.
    pub fn symbols_behind(&self, roots: impl IntoIterator<Item = Expr>) -> HashSet<Symbol> {
        symbols_behind(&self.graph, &self.definitions, roots)
    }
}

/// By minors of the first rows, without quotients.
fn determinant(g: &Graph, rows: &[Vec<Expr>]) -> Expr {
    let mut minors = BTreeMap::from([(0_u64, g.one())]);
    for row in rows {
        let mut larger: BTreeMap<u64, Vec<Expr>> = BTreeMap::new();
        for (&columns, &minor) in &minors {
            for (j, &e) in row.iter().enumerate().filter(|(j, e)| columns >> j & 1 == 0 && !g.is_zero(**e)) {
                let term = g.mul(e, minor);
                let odd = (columns >> j).count_ones() % 2 == 1;
                larger.entry(columns | 1 << j).or_default().push(if odd { g.neg(term) } else { term });
            }
        }
        minors = larger.into_iter().map(|(columns, terms)| (columns, g.sum(&terms))).collect();
    }
    minors.into_values().next().unwrap_or(g.zero())
}

impl std::fmt::Debug for Equations {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Equations").field("formulation", &self.formulation).finish_non_exhaustive()
    }
}
