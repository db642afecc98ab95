//! Start values of a removal's parameters, rates and memory.

use std::collections::HashMap;

use symbolic::{Expr, Symbol};

use super::numeric::{Problem, Solved, values_of};
use super::{StartError, check_lengths};
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
/// What is a coordinate takes its value from `state`; what [`Removal::start`] names, that of the expression there; the
/// rest solves `q(u̇, u, w, t) = q₀`, `q̇(ü, u̇, u, w, t) = v₀`, nearest to zero where that leaves a choice.
///
/// # Errors
/// [`StartError::RemovalStart`] with the residual where no values of the parameters give this state: its velocity is off the
/// constraint, the chart of the parametrization breaks here, or a start expression contradicts it;
/// [`StartError::WrongLength`]; [`StartError::Evaluation`].
pub fn complete_removal_start(system: &System, removal: &Removal, state: &State) -> Result<RemovalStart, StartError> {
    check_lengths(system, state)?;
    let g = &system.graph;
    let known = values_of(system, state);
    let velocities = removal.velocities(system);
    let mut equations: Vec<Expr> = start_equations(system, removal).into_iter().map(|(_, e)| e).collect();
    for (i, c) in system.coordinates.iter().enumerate() {
        equations.push(g.sub(removal.coordinates[i], g.variable(c.position)));
        equations.push(g.sub(velocities[i], g.variable(c.velocity)));
    }
    equations.retain(|&e| !g.is_zero(e));
    let variables: Vec<Symbol> = removal
        .parameters
        .iter()
        .flat_map(|u| [u.symbol, u.rate])
        .chain(removal.memory.iter().map(|w| w.symbol))
        .collect();
    let problem = Problem::new(system, equations, &g.variables(&variables), known);
    let mut smallest = f64::INFINITY;
    let mut limit = 0.0;
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
            Solved::LeastSquares(root, at_most) => {
                smallest = root.residual.min(smallest);
                limit = at_most;
            }
            Solved::Nowhere => {}
        }
    }
    Err(StartError::RemovalStart { removal: removal.name.clone(), residual: smallest, limit })
}

/// `symbol − expression(q, v, t)` for each of [`Removal::start`], in the order of the symbols.
pub(super) fn start_equations(system: &System, removal: &Removal) -> Vec<(Symbol, Expr)> {
    let g = &system.graph;
    let mut equations: Vec<(Symbol, Expr)> =
        removal.start.iter().map(|(&s, &e)| (s, g.sub(g.variable(s), e))).collect();
    equations.sort();
    equations
}
