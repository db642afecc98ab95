//! The common form in which a formulation hands over its equations of motion.
//!
//! A state `y` moves by `ẏ = F(t, y, z)`, where `z` (accelerations, multipliers or their rates) solves one small block
//! of equations `R(z; t, y) = 0` at every instant, nearly always linear in `z`. Nothing here says how time is stepped.

use std::collections::{BTreeMap, HashMap, HashSet};

use symbolic::{CompileError, Expr, Graph, Matrix, Symbol, Tape};

use crate::definitions::{apart, needed, symbols_behind};
use crate::{Removal, System};

/// What a state variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// A coordinate `q`.
    Position,
    /// A velocity `v = q̇`.
    Velocity,
    /// A quasi-velocity `w`, of which the velocities are linear functions.
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
    /// `y(t₀)`, an expression in `(t₀, q₀, v₀)`, the free constants and, with a removal, `(u, u̇, ü, w)` at the start.
    pub start: Expr,
}

/// Unknowns `z` of one instant and the equations `R(z; t, y) = 0` that determine them.
#[derive(Clone, Debug)]
pub struct Block {
    /// `z`.
    pub unknowns: Vec<Symbol>,
    /// `R`, as many as unknowns.
    pub residuals: Vec<Expr>,
    /// A value of `z` near the solution at the start, in the symbols of the start; used where `R` is not linear in `z`.
    pub guess: Vec<Expr>,
    /// What has to be regular for the block to be solvable, in the field's words.
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

/// A named expression in `(t, y, z)`.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name, ASCII.
    pub name: String,
    /// The expression.
    pub expression: Expr,
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
    /// What the equation says.
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
    /// Intermediate quantities in `(t, y, z)` and earlier ones, see [`crate::Definitions`]. Blocks and guards may need those without `z` only.
    pub definitions: Vec<(Symbol, Expr)>,
    /// `y` with rates and start.
    pub states: Vec<StateVariable>,
    /// The equations of one instant.
    pub blocks: Vec<Block>,
    /// Constants that the start data leave free.
    pub free_constants: Vec<FreeConstant>,
    /// `q` in `(t, y)`.
    pub coordinates: Vec<Expr>,
    /// `q̇` in `(t, y, z)`.
    pub velocities: Vec<Expr>,
    /// Multipliers or costates, whatever the formulation has.
    pub multipliers: Vec<Named>,
    /// Quantities that stay constant along the motion.
    pub invariants: Vec<Named>,
    /// Projection onto the constraint, where the states can leave it.
    pub projection: Option<ConstraintProjection>,
    /// Expressions in `(t, y)` whose zero is a singularity of the equations.
    pub guards: Vec<Expr>,
    /// The derived equations, for the reader.
    pub statements: Vec<Statement>,
    /// What this system did not need.
    pub left_out: Vec<LeftOut>,
    /// So many units in the last place are velocities and momenta known to, where constraints are nearly dependent; 1 without such.
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
            definitions: Vec::new(),
            states: Vec::new(),
            blocks: Vec::new(),
            free_constants: Vec::new(),
            coordinates: Vec::new(),
            velocities: Vec::new(),
            multipliers: Vec::new(),
            invariants: Vec::new(),
            projection: None,
            guards: Vec::new(),
            statements: Vec::new(),
            left_out: Vec::new(),
            lost_digits: 1.0,
            chosen: Vec::new(),
            removal: None,
        }
    }

    /// Adds the states `q` with rate `v` and `v` with rate `a`, started at `(q₀, v₀)`.
    pub fn add_positions_and_velocities(&mut self, system: &System) {
        let g = &system.graph;
        let mut add = |symbol, role, rate| {
            let (rate, start) = (g.variable(rate), g.variable(symbol));
            self.states.push(StateVariable { symbol, role, rate, start });
        };
        for c in &system.coordinates {
            add(c.position, Role::Position, c.velocity);
        }
        for c in &system.coordinates {
            add(c.velocity, Role::Velocity, c.acceleration);
        }
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

    /// Leaves out what the motion does not need, and writes down what went.
    ///
    /// Blocks fall apart into independent ones; an unknown with a constant coefficient and an equation of its own is
    /// solved on the spot; unknowns and states on which no coordinate or velocity depends are dropped;
    /// coordinates that nothing else depends on are named as quadratures.
    pub fn leave_out_unneeded(mut self) -> Self {
        self.split_blocks();
        self.solve_single_unknowns();
        self.drop_unneeded();
        self.name_quadratures();
        self
    }

    fn split_blocks(&mut self) {
        let mut split = Vec::new();
        for block in std::mem::take(&mut self.blocks) {
            let places: HashMap<Symbol, usize> = block.unknowns.iter().enumerate().map(|(i, &z)| (z, i)).collect();
            let occurring =
                |&r: &Expr| self.graph.symbols_of(r).iter().filter_map(|z| places.get(z).copied()).collect();
            let depends: Vec<Vec<usize>> = block.residuals.iter().map(occurring).collect();
            // each unknown points at one of its group with a smaller place, the first at itself
            let mut group: Vec<usize> = (0..block.unknowns.len()).collect();
            let first = |group: &[usize], mut j: usize| {
                while group[j] != j {
                    j = group[j];
                }
                j
            };
            for row in &depends {
                let linked: Vec<usize> = row.iter().map(|&j| first(&group, j)).collect();
                if let Some(&smallest) = linked.iter().min() {
                    linked.iter().for_each(|&j| group[j] = smallest);
                    row.iter().for_each(|&j| group[j] = smallest);
                }
            }
            let mut members: BTreeMap<usize, (Vec<usize>, Vec<usize>)> = BTreeMap::new();
            for j in 0..group.len() {
                members.entry(first(&group, j)).or_default().1.push(j);
            }
            for (i, row) in depends.iter().enumerate() {
                if let Some(part) = row.first().and_then(|&j| members.get_mut(&first(&group, j))) {
                    part.0.push(i);
                }
            }
            let parts: Vec<(Vec<usize>, Vec<usize>)> = members.into_values().collect();
            if parts.iter().any(|(rows, columns)| rows.len() != columns.len()) {
                split.push(block); // structurally singular: kept whole, refused with its name when it is solved
                continue;
            }
            for (rows, columns) in parts {
                split.push(Block {
                    unknowns: columns.iter().map(|&j| block.unknowns[j]).collect(),
                    residuals: rows.iter().map(|&i| block.residuals[i]).collect(),
                    guess: columns.iter().filter_map(|&j| block.guess.get(j).copied()).collect(),
                    regular: block.regular,
                });
            }
        }
        self.blocks = split;
    }

    fn solve_single_unknowns(&mut self) {
        let g = self.graph.clone();
        let parameters: HashSet<Symbol> = self.parameters.keys().copied().collect();
        let mut solved: Vec<(Symbol, Expr)> = Vec::new();
        self.blocks.retain(|block| {
            let ([unknown], [residual]) = (&block.unknowns[..], &block.residuals[..]) else { return true };
            let coefficient = g.derivative(*residual, *unknown);
            let constant = g.symbols_of(coefficient).iter().all(|s| parameters.contains(s));
            let value = g.evaluate(coefficient, &self.parameters).unwrap_or(0.0);
            if !constant || value == 0.0 || !value.is_finite() {
                return true;
            }
            let rest = g.substitute(*residual, &HashMap::from([(*unknown, g.zero())]));
            let solution = g.neg(g.div(rest, coefficient));
            solved.push((*unknown, solution));
            false
        });
        self.graph = g;
        let unknowns: Vec<Symbol> = solved.iter().map(|s| s.0).collect();
        let (known, waiting) = apart(&self.graph, &self.definitions, &unknowns);
        if !waiting.is_empty() {
            self.definitions = [known, solved, waiting].concat();
        } else if !solved.is_empty() {
            self.rewrite(&solved.into_iter().collect());
        }
    }

    /// Substitutes in rates, outputs, invariants and guards.
    fn rewrite(&mut self, map: &HashMap<Symbol, Expr>) {
        let g = &self.graph;
        for e in self
            .states
            .iter_mut()
            .map(|s| &mut s.rate)
            .chain(&mut self.coordinates)
            .chain(&mut self.velocities)
            .chain(self.multipliers.iter_mut().map(|n| &mut n.expression))
            .chain(self.invariants.iter_mut().map(|n| &mut n.expression))
            .chain(&mut self.guards)
        {
            *e = g.substitute(*e, map);
        }
    }

    fn drop_unneeded(&mut self) {
        let g = self.graph.clone();
        let definitions: HashMap<Symbol, Expr> = self.definitions.iter().copied().collect();
        let rates: HashMap<Symbol, Expr> = self.states.iter().map(|y| (y.symbol, y.rate)).collect();
        let mut needed: HashSet<Symbol> = HashSet::new();
        let mut pending: Vec<Expr> = self.coordinates.iter().chain(&self.velocities).copied().collect();
        pending.extend(self.multipliers.iter().map(|m| m.expression));
        while let Some(e) = pending.pop() {
            for s in g.symbols_of(e) {
                if !needed.insert(s) {
                    continue;
                }
                pending.extend(definitions.get(&s).into_iter().chain(rates.get(&s)));
                for b in self.blocks.iter().filter(|b| b.unknowns.contains(&s)) {
                    pending.extend(&b.residuals);
                }
            }
        }
        let unneeded: Vec<Symbol> = self.states.iter().map(|y| y.symbol).filter(|s| !needed.contains(s)).collect();
        if !unneeded.is_empty() {
            let words = "nothing that is asked for depends on it".into();
            self.left_out.push(LeftOut { variables: unneeded, words });
        }
        let dropped: HashSet<Symbol> =
            self.states.iter().map(|y| y.symbol).chain(self.unknowns()).filter(|s| !needed.contains(s)).collect();
        self.states.retain(|y| !dropped.contains(&y.symbol));
        self.blocks.retain(|b| b.unknowns.iter().any(|z| !dropped.contains(z)));
        if !dropped.is_empty() {
            self.invariants.retain(|i| symbols_behind(&g, &self.definitions, [i.expression]).is_disjoint(&dropped));
        }
        self.graph = g;
    }

    fn name_quadratures(&mut self) {
        let g = &self.graph;
        let rates = self.states.iter().map(|y| y.rate);
        let used =
            symbols_behind(g, &self.definitions, rates.chain(self.blocks.iter().flat_map(|b| b.residuals.clone())));
        let quadratures: Vec<Symbol> = self
            .states
            .iter()
            .filter(|y| matches!(y.role, Role::Position | Role::Memory | Role::DisplacementParameter))
            .map(|y| y.symbol)
            .filter(|symbol| !used.contains(symbol))
            .collect();
        if !quadratures.is_empty() {
            let words = "in no equation of motion; found by quadrature along the way".into();
            self.left_out.push(LeftOut { variables: quadratures, words });
        }
    }
}
