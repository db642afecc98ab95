//! A mass matrix as a sum of squares.

use std::collections::{BTreeSet, HashMap};

use mechanics::System;
use mechanics::elimination::{Pivot, SparseMatrix};
use symbolic::limits::{LONG, PIVOT};
use symbolic::{Expr, Symbol};

use crate::expressions::{Sparse, shortest};

/// `c (s (v_k + Σ l_j v_j))²`
pub(super) struct Square {
    /// k
    pub(super) coordinate: usize,
    /// c, constant
    pub(super) inertia: Expr,
    /// s
    pub(super) scale: Expr,
    /// l
    pub(super) others: Vec<(usize, Expr)>,
}

/// Which of several pivots that fill the same is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tie {
    Earliest,
    Latest,
}

/// What is known at the start.
pub(super) struct Known<'a> {
    pub(super) system: &'a System,
    /// Values of all symbols of the system.
    pub(super) values: HashMap<Symbol, f64>,
}

impl Known<'_> {
    /// The value at the start; NaN where it is not finite.
    fn number(&self, e: Expr) -> f64 {
        self.system.graph.evaluate(e, &self.values).unwrap_or(f64::NAN)
    }

    /// Eliminates by diagonal pivots: constant ones, then least fill. `None` where one is not a square, or an
    /// entry gets long.
    pub(super) fn squares(&self, mass: &[Sparse], tie: Tie) -> Option<Vec<Square>> {
        let (system, g) = (self.system, &self.system.graph);
        let mut matrix = SparseMatrix::new(mass.to_vec());
        let mut left: BTreeSet<usize> = (0..mass.len()).collect();
        let mut squares = Vec::new();
        while !left.is_empty() {
            let score = |&k: &usize| {
                let row = &matrix.rows()[k];
                let constant = row.get(&k).is_some_and(|&e| system.is_constant(e));
                (!constant, row.len(), if tie == Tie::Latest { mass.len() - k } else { k })
            };
            let pivot = *left.iter().min_by_key(|k| score(k))?;
            left.remove(&pivot);
            let Pivot { entry: e, row: others, .. } = matrix.take(pivot, pivot)?;
            let (inertia, scale) = g.square(e, &|s| system.is_parameter(s))?;
            let (size, whole) = (self.number(e), mass[pivot].get(&pivot).map_or(0.0, |&e| self.number(e)));
            if !(self.number(inertia) > 0.0 && size >= PIVOT * whole.abs() && size > 0.0) {
                return None;
            }
            let factors: Vec<(usize, Expr)> =
                others.iter().map(|(&j, &entry)| (j, g.factored(g.div(entry, e)))).collect();
            for &(i, l) in &factors {
                for (&j, &entry) in &others {
                    let before = matrix.rows()[i].get(&j).copied().unwrap_or(g.zero());
                    let e = g.sub(before, g.mul(l, entry));
                    if g.size(&[e]) > LONG {
                        return None;
                    }
                    let e = shortest(g, e);
                    matrix.set(i, j, (!g.is_zero(e)).then_some(e));
                }
            }
            squares.push(Square { coordinate: pivot, inertia, scale, others: factors });
        }
        Some(squares)
    }
}
