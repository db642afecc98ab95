//! Adjoints of the dependent velocities: their recursion in reverse order.

use std::collections::{HashMap, HashSet};

use crate::QuasiVelocities;
use crate::expressions::SHORT;
use equations::Definitions;
use mechanics::System;
use symbolic::{Expr, Graph, Symbol};

/// `v̄_k` of the dependent velocities, from `seeds` by coordinate: `p − L_v`, or the unreduced balance.
pub(crate) fn adjoints(
    g: &Graph,
    quasi: &QuasiVelocities,
    seeds: &[Expr],
    definitions: &mut Definitions,
) -> HashMap<Symbol, Expr> {
    let mut terms: HashMap<Symbol, Vec<Expr>> =
        quasi.dependent.iter().map(|d| (d.symbol, d.coordinate.map(|i| seeds[i]).into_iter().collect())).collect();
    let mut adjoints = HashMap::new();
    for d in quasi.dependent.iter().rev() {
        let adjoint = definitions.short(g, "r", SHORT, g.sum(&terms[&d.symbol]));
        for &(s, coefficient) in &d.terms {
            if let Some(terms) = terms.get_mut(&s) {
                terms.push(g.mul(coefficient, adjoint));
            }
        }
        adjoints.insert(d.symbol, adjoint);
    }
    adjoints
}

/// `(∂v/∂q)ᵀ (p − L_v)` at fixed `w`, through the recursion of the velocities and that of their coefficients.
pub(crate) fn by_positions(
    system: &System,
    quasi: &QuasiVelocities,
    adjoints: &HashMap<Symbol, Expr>,
    definitions: &mut Definitions,
) -> Vec<Expr> {
    let g = &system.graph;
    let positions = system.positions();
    let coefficients = quasi.coefficients.list();
    let within: HashSet<Symbol> = positions.iter().copied().chain(coefficients.iter().map(|c| c.0)).collect();
    let mut terms: HashMap<Symbol, Vec<Expr>> = HashMap::new();
    let add = |terms: &mut HashMap<Symbol, Vec<Expr>>, e: Expr, adjoint: Expr| {
        let symbols: Vec<Symbol> = g.symbols_of(e).into_iter().filter(|s| within.contains(s)).collect();
        for (s, derivative) in g.sparse_gradient(e, &symbols) {
            terms.entry(s).or_default().push(g.mul(derivative, adjoint));
        }
    };
    for d in quasi.dependent.iter().rev() {
        add(&mut terms, d.value(g), adjoints[&d.symbol]);
    }
    for &(symbol, e) in coefficients.iter().rev() {
        let Some(own) = terms.remove(&symbol) else { continue };
        let adjoint = definitions.short(g, "rc", SHORT, g.sum(&own));
        add(&mut terms, e, adjoint);
    }
    positions.iter().map(|q| terms.get(q).map_or(g.zero(), |terms| g.sum(terms))).collect()
}

/// Defines the multipliers `μ` with `seeds = Aᵀ μ`, the constraint eliminated last first.
pub(crate) fn multipliers(
    g: &Graph,
    quasi: &QuasiVelocities,
    symbols: &[Symbol],
    adjoints: &HashMap<Symbol, Expr>,
    definitions: &mut Definitions,
) {
    for eliminated in quasi.eliminated.iter().rev() {
        let own = eliminated.slopes.iter().map(|(v, slope)| g.mul(*slope, adjoints[v]));
        let later = eliminated.added.iter().map(|&(i, e)| g.mul(e, g.variable(symbols[i])));
        let terms: Vec<Expr> = own.chain(later).collect();
        definitions.define(symbols[eliminated.constraint], g.sum(&terms));
    }
}
