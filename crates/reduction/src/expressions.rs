//! Sparse vectors of expressions, and shorter ways to write an expression.

use std::collections::{BTreeMap, HashMap};

use mechanics::{State, System};
pub(crate) use symbolic::limits::SHORT;
use symbolic::{Expr, Graph, Symbol};

/// A sparse vector.
pub(crate) type Sparse = BTreeMap<usize, Expr>;

/// `∂e_i/∂s_j`, row by row.
pub(crate) fn sparse_rows(g: &Graph, expressions: &[Expr], symbols: &[Symbol]) -> Vec<Sparse> {
    let places: HashMap<Symbol, usize> = symbols.iter().enumerate().map(|(i, &s)| (s, i)).collect();
    let row = |row: Vec<(Symbol, Expr)>| row.into_iter().map(|(s, e)| (places[&s], e)).collect();
    g.sparse_jacobian(expressions, symbols).into_iter().map(row).collect()
}

/// `aᵢ bᵢ` for every i with both.
pub(crate) fn products(g: &Graph, a: &Sparse, b: &Sparse) -> Vec<Expr> {
    a.iter().filter_map(|(i, &x)| Some(g.mul(x, *b.get(i)?))).collect()
}

/// `e`, with terms multiplied out or common factors drawn out, whatever is shortest.
pub(crate) fn shortest(g: &Graph, e: Expr) -> Expr {
    let expanded = g.expand_around_shifts(e);
    let ways = [e, g.factored(e), expanded, g.factored(expanded)];
    ways.into_iter().min_by_key(|&e| g.size(&[e])).unwrap_or(e)
}

/// Values of parameters, time, coordinates and velocities at `start`, or at a point of no significance.
pub(crate) fn point(system: &System, start: Option<&State>) -> HashMap<Symbol, f64> {
    let n = system.dimension();
    let drawn = || (1..=n).map(|i| 0.3 + (i as f64 * 0.618_033_988_749_895).fract()).collect();
    match start {
        Some(state) => system.values_at(state),
        None => system.values_at(&State { t: 0.3, q: drawn(), v: vec![0.0; n] }),
    }
}
