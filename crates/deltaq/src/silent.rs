//! Configurations at which a constraint does not restrict the velocities, or constraints are dependent, for
//! all velocities.

use std::collections::BTreeMap;

use mechanics::System;
use symbolic::{Expr, Graph, Matrix, Range};

/// Minors of full size are looked at where there are at most this many, of at most this many terms in all
/// before any cancel.
const MINORS: usize = 56;
const TERMS: usize = 2_000;

/// Factors, free of velocities, of all entries of a constraint's `∂f/∂v`, or of all minors of full size of
/// the matrix of several constraints: where one vanishes, a constraint or a combination of constraints says
/// nothing.
///
/// With multipliers the motion would go on by continuity, though `f = 0` holds there whatever some of the
/// velocities do. A factor that never vanishes is none. Where the entries vanish together, but have no factor
/// in common, nothing is found, as for `x z' + y w'` at `x = y = 0`.
pub(crate) fn silent(system: &System) -> Vec<Expr> {
    let (g, v, jacobian) = (&system.graph, system.velocities(), system.constraint_jacobian());
    let ranges = system.parameter_values().into_iter().map(|(s, x)| (s, Range::point(x))).collect();
    let may_vanish = |e: &Expr| {
        let (symbols, range) = (g.symbols_of(*e), g.range(*e, &ranges));
        let moves = symbols.iter().any(|s| !ranges.contains_key(s)) && !symbols.iter().any(|s| v.contains(s));
        moves && range.low <= 0.0 && range.high >= 0.0
    };
    let rows = (0..jacobian.rows()).flat_map(|i| g.common_factors(jacobian.row(i)));
    let mut found: Vec<Expr> = rows.chain(g.common_factors(&minors(g, &jacobian))).filter(may_vanish).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The minors of full size, multiplied out; none of one row, nor where they are many or large.
fn minors(g: &Graph, jacobian: &Matrix) -> Vec<Expr> {
    let (rows, columns) = (jacobian.rows(), jacobian.columns());
    if rows < 2 || rows > columns {
        return Vec::new();
    }
    // of the first rows, by columns
    let mut minors = BTreeMap::from([(0_u64, g.one())]);
    for i in 0..rows {
        let mut larger: BTreeMap<u64, Vec<Expr>> = BTreeMap::new();
        for (&chosen, &minor) in &minors {
            for (j, &e) in jacobian.row(i).iter().enumerate() {
                if chosen >> j & 1 == 0 && !g.is_zero(e) {
                    let is_odd = (chosen >> j).count_ones() % 2 == 1;
                    let term = g.mul(e, minor);
                    larger.entry(chosen | 1 << j).or_default().push(if is_odd { g.neg(term) } else { term });
                }
            }
        }
        let terms = larger.values().flatten().map(|&term| g.expanded_terms(term)).sum::<usize>();
        if larger.len() > MINORS || terms > TERMS {
            return Vec::new();
        }
        minors = larger.into_iter().map(|(chosen, terms)| (chosen, g.expand(g.sum(&terms)))).collect();
    }
    minors.into_values().collect()
}
