//! Given start data, and the start completed from them.

use std::collections::HashMap;

use symbolic::{Expr, Symbol};

use crate::Removal;

/// Start data of a scene.
#[derive(Clone, Debug, Default)]
pub struct StartData<'a> {
    /// `t₀`.
    pub time: f64,
    /// `q₀`, length n.
    pub positions: Vec<f64>,
    /// Given velocities, and given rates of the parameters of [`StartData::removal`].
    pub given: HashMap<Symbol, f64>,
    /// Where Newton's method starts for the others; chooses among several solutions.
    pub guess: HashMap<Symbol, f64>,
    /// Further `e(q₀, v, t₀) = 0` that the velocities solve, as expressions `e`.
    pub equations: Vec<Expr>,
    /// Project given velocities onto the constraints, as [`project_velocity`](crate::project_velocity) does.
    pub project: bool,
    /// The parametrization whose rates are given.
    pub removal: Option<&'a Removal>,
}

/// Start data of starts that differ by numbers.
#[derive(Clone, Copy, Debug, Default)]
pub struct StartShape<'a> {
    /// Symbols of [`StartData::given`].
    pub given: &'a [Symbol],
    /// Symbols of [`StartData::guess`].
    pub guessed: &'a [Symbol],
    /// [`StartData::equations`].
    pub equations: &'a [Expr],
    /// [`StartData::project`].
    pub project: bool,
    /// [`StartData::removal`].
    pub removal: Option<&'a Removal>,
    /// Parameters that vary.
    pub varied: &'a [Symbol],
}

/// The numbers of one start, in the order of their symbols.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartNumbers {
    /// `t₀`.
    pub time: f64,
    /// `q₀`, length n.
    pub positions: Vec<f64>,
    /// Of [`StartShape::given`].
    pub given: Vec<f64>,
    /// Of [`StartShape::guessed`].
    pub guess: Vec<f64>,
    /// Of [`StartShape::varied`].
    pub varied: Vec<f64>,
}

/// How the start velocities came about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Completion {
    /// Names of the velocities (and rates of parameters) that were given.
    pub given: Vec<String>,
    /// Names of the velocities that constraints and start equations supplied.
    pub supplied: Vec<String>,
    /// Places of the coordinates that constraints on positions supplied.
    pub configured: Vec<usize>,
    /// [`StartData::equations`].
    pub equations: Vec<Expr>,
    /// Largest residual of a constraint or start equation, relative to the size of its terms.
    pub residual: f64,
    /// Length `√(δvᵀ M δv)` of the projection onto the constraint, where one was asked for; 0 where the
    /// velocities as given fulfil it.
    pub projected: Option<f64>,
    /// Positions and given velocities or rates as they were written, in parameters, time and earlier
    /// positions, and the time of a formula: exact where the state is rounded. Empty where there are numbers
    /// only; NaN for a formula that arithmetic has rounded.
    pub written: Vec<(Symbol, Expr)>,
    /// Guesses of the others in the same way, in parameters, time and positions.
    pub guessed: Vec<(Symbol, Expr)>,
}
