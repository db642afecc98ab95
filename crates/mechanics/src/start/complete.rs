//! A start completed: its velocities found, checked, projected.

use std::collections::HashMap;

use symbolic::{Expr, Symbol};

use super::data::{Completion, StartData};
use super::error::{StartError, check_lengths};
use super::numeric::Problem;
use super::project::project_velocity;
use super::regularity::check_regularity;
use super::velocities::solve_velocities;
use crate::newton::NewtonOptions;
use crate::{Removal, State, System};

/// Finds the velocities that were not given from `f(q₀, v, t₀) = 0`, checks the start ([`check_regularity`]).
///
/// With rates of removal parameters given, the unknowns are `(ü, u̇, u, w)` with `q(u̇, u, w) = q₀`, the
/// given velocities and the removal's start expressions; then `v = q̇(ü, u̇, u, w)`.
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
    let v = solve_velocities(&problem, &outputs, data)?;
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
