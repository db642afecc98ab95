//! Start values of a removal's parameters, rates and memory.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};
use symbolic::{Bounded, Expr, Symbol};

use super::error::{StartError, check_lengths};
use super::numeric::{Problem, Solved, bounded};
use crate::newton::{Evaluation, NewtonOptions};
use crate::{Removal, State, System};

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
    let g = &system.graph;
    let limit = NewtonOptions::default().limit;
    let fault = |residual| StartError::RemovalStart { removal: removal.name.clone(), residual, limit };
    let mut known = system.values_at(state);
    known.extend(start_values(system, removal, &known)?);
    if !known.values().all(|x| x.is_finite()) {
        return Err(fault(f64::INFINITY));
    }
    let variables: Vec<Symbol> = removal
        .parameters
        .iter()
        .flat_map(|u| [u.symbol, u.rate])
        .chain(removal.memory.iter().map(|w| w.symbol))
        .collect();
    let mut problem = Problem::new(system, removal.residuals(system), &g.variables(&variables), known);
    problem.results = system.velocities().into_iter().zip(velocity_sizes(system, state)?).collect();
    let mut smallest = f64::INFINITY;
    for default in [0.0, 1.0, -1.0, 0.1, -0.1] {
        match problem.solve(&HashMap::new(), default)? {
            Solved::Root(root) => {
                let values = problem.values(&root);
                let (_, open) = problem.outputs(&g.variables(&problem.unknowns), &root)?;
                let pick = |s: Symbol| values.get(&s).map(|&x| (s, x));
                return Ok(RemovalStart {
                    parameters: removal.parameters.iter().filter_map(|u| pick(u.symbol)).collect(),
                    rates: removal.parameters.iter().filter_map(|u| pick(u.rate)).collect(),
                    second_rates: removal.parameters.iter().filter_map(|u| pick(u.second_rate)).collect(),
                    memory: removal.memory.iter().filter_map(|w| pick(w.symbol)).collect(),
                    free: problem.unknowns.iter().zip(open).filter_map(|(&s, open)| open.then_some(s)).collect(),
                    residual: root.residual,
                });
            }
            Solved::LeastSquares(root) => smallest = root.residual.min(smallest),
            Solved::Nowhere => {}
        }
    }
    Err(fault(smallest))
}

/// What was added up to each velocity, for constraints give it by way of their terms: `Σ |A⁺| |terms of f|`.
///
/// So a velocity that vanishes is known to the round-off of what cancelled in it, and not to that of itself.
fn velocity_sizes(system: &System, state: &State) -> Result<Vec<f64>, StartError> {
    let (n, h) = (system.dimension(), system.constraints.len());
    let inputs = [system.positions(), system.velocities(), vec![system.time]].concat();
    let point = [&state.q[..], &state.v, &[state.t]].concat();
    let jacobian = system.graph.jacobian(&system.constraints, &system.velocities());
    let mut measured = system.evaluator(&inputs, &[&system.constraints[..], jacobian.entries()].concat())?;
    let (constraints, entries) = measured.evaluate(&bounded(&point)).split_at(h);
    let jacobian = DMatrix::from_row_iterator(h, n, entries.iter().map(|e| e.value));
    let residual = DVector::from_iterator(h, constraints.iter().map(|f| f.value));
    let finite = |f: &Bounded| Some(f.magnitude).filter(|size| size.is_finite()).unwrap_or(0.0);
    let magnitude = DVector::from_iterator(h, constraints.iter().map(finite));
    let evaluation = Evaluation { residual, jacobian, magnitude };
    Ok(evaluation.sizes(&DVector::from_column_slice(&state.v))?)
}

/// [`Removal::start`] as numbers.
fn start_values(
    system: &System,
    removal: &Removal,
    known: &HashMap<Symbol, f64>,
) -> Result<Vec<(Symbol, f64)>, StartError> {
    let (symbols, expressions): (Vec<Symbol>, Vec<Expr>) = removal.start.iter().map(|(&s, &e)| (s, e)).unzip();
    let (inputs, point): (Vec<Symbol>, Vec<f64>) = known.iter().map(|(&s, &x)| (s, x)).unzip();
    let mut numeric = system.evaluator(&inputs, &expressions)?;
    Ok(symbols.into_iter().zip(numeric.evaluate(&point).iter().copied()).collect())
}
