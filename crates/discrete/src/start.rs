//! The start of a discrete motion: values at `t₀`, and refusals.

use std::collections::HashMap;

use mechanics::{MemoryVariable, Removal, State, System, fresh_symbol};
use symbolic::limits::NOTHING;
use symbolic::{Expr, Graph, Symbol};

use crate::DiscreteError;
use crate::newton::{check_finite, largest};

/// `L` in `(u̇, u, w, t)`; no rate may be too high.
pub(crate) fn substituted_lagrangian(system: &System, removal: &Removal) -> Result<Expr, DiscreteError> {
    let g = &system.graph;
    let refuse = |what: &'static str, es: &[Expr], symbol: Symbol| match es.iter().any(|&e| g.depends_on(e, symbol)) {
        true => Err(DiscreteError::HighRate { removal: removal.name.clone(), what, symbol: g.name(symbol) }),
        false => Ok(()),
    };
    let memory: Vec<Expr> = removal.memory.iter().map(|w: &MemoryVariable| w.rate).collect();
    let mut flow: Vec<(Symbol, Expr)> = removal.parameters.iter().map(|u| (u.symbol, g.variable(u.rate))).collect();
    flow.extend(removal.memory.iter().map(|w| w.symbol).zip(memory.iter().copied()));
    flow.push((system.time, g.one()));
    for u in &removal.parameters {
        refuse("a coordinate", &removal.coordinates, u.rate)?;
        refuse("a coordinate", &removal.coordinates, u.second_rate)?;
        refuse("the rate of a memory variable", &memory, u.second_rate)?;
    }
    let mut map = HashMap::new();
    for (c, &q) in system.coordinates.iter().zip(&removal.coordinates) {
        map.insert(c.position, q);
        map.insert(c.velocity, g.total_derivative(q, &flow));
    }
    Ok(g.substitute(system.lagrangian, &map))
}

/// Lengths, `h < n`, and `f = 0`.
pub(crate) fn check_start(system: &System, start: &State) -> Result<(), DiscreteError> {
    let (n, h) = (system.dimension(), system.constraints.len());
    if h >= n {
        return Err(DiscreteError::NoFreedom { found: h, limit: n });
    }
    check_length("positions", &start.q, n)?;
    check_length("velocities", &start.v, n)?;
    let values = values(system, start);
    let reach = 1.0 + start.v.iter().map(|v| v * v).sum::<f64>().sqrt();
    for &f in &system.constraints {
        let residual = numbers(&system.graph, &[f], &values)?;
        let row = numbers(&system.graph, &system.graph.gradient(f, &system.velocities()), &values)?;
        check_finite("a constraint", start.t, &residual)?;
        check_finite("an entry of the constraint Jacobian", start.t, &row)?;
        let length = row.iter().map(|a| a * a).sum::<f64>().sqrt();
        let found = largest(&residual) / (length * reach);
        if found.is_nan() || found > NOTHING {
            return Err(DiscreteError::OffConstraint { found, limit: NOTHING });
        }
    }
    Ok(())
}

pub(crate) fn refuse_forces(system: &System) -> Result<(), DiscreteError> {
    match system.forces.iter().position(|&force| !system.graph.is_zero(force)) {
        None => Ok(()),
        Some(i) => Err(DiscreteError::Force { number: i + 1 }),
    }
}

pub(crate) fn check_length(what: &'static str, values: &[f64], expected: usize) -> Result<(), DiscreteError> {
    let found = values.len();
    if found == expected { Ok(()) } else { Err(DiscreteError::Length { what, found, expected }) }
}

pub(crate) fn fresh_symbols(g: &Graph, stem: &str, count: usize) -> Vec<Symbol> {
    (0..count).map(|i| fresh_symbol(g, &format!("{stem}{i}"))).collect()
}

pub(crate) fn values(system: &System, state: &State) -> HashMap<Symbol, f64> {
    let mut values = system.parameter_values();
    values.extend(system.values_at(state));
    values
}

pub(crate) fn numbers(g: &Graph, es: &[Expr], values: &HashMap<Symbol, f64>) -> Result<Vec<f64>, DiscreteError> {
    Ok(es.iter().map(|&e| g.evaluate(e, values)).collect::<Result<_, _>>()?)
}

pub(crate) fn with_zeros(values: &[f64], count: usize) -> Vec<f64> {
    values.iter().copied().chain(std::iter::repeat_n(0.0, count)).collect()
}
