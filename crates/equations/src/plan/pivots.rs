//! Order of elimination of a sparse linear block: few operations, and no pivot that is small where tried.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use mechanics::elimination::{Pivot, SparseMatrix};
use symbolic::limits::PIVOT;

/// Points at which pivots are tried: at the first none may be small, at the others it is better if none is.
pub const POINTS: usize = 10;
pub(crate) const NEAR: usize = 2;

/// A pivot is not smaller than this part of the largest entry under it, …
const THRESHOLD: f64 = 0.1;

/// Extra cost of a pivot that is not a number, a division and the check of its size; and of one that is small
/// at a point far from the start. (On the diagonal of a mass matrix, a pivot that is small compared with its
/// column does no harm.)
const EXTRA: usize = 4;

/// An entry in numbers.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its values at the points.
    pub values: [f64; POINTS],
    /// Whether it is a number, parameters put in.
    pub constant: bool,
}

/// Strategy for the choice of the next pivot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strategy {
    /// On the diagonal; both sides of it stay the same.
    Symmetric,
    /// Anywhere.
    Sparse,
    /// In the columns of unknowns that no rate needs before all others: so these are never computed.
    UnneededFirst,
}

/// Pivots as (row, column), in order.
#[derive(Clone, Debug)]
pub struct Order {
    /// The pivots.
    pub pivots: Vec<(usize, usize)>,
    /// Multiplications of elimination and back-substitution, about.
    pub operations: usize,
}

/// A sparse matrix in numbers, scaled.
#[derive(Clone, Debug)]
pub struct Pattern {
    matrix: SparseMatrix<Entry>,
    /// Scale of each row at the first point, columns scaled before.
    pub(crate) row_scale: Vec<f64>,
}

impl Pattern {
    /// Scales columns, then rows, to largest entries of 1, as the numerical solve does; `None` if impossible.
    pub fn new(mut rows: Vec<BTreeMap<usize, Entry>>) -> Option<Self> {
        let mut row_scale = Vec::new();
        for point in 0..POINTS {
            match scale(&mut rows, point) {
                Some(scales) if point == 0 => row_scale = scales,
                Some(_) => {}
                None if point < NEAR => return None,
                None => rows.iter_mut().flat_map(|row| row.values_mut()).for_each(|e| e.values[point] = e.values[0]),
            }
        }
        Some(Pattern { matrix: SparseMatrix::new(rows), row_scale })
    }

    /// Number of entries that are not zero by structure.
    pub(crate) fn entries(&self) -> usize {
        self.matrix.rows().iter().map(BTreeMap::len).sum()
    }

    /// Finds pivots one after the other by what they cost (Markowitz' count), among those that are not small.
    ///
    /// `None` where all that are left are small, or the elimination takes more than `most` operations.
    pub fn order(&self, strategy: Strategy, unneeded: &[bool], most: usize) -> Option<Order> {
        let n = self.matrix.rows().len();
        let mut matrix = self.matrix.clone();
        let mut order = Order { pivots: Vec::with_capacity(n), operations: 0 };
        for _ in 0..n {
            let mut largest = vec![[0.0_f64; POINTS]; n];
            for (&j, e) in matrix.rows().iter().flatten() {
                for (a, x) in largest[j].iter_mut().zip(e.values) {
                    *a = a.max(x.abs());
                }
            }
            let small = |j: usize, e: &Entry, point: usize| {
                e.values[point].abs().partial_cmp(&PIVOT.max(THRESHOLD * largest[j][point])).is_none_or(Ordering::is_lt)
            };
            let mut best: Option<((bool, usize), (usize, usize))> = None;
            for (i, row) in matrix.rows().iter().enumerate() {
                for (&j, e) in row.iter().filter(|(j, _)| strategy != Strategy::Symmetric || **j == i) {
                    let late = strategy == Strategy::UnneededFirst && !unneeded[j];
                    let score = (late, cost(strategy, row.len(), matrix.rows_with(j).len(), e.constant));
                    if best.is_some_and(|(least, _)| score >= least) || (0..NEAR).any(|point| small(j, e, point)) {
                        continue;
                    }
                    let far = (NEAR..POINTS).filter(|&point| strategy != Strategy::Symmetric && small(j, e, point));
                    let score = (late, score.1 + EXTRA * far.count());
                    if best.is_none_or(|(least, _)| score < least) {
                        best = Some((score, (i, j)));
                    }
                }
            }
            let ((_, cost), (p, c)) = best?;
            order.pivots.push((p, c));
            order.operations += cost;
            if order.operations > most {
                return None;
            }
            eliminate(&mut matrix, p, c);
        }
        Some(order)
    }
}

/// Scales the matrix at one point; the scales of rows.
fn scale(rows: &mut [BTreeMap<usize, Entry>], point: usize) -> Option<Vec<f64>> {
    let mut column = vec![0.0_f64; rows.len()];
    for (&j, e) in rows.iter().flatten() {
        column[j] = column[j].max(e.values[point].abs());
    }
    let mut scales = Vec::with_capacity(rows.len());
    for row in rows.iter_mut() {
        let mut largest = 0.0_f64;
        for (&j, e) in row.iter_mut() {
            e.values[point] /= column[j];
            largest = largest.max(e.values[point].abs());
        }
        if largest == 0.0 || !row.values().all(|e| e.values[point].is_finite()) {
            return None;
        }
        row.values_mut().for_each(|e| e.values[point] /= largest);
        scales.push(1.0 / largest);
    }
    Some(scales)
}

/// Multiplications for a pivot, from the numbers of entries of its row and column.
fn cost(strategy: Strategy, row: usize, column: usize, constant: bool) -> usize {
    let updates = if strategy == Strategy::Symmetric { (column - 1) * column / 2 } else { (row - 1) * (column - 1) };
    updates + 2 * (column - 1) + row + if constant { 0 } else { EXTRA }
}

/// Takes row `p` and column `c` out, in numbers.
fn eliminate(matrix: &mut SparseMatrix<Entry>, p: usize, c: usize) {
    let Some(Pivot { entry: pivot, row, column }) = matrix.take(p, c) else { return };
    for (i, under) in column {
        for (&j, right) in &row {
            let entry = matrix.entry(i, j, Entry { values: [0.0; POINTS], constant: true });
            for (k, x) in entry.values.iter_mut().enumerate() {
                *x -= under.values[k] / pivot.values[k] * right.values[k];
            }
            entry.constant &= under.constant && right.constant && pivot.constant;
        }
    }
}
