//! A mechanical system with velocity constraints.

use std::collections::HashMap;

use symbolic::{CompileError, Evaluator, Expr, Graph, Matrix, ParseError, Scalar, Symbol, Vanishing};

use crate::RemovalError;
use crate::elimination::LinearForms;

/// One generalized coordinate `q`, with the symbols of its velocity and acceleration.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// Name as entered.
    pub name: String,
    /// Unit as entered, for example `m` or `rad`.
    pub unit: String,
    /// Symbol of `q`.
    pub position: Symbol,
    /// Symbol of `q̇`, named with one prime.
    pub velocity: Symbol,
    /// Symbol of `q̈`, named with two primes.
    pub acceleration: Symbol,
}

/// One parameter and its value.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Symbol of the parameter.
    pub symbol: Symbol,
    /// Value, finite.
    pub value: f64,
    /// What it was written as, if that is not a decimal: a formula of numbers, or NaN for one that is not
    /// known exactly. It counts as long as its value is this one.
    pub formula: Option<Expr>,
}

/// A quantity that the user wants to see along a motion.
#[derive(Clone, Debug)]
pub struct Watched {
    /// Its name.
    pub name: String,
    /// It, in `(q, v, t)`.
    pub expression: Expr,
    /// Whether it is to stay what it is at the start.
    pub constancy: Constancy,
}

/// Whether a quantity is to stay what it is at the start of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constancy {
    /// It may change: an observable.
    Free,
    /// The user expects it, of every formulation. A motion that changes it is none the worse for that.
    Expected,
    /// It follows from the constraints, or from the equations of this motion: one that changes it is wrong.
    Certain,
}

impl Watched {
    /// Whether it is to be constant, by whatever right.
    pub fn is_constant(&self) -> bool {
        self.constancy != Constancy::Free
    }
}

/// A mechanical system: coordinates `q ∈ Rⁿ`, Lagrangian `L(q, v, t)`, constraints `f(q, v, t) = 0 ∈ Rʰ`
/// and generalized forces `Q(q, v, t) ∈ Rⁿ`.
///
/// All expressions live in [`System::graph`]. Names with primes are time derivatives.
#[derive(Clone)]
pub struct System {
    /// The expressions of the system and of everything derived from it.
    pub graph: Graph,
    /// Coordinates, in the order as entered.
    pub coordinates: Vec<Coordinate>,
    /// Symbol of time.
    pub time: Symbol,
    /// Parameters with their values, in the order as entered.
    pub parameters: Vec<Parameter>,
    /// `L(q, v, t)`.
    pub lagrangian: Expr,
    /// `f(q, v, t)`, each to be zero along a motion.
    pub constraints: Vec<Expr>,
    /// Constraints on positions `g(q, t) = 0`, each beside the place of `dg/dt` among the constraints:
    /// motions stay on the leaf `g = 0` of their start.
    pub on_positions: Vec<(usize, Expr)>,
    /// Constraints that follow from the others, with the numbers that they were given: no equation depends on
    /// them.
    pub redundant: Vec<(usize, Expr)>,
    /// `Q(q, v, t)`, one per coordinate; the number 0 where no force was given.
    pub forces: Vec<Expr>,
    /// `w(q, v, t)`, none, or as many as constraints: displacements with `∂w/∂v δq = 0` are virtual, where
    /// the constraint is not kept by reactions along its own normals. No formulation but one looks at them.
    pub virtual_conditions: Vec<Expr>,
    /// What has to be no less than zero for `L`, `f` and `Q` as they were written, where their simpler
    /// forms do not say so: `√x √x` is `x`, for `x ≥ 0`.
    pub domains: Vec<Expr>,
    /// Times at which a step is to end, where something is switched, in any order; those outside of a run do
    /// not count.
    pub breakpoints: Vec<f64>,
    /// Invariants and observables of the user's own; no equation depends on them.
    pub watched: Vec<Watched>,
}

/// A point of the motion: time, positions and velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Time.
    pub t: f64,
    /// Positions, length `n`.
    pub q: Vec<f64>,
    /// Velocities, length `n`.
    pub v: Vec<f64>,
}

impl System {
    /// A system with the given coordinates (name, unit) and nothing else: `L = 0`, no constraint, no force.
    ///
    /// Build the expressions in [`System::graph`] afterwards, with [`Coordinate::position`] and
    /// [`Coordinate::velocity`], and set the public fields.
    pub fn new(graph: Graph, coordinates: &[(&str, &str)]) -> Self {
        let coordinates: Vec<Coordinate> = coordinates
            .iter()
            .map(|(name, unit)| Coordinate {
                name: name.to_string(),
                unit: unit.to_string(),
                position: graph.symbol(name),
                velocity: graph.symbol(&format!("{name}'")),
                acceleration: graph.symbol(&format!("{name}''")),
            })
            .collect();
        System {
            time: graph.symbol("t"),
            parameters: Vec::new(),
            lagrangian: graph.zero(),
            constraints: Vec::new(),
            on_positions: Vec::new(),
            redundant: Vec::new(),
            forces: vec![graph.zero(); coordinates.len()],
            virtual_conditions: Vec::new(),
            domains: Vec::new(),
            breakpoints: Vec::new(),
            watched: Vec::new(),
            coordinates,
            graph,
        }
    }

    /// Reads an expression in names that [`System::graph`] knows: coordinates, velocities, parameters, time.
    ///
    /// # Errors
    /// [`ParseError`] with its place.
    pub fn expression(&self, text: &str) -> Result<Expr, ParseError> {
        self.graph.parse(text, &self.graph)
    }

    /// Number of coordinates, `n`.
    pub fn dimension(&self) -> usize {
        self.coordinates.len()
    }

    /// Symbols of `q`.
    pub fn positions(&self) -> Vec<Symbol> {
        self.coordinates.iter().map(|c| c.position).collect()
    }

    /// Symbols of `v = q̇`.
    pub fn velocities(&self) -> Vec<Symbol> {
        self.coordinates.iter().map(|c| c.velocity).collect()
    }

    /// Symbols of `a = q̈`.
    pub fn accelerations(&self) -> Vec<Symbol> {
        self.coordinates.iter().map(|c| c.acceleration).collect()
    }

    /// Values of the parameters.
    pub fn parameter_values(&self) -> HashMap<Symbol, f64> {
        self.parameters.iter().map(|p| (p.symbol, p.value)).collect()
    }

    /// A parameter as it is written: the exact decimal of its value, or its formula; NaN for what is not
    /// known exactly.
    pub fn written_parameter(&self, p: &Parameter) -> Expr {
        let g = &self.graph;
        let unknown = |e: Expr| g.as_number(e).is_some_and(f64::is_nan);
        let counts = |e: &Expr| unknown(*e) || g.evaluate(g.constant(*e), &HashMap::new()) == Ok(p.value);
        p.formula.filter(counts).unwrap_or_else(|| g.number(p.value))
    }

    /// `e` with every parameter put in as it is written, where that is known exactly.
    pub fn as_written(&self, e: Expr) -> Expr {
        let g = &self.graph;
        let written = self.parameters.iter().map(|p| (p.symbol, self.written_parameter(p)));
        g.substitute(e, &written.filter(|(_, e)| g.are_exact(&[*e])).collect())
    }

    /// Whether a symbol is a parameter.
    pub fn is_parameter(&self, symbol: Symbol) -> bool {
        self.parameters.iter().any(|p| p.symbol == symbol)
    }

    /// Whether `e` has no symbols but parameters.
    pub fn is_constant(&self, e: Expr) -> bool {
        self.graph.symbols_of(e).into_iter().all(|s| self.is_parameter(s))
    }

    /// `es` at `v = 0`.
    pub fn at_rest(&self, es: &[Expr]) -> Vec<Expr> {
        let zero = self.velocities().into_iter().map(|v| (v, self.graph.zero())).collect();
        self.graph.substitute_all(es, &zero)
    }

    /// Whether `e` is identically zero for the parameters of the system as they are written: a formula is no
    /// float ([`Graph::vanishes`]).
    pub fn vanishes(&self, e: Expr) -> Vanishing {
        self.graph.vanishes(self.as_written(e), &self.parameter_values())
    }

    /// `outputs` from the values of `inputs`, with the parameters folded in.
    ///
    /// # Errors
    /// [`CompileError`] where a symbol is neither input nor parameter.
    pub fn evaluator<T: Scalar>(&self, inputs: &[Symbol], outputs: &[Expr]) -> Result<Evaluator<T>, CompileError> {
        Ok(Evaluator::new(self.graph.compile(inputs, outputs, &self.parameter_values())?))
    }

    /// Values of the parameters, and of `t, q, v` at `state`.
    pub fn values_at(&self, state: &State) -> HashMap<Symbol, f64> {
        let q = self.positions().into_iter().zip(state.q.iter().copied());
        let v = self.velocities().into_iter().zip(state.v.iter().copied());
        let mut values = self.parameter_values();
        values.extend(q.chain(v).chain([(self.time, state.t)]));
        values
    }

    /// The rates `(q, v), (v, a), (t, 1)` of every variable along a motion, for [`Graph::total_derivative`].
    pub fn flow(&self) -> Vec<(Symbol, Expr)> {
        let g = &self.graph;
        let mut rates = Vec::with_capacity(2 * self.dimension() + 1);
        for c in &self.coordinates {
            rates.push((c.position, g.variable(c.velocity)));
            rates.push((c.velocity, g.variable(c.acceleration)));
        }
        rates.push((self.time, g.one()));
        rates
    }

    /// `L`, `f`, `Q` and `w`, as they were given.
    pub fn written(&self) -> Vec<Expr> {
        [&[self.lagrangian], &self.constraints[..], &self.forces, &self.virtual_conditions].concat()
    }

    /// `d/dt p − Σ F`, n expressions, for `momenta` p and lists F of `forces`, one entry per coordinate;
    /// `flow` has the rates, as [`System::flow`].
    pub fn balances(&self, momenta: &[Expr], forces: &[&[Expr]], flow: &[(Symbol, Expr)]) -> Vec<Expr> {
        let g = &self.graph;
        let on = |i: usize| g.sum(&forces.iter().map(|list| list[i]).collect::<Vec<Expr>>());
        momenta.iter().enumerate().map(|(i, &p)| g.sub(g.total_derivative(p, flow), on(i))).collect()
    }

    /// New symbols, one per constraint: `stem_1`, `stem_2`, …, by [`System::constraint_numbers`], each with
    /// these primes.
    pub fn multipliers(&self, stem: &str, primes: &str) -> Vec<Symbol> {
        let numbers = self.constraint_numbers().into_iter();
        numbers.map(|i| fresh_symbol(&self.graph, &format!("{stem}_{i}{primes}"))).collect()
    }

    /// The number that each constraint was given: 1, 2, … but those of [`System::redundant`].
    pub fn constraint_numbers(&self) -> Vec<usize> {
        let is_free = |number: &usize| self.redundant.iter().all(|(other, _)| other != number);
        (1..).filter(is_free).take(self.constraints.len()).collect()
    }

    /// Constraint Jacobian `A = ∂f/∂v`, h×n.
    pub fn constraint_jacobian(&self) -> Matrix {
        self.graph.jacobian(&self.constraints, &self.velocities())
    }

    /// The energy `v·∂L/∂v − L`.
    pub fn energy(&self) -> Expr {
        let (g, v) = (&self.graph, self.velocities());
        g.sub(g.dot(&g.variables(&v), &g.gradient(self.lagrangian, &v)), self.lagrangian)
    }

    /// Velocity Hessian (mass matrix) `M = ∂²L/∂v²`, n×n.
    pub fn velocity_hessian(&self) -> Matrix {
        let v = self.velocities();
        self.graph.jacobian(&self.graph.gradient(self.lagrangian, &v), &v)
    }

    /// The constraints as `A(q, t) v + b(q, t)`.
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`] where one is not linear (or affine) in `v`.
    pub fn linear_constraints(&self) -> Result<LinearForms, RemovalError> {
        LinearForms::new(&self.graph, &self.constraints, &self.velocities())
            .map_err(|i| RemovalError::NotLinear { constraint: i + 1, text: self.graph.plain(self.constraints[i]) })
    }

    /// Whether every constraint is linear (or affine) in `v`, that is whether `A` is free of `v`.
    pub fn constraints_linear_in_velocity(&self) -> bool {
        self.linear_constraints().is_ok()
    }

    /// Whether reactions along the rows `W` do no work: `W v = 0` wherever `f = 0`.
    ///
    /// That is recognized where `W v` is a multiple of `f` with a constant factor: for `W = ∂f/∂v`, `f`
    /// homogeneous of degree `d` in `v` gives `W v = d f` (Euler).
    pub fn is_workless(&self, rows: &Matrix) -> bool {
        let g = &self.graph;
        let work = g.mat_vec(rows, &g.variables(&self.velocities()));
        self.constraints.iter().zip(work).all(|(&f, av)| {
            (1..=4).any(|degree| {
                let rest = g.sub(av, g.mul(g.integer(degree), f));
                self.vanishes(rest) == Vanishing::Exactly
            })
        })
    }

    /// Whether neither `L` nor `f` nor `Q` contains time.
    pub fn is_autonomous(&self) -> bool {
        std::iter::once(&self.lagrangian)
            .chain(&self.constraints)
            .chain(&self.forces)
            .all(|&e| !self.graph.depends_on(e, self.time))
    }

    /// Whether a generalized force acts.
    pub fn has_forces(&self) -> bool {
        self.forces.iter().any(|&e| !self.graph.is_zero(e))
    }
}

/// A symbol that the graph does not contain yet: `name`, with underscores before its primes until it is free.
pub fn fresh_symbol(graph: &Graph, name: &str) -> Symbol {
    let mut stem = name.trim_end_matches('\'').to_string();
    let primes = &name[stem.len()..];
    while graph.find_symbol(&format!("{stem}{primes}")).is_some() {
        stem.push('_');
    }
    graph.symbol(&format!("{stem}{primes}"))
}

impl std::fmt::Debug for System {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("System")
            .field("lagrangian", &self.graph.plain(self.lagrangian))
            .field("constraints", &self.constraints.len())
            .finish_non_exhaustive()
    }
}
