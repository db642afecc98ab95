//! Quantities of a system in the variables of its equations.

use std::collections::{HashMap, HashSet};

use equations::Equations;
use mechanics::System;
use symbolic::{Expr, Symbol};

/// Expressions in a system's coordinates, velocities and time in the variables of its equations, as far as
/// these tell them, also by these unknowns.
pub(crate) fn in_variables_of(
    equations: &Equations,
    system: &System,
    es: &[Expr],
    unknowns: &HashSet<Symbol>,
) -> Vec<Expr> {
    let symbols = system.positions().into_iter().chain(system.velocities());
    let read = equations.coordinates.iter().chain(&equations.velocities).copied();
    let map: HashMap<Symbol, Expr> = symbols.zip(read).collect();
    // they may be younger than the equations' graph
    let known_there = equations.graph.adopt(&system.graph, es);
    let guards = known_there.into_iter().map(|e| equations.graph.substitute(e, &map));
    let defined = equations.definitions.iter().map(|d| d.0).chain(equations.parameters.keys().copied());
    let known = equations.known_symbols().into_iter().chain(defined).chain(unknowns.iter().copied());
    let known: HashSet<Symbol> = known.collect();
    guards.filter(|&e| equations.symbols_behind([e]).is_subset(&known)).collect()
}
