//! Rates of the states of equations, and the inputs of programs along a curve.

use equations::Equations;
use mechanics::System;
use symbolic::{Expr, Symbol};

/// Parameters, `t, q, v, a`, and what a lift adds.
pub(crate) fn inputs(system: &System, lifted: &[Symbol]) -> Vec<Symbol> {
    let mut inputs: Vec<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
    inputs.push(system.time);
    inputs.extend(system.positions());
    inputs.extend(system.velocities());
    inputs.extend(system.accelerations());
    inputs.extend(lifted);
    inputs
}

/// Rates of all states, and (t, 1).
pub(crate) fn flow(system: &System, equations: &Equations) -> Vec<(Symbol, Expr)> {
    let mut flow: Vec<(Symbol, Expr)> = equations.states.iter().map(|y| (y.symbol, y.rate)).collect();
    flow.push((system.time, equations.graph.one()));
    flow
}

/// Whether time stands in no equation.
pub(crate) fn timeless(time: Symbol, equations: &Equations) -> bool {
    let residuals = equations.blocks.iter().flat_map(|block| &block.residuals);
    let rates = equations.states.iter().map(|y| &y.rate);
    let all = residuals.chain(rates).chain(&equations.coordinates).chain(&equations.velocities);
    !all.copied().any(|e| equations.graph.depends_on(e, time))
}
