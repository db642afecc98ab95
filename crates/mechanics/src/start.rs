//! Start data: velocities that the constraints supply, projection onto the constraint, start values of a removal.
//!
//! A scene gives some velocities; the others solve `f(q₀, v, t₀) = 0`. Too few given ones and contradictory ones are errors
//! that say by how much.

use std::collections::HashMap;

use symbolic::{Expr, Symbol};

use crate::newton::NewtonOptions;
use crate::{Removal, State, System};

mod error;
mod numeric;
mod project;
mod recombination;
mod regularity;
mod removal_start;
mod velocities;

pub use error::{Quantity, StartError};
pub use project::project_velocity;
pub use recombination::Recombination;
pub use regularity::check_regularity;
pub use removal_start::{RemovalStart, complete_removal_start};

use numeric::Problem;

/// What a scene says about the start.
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
    /// Given velocities need not satisfy the constraints: they are projected as by [`project_velocity`].
    pub project: bool,
    /// The parametrization whose rates are given.
    pub removal: Option<&'a Removal>,
}

/// How the start velocities came about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Completion {
    /// Names of the velocities (and rates of parameters) that were given.
    pub given: Vec<String>,
    /// Names of the velocities that the constraints supplied.
    pub supplied: Vec<String>,
    /// Largest residual of a constraint, relative to the size of its terms.
    pub residual: f64,
    /// Length `√(δvᵀ M δv)` of the projection onto the constraint, where one was asked for.
    pub projected: Option<f64>,
    /// Positions and given velocities or rates as they were written, in parameters, time and earlier positions: exact where the state is
    /// rounded. Empty where there are numbers only.
    pub written: Vec<(Symbol, Expr)>,
}

/// Finds the velocities that were not given from `f(q₀, v, t₀) = 0`, checks the start ([`check_regularity`]).
///
/// With rates of removal parameters given, the unknowns are `(ü, u̇, u, w)` with `q(u̇, u, w) = q₀`, the given velocities and
/// the removal's start expressions; then `v = q̇(ü, u̇, u, w)`.
///
/// # Errors
/// [`StartError`].
pub fn complete_start(system: &System, data: &StartData) -> Result<(State, Completion), StartError> {
    let g = &system.graph;
    let velocities = system.velocities();
    let at_rest = State { t: data.time, q: data.positions.clone(), v: vec![0.0; data.positions.len()] };
    check_lengths(system, &at_rest)?;
    let mut known = system.values_at(&at_rest);
    known.retain(|s, _| !velocities.contains(s));
    known.extend(data.given.iter().map(|(&s, &x)| (s, x)));

    let by_rates = data.removal.filter(|_| data.given.keys().any(|s| !velocities.contains(s)));
    let (equations, outputs) = match by_rates {
        Some(removal) => parametrized(system, removal, data),
        None => (system.constraints.clone(), g.variables(&velocities)),
    };
    let problem = Problem::new(system, equations, &outputs, known);
    let v = velocities::solve_velocities(&problem, &outputs, data)?;
    let mut state = State { v, ..at_rest };
    let mut completion = Completion {
        given: names(system, |s| data.given.contains_key(&s)),
        supplied: names(system, |s| velocities.contains(&s) && !data.given.contains_key(&s)),
        ..Completion::default()
    };
    if let Some(removal) = by_rates {
        let given = removal.parameters.iter().filter(|u| u.coordinate.is_none() && data.given.contains_key(&u.rate));
        completion.given.extend(given.map(|u| g.name(u.rate)));
    }
    check_regularity(system, &state)?;
    if data.project {
        let (projected, length) = project_velocity(system, &state)?;
        state = projected;
        check_regularity(system, &state)?;
        completion.projected = Some(length);
    }
    let (constraint, residual) = worst_constraint(system, &state)?;
    let limit = NewtonOptions::default().limit;
    if residual > limit {
        return Err(StartError::Contradictory { constraint, residual, limit });
    }
    completion.residual = residual;
    Ok((state, completion))
}

fn names(system: &System, select: impl Fn(Symbol) -> bool) -> Vec<String> {
    system.velocities().into_iter().filter(|&s| select(s)).map(|s| system.graph.name(s)).collect()
}

/// Equations for the variables of a removal, and the velocities as expressions in them.
fn parametrized(system: &System, removal: &Removal, data: &StartData) -> (Vec<Expr>, Vec<Expr>) {
    let g = &system.graph;
    let rates = removal.velocities(system);
    let as_rates: HashMap<Symbol, Expr> = system.velocities().into_iter().zip(rates.iter().copied()).collect();
    let start = removal.start.iter().filter(|(s, _)| !data.given.contains_key(s));
    let mut equations: Vec<Expr> = start.map(|(&s, &e)| g.sub(g.variable(s), g.substitute(e, &as_rates))).collect();
    equations.sort();
    for (i, c) in system.coordinates.iter().enumerate() {
        equations.push(g.sub(removal.coordinates[i], g.variable(c.position)));
        if data.given.contains_key(&c.velocity) {
            equations.push(g.sub(rates[i], g.variable(c.velocity)));
        }
    }
    equations.retain(|&e| !g.is_zero(e));
    (equations, rates)
}

/// Number of the constraint, from 1, with the largest relative residual, and that residual.
fn worst_constraint(system: &System, state: &State) -> Result<(usize, f64), StartError> {
    let problem = Problem::new(system, system.constraints.clone(), &[], system.values_at(state));
    let residuals = problem.relative_residuals()?;
    let worst = residuals.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    Ok(worst.map_or((0, 0.0), |(i, residual)| (i + 1, residual)))
}

fn check_lengths(system: &System, state: &State) -> Result<(), StartError> {
    let expected = system.dimension();
    match [state.q.len(), state.v.len()].into_iter().find(|&found| found != expected) {
        Some(found) => Err(StartError::WrongLength { found, expected }),
        None => Ok(()),
    }
}
