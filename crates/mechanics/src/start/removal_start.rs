//! Start values of a removal's parameters, rates and memory.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};
use symbolic::limits::HALF_THE_DIGITS;
use symbolic::{Bounded, Expr, Symbol};

use super::error::{StartError, check_lengths};
use super::numeric::{AtState, Problem, Solved, numbers, state_symbols};
use crate::newton::{Evaluation, NewtonOptions, Root};
use crate::{DisplacementParameter, Removal, State, System};

/// Numbers for the variables of a parametrization at the start, with `q(u̇, u, w, t) = q₀` and `q̇ = v₀`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RemovalStart {
    /// `u`.
    pub parameters: HashMap<Symbol, f64>,
    /// `u̇`.
    pub rates: HashMap<Symbol, f64>,
    /// `ü`, those on which `q̇` depends.
    pub second_rates: HashMap<Symbol, f64>,
    /// `w`.
    pub memory: HashMap<Symbol, f64>,
    /// Symbols that `(q₀, v₀)` and the scene do not fix: chosen nearest to zero.
    pub free: Vec<Symbol>,
    /// Largest residual of `q = q₀`, `q̇ = v₀`, relative to the size of the terms.
    pub residual: f64,
}

impl RemovalStart {
    /// All values in one map.
    pub fn values(&self) -> HashMap<Symbol, f64> {
        let parts = [&self.parameters, &self.rates, &self.second_rates, &self.memory];
        parts.into_iter().flatten().map(|(&s, &x)| (s, x)).collect()
    }
}

/// Start values of `u`, `u̇` and `w` for a motion that starts at `state`.
///
/// Coordinates take their value from `state`; what [`Removal::start`] names, that of the expression there;
/// the rest solves `q(u̇, u, w, t) = q₀`, `q̇(ü, u̇, u, w, t) = v₀`, nearest to zero where there is a choice.
///
/// # Errors
/// [`StartError::RemovalStart`] with the residual where no values of the parameters give this state: its
/// velocity is off the constraint, the chart of the parametrization breaks here, or a start expression
/// contradicts it; [`StartError::WrongLength`]; [`StartError::Evaluation`].
pub fn complete_removal_start(system: &System, removal: &Removal, state: &State) -> Result<RemovalStart, StartError> {
    check_lengths(system, state)?;
    RemovalProgram::new(system, removal, &[]).start(state, &[])
}

/// [`complete_removal_start`], compiled for values of some parameters.
#[derive(Clone)]
pub struct RemovalProgram {
    /// Name of the removal.
    name: String,
    /// Symbols of `u`, `u̇`, `ü` and `w`.
    variables: [Vec<Symbol>; 4],
    /// What [`Removal::start`] names, then `q, v, t` and the parameters that vary.
    known: Vec<Symbol>,
    /// Values of the first of these.
    given: AtState,
    problem: Problem,
    /// `f` with the sizes of its terms, and `A`.
    constraints: AtState<Bounded>,
    /// h and n.
    shape: (usize, usize),
}

impl RemovalProgram {
    /// For values of the parameters `varied`.
    pub fn new(system: &System, removal: &Removal, varied: &[Symbol]) -> Self {
        let g = &system.graph;
        let of = |pick: fn(&DisplacementParameter) -> Symbol| removal.parameters.iter().map(pick).collect();
        let memory = removal.memory.iter().map(|w| w.symbol).collect();
        let variables: [Vec<Symbol>; 4] = [of(|u| u.symbol), of(|u| u.rate), of(|u| u.second_rate), memory];
        let sought = [0, 1, 3].map(|i: usize| g.variables(&variables[i])).concat();
        let (given, expressions): (Vec<Symbol>, Vec<Expr>) = removal.start.iter().map(|(&s, &e)| (s, e)).unzip();
        let known = [given, state_symbols(system, varied)].concat();
        let constraints = [&system.constraints[..], system.constraint_jacobian().entries()].concat();
        RemovalProgram {
            name: removal.name.clone(),
            variables,
            given: AtState::new(system, varied, &expressions),
            problem: Problem::new(system, &removal.residuals(system), &sought, &known, &system.velocities()),
            known,
            constraints: AtState::new(system, varied, &constraints),
            shape: (system.constraints.len(), system.dimension()),
        }
    }

    /// Start values at a state, for values of these parameters.
    ///
    /// # Errors
    /// As [`complete_removal_start`].
    pub fn start(&mut self, state: &State, varied: &[f64]) -> Result<RemovalStart, StartError> {
        let limit = NewtonOptions::default().limit;
        let mut known = self.given.at(state, varied)?.to_vec();
        known.extend(numbers(state).chain(varied));
        let mut smallest = f64::INFINITY;
        if known.iter().all(|x| x.is_finite()) {
            let sizes = self.velocity_sizes(state, varied)?;
            for default in [0.0, 1.0, -1.0, 0.1, -0.1] {
                let guess = vec![default; self.problem.unknowns.len()];
                match self.problem.solve(&known, &sizes, &guess)? {
                    Solved::Root(root) => return Ok(self.at(&root, &known)),
                    Solved::LeastSquares(root) => smallest = root.residual.min(smallest),
                    Solved::Nowhere => {}
                }
            }
        }
        Err(StartError::RemovalStart { removal: self.name.clone(), residual: smallest, limit })
    }

    fn at(&self, root: &Root, known: &[f64]) -> RemovalStart {
        let unknowns = &self.problem.unknowns;
        let value = |s: Symbol| {
            let values = unknowns.iter().zip(root.x.iter()).chain(self.known.iter().zip(known));
            values.into_iter().find(|(symbol, _)| **symbol == s).map(|(_, &x)| (s, x))
        };
        let [parameters, rates, second_rates, memory] =
            [0, 1, 2, 3].map(|i: usize| self.variables[i].iter().filter_map(|&s| value(s)).collect());
        let open = |i: &usize| root.null_space.row(*i).norm() > HALF_THE_DIGITS;
        let free = (0..unknowns.len()).filter(open).map(|i| unknowns[i]).collect();
        RemovalStart { parameters, rates, second_rates, memory, free, residual: root.residual }
    }

    /// What was added up to each velocity, for constraints give it by way of their terms:
    /// `Σ |A⁺| |terms of f|`.
    ///
    /// So a velocity that vanishes is known to the round-off of what cancelled in it, not to that of itself.
    fn velocity_sizes(&mut self, state: &State, varied: &[f64]) -> Result<Vec<f64>, StartError> {
        let (h, n) = self.shape;
        let (constraints, entries) = self.constraints.at(state, varied)?.split_at(h);
        let jacobian = DMatrix::from_row_iterator(h, n, entries.iter().map(|e| e.value));
        let residual = DVector::from_iterator(h, constraints.iter().map(|f| f.value));
        let finite = |f: &Bounded| Some(f.magnitude).filter(|size| size.is_finite()).unwrap_or(0.0);
        let magnitude = DVector::from_iterator(h, constraints.iter().map(finite));
        let evaluation = Evaluation { residual, jacobian, magnitude };
        Ok(evaluation.sizes(&DVector::from_column_slice(&state.v))?)
    }
}
