//! Elimination: of dense rows of numbers, by a policy for pivots ([`eliminate`]), and of sparse linear
//! expressions, for removals, quasi-velocities, sums of squares and plans.
//!
//! With a pivot `a_pc` and its row and column taken out ([`SparseMatrix::take`]), rows with `c` become
//!
//! ```text
//! a_ij ← a_ij − a_ic a_pj / a_pc .
//! ```
//!
//! In expressions, the caller writes quotient and difference: at once, factored, by way of names, or as terms
//! that are added up later. It also orders the pivots, except for the choice by size ([`choose_pivot`]).

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::{Add, Mul, Neg, Sub};

use symbolic::limits::DEPENDENT;
use symbolic::{Bounded, Expr, Graph, Scalar, Symbol};

use crate::RemovalError;

/// A pivot may be this much smaller than the largest one if it is better otherwise.
pub(crate) const PIVOT_CHOICE: f64 = 0.2;

/// Numbers of a matrix.
pub trait Entry:
    Copy + std::fmt::Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// `None` for 0.
    fn inverse(self) -> Option<Self>;
    /// What a pivot is chosen by; 0 for 0.
    fn weight(self) -> f64;
    /// Whether products with it have no effect: not so of a 0 that may be off.
    fn is_zero(self) -> bool {
        self.weight() == 0.0
    }
    /// Subtracts each factor times its row, rows as long as `into`.
    fn subtract_multiples(into: &mut [Self], factors: &[Self], rows: &[Self]) {
        let multiples = factors.iter().zip(rows.chunks_exact(into.len()));
        for (&factor, row) in multiples.filter(|(factor, _)| !factor.is_zero()) {
            into.iter_mut().zip(row).for_each(|(x, &y)| *x = *x - factor * y);
        }
    }
}

impl Entry for f64 {
    const ZERO: Self = 0.0;

    fn inverse(self) -> Option<Self> {
        (self != 0.0).then(|| 1.0 / self)
    }

    fn weight(self) -> f64 {
        self.abs()
    }
}

/// The weight of round-off among pivots.
const ROUNDED_WEIGHT: f64 = 1e-60;

impl Entry for Bounded {
    const ZERO: Self = Bounded { value: 0.0, magnitude: 0.0 };

    fn inverse(self) -> Option<Self> {
        (self.value != 0.0).then(|| Bounded::from_f64(1.0) / self)
    }

    fn weight(self) -> f64 {
        // what may be round-off is a pivot only where nothing else is
        if self.may_be_zero() { self.value.abs() * ROUNDED_WEIGHT } else { self.value.abs() }
    }

    fn is_zero(self) -> bool {
        self.value == 0.0 && self.magnitude == 0.0
    }
}

/// Gauss–Jordan elimination of dense `rows`. `pick` is the policy: from the rows and the columns of pivots so
/// far, whose rows come first, the place of the next pivot; `None` ends it. In the end each of these rows has
/// 1 in its column, which is returned, and all other rows have 0 there.
///
/// ```
/// use mechanics::elimination::{eliminate, largest, open};
/// let mut rows = vec![vec![1.0, 2.0, 5.0], vec![2.0, 4.0, 10.0], vec![0.0, 1.0, 2.0]];
/// let pivots = eliminate(&mut rows, |rows, done| {
///     largest(rows, open(rows, done, 2).filter(|&(i, j)| rows[i][j] != 0.0))
/// });
/// assert_eq!(pivots, [1, 0]);
/// assert_eq!(rows, [[0.0, 1.0, 2.0], [1.0, 0.0, 1.0], [0.0, 0.0, 0.0]]);
/// ```
pub fn eliminate<E: Entry>(
    rows: &mut [Vec<E>],
    mut pick: impl FnMut(&[Vec<E>], &[usize]) -> Option<(usize, usize)>,
) -> Vec<usize> {
    let mut pivots: Vec<usize> = Vec::new();
    while let Some((row, column)) = pick(rows, &pivots) {
        let Some(over) = rows[row][column].inverse() else { break };
        let done = pivots.len();
        rows.swap(done, row);
        let pivot: Vec<E> = rows[done].iter().map(|&x| x * over).collect();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != done) {
            let factor = row[column];
            if !factor.is_zero() {
                row.iter_mut().zip(&pivot).for_each(|(x, &p)| *x = *x - factor * p);
                row[column] = E::ZERO;
            }
        }
        rows[done] = pivot;
        pivots.push(column);
    }
    pivots
}

/// The places for further pivots in the first columns, row by row.
pub fn open<E>(rows: &[Vec<E>], done: &[usize], columns: usize) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    let places = move |i: usize| (0..columns).map(move |j| (i, j));
    (done.len()..rows.len()).flat_map(places).filter(move |(_, j)| !done.contains(j))
}

/// The place of the largest entry, of equals the last.
pub fn largest<E: Entry>(rows: &[Vec<E>], places: impl Iterator<Item = (usize, usize)>) -> Option<(usize, usize)> {
    let weight = |(i, j): (usize, usize)| rows[i][j].weight();
    places.max_by(|&a, &b| weight(a).total_cmp(&weight(b)))
}

/// A sparse matrix by rows that knows which rows contain a column. Entries are what stands for coefficients.
#[derive(Clone, Debug)]
pub struct SparseMatrix<T> {
    rows: Vec<BTreeMap<usize, T>>,
    holders: Vec<BTreeSet<usize>>,
}

/// A pivot that was taken out.
#[derive(Clone, Debug)]
pub struct Pivot<T> {
    /// `a_pc`.
    pub entry: T,
    /// The other entries of its row, `a_pj` by `j`.
    pub row: BTreeMap<usize, T>,
    /// The other entries of its column, `(i, a_ic)`.
    pub column: Vec<(usize, T)>,
}

impl<T> SparseMatrix<T> {
    /// The matrix of these rows, each by column.
    pub fn new(rows: Vec<BTreeMap<usize, T>>) -> Self {
        let mut matrix = SparseMatrix { rows: Vec::with_capacity(rows.len()), holders: Vec::new() };
        for row in rows {
            matrix.rows.push(BTreeMap::new());
            matrix.put_row(matrix.rows.len() - 1, row);
        }
        matrix
    }

    /// All rows; those taken out are empty.
    pub fn rows(&self) -> &[BTreeMap<usize, T>] {
        &self.rows
    }

    /// The rows that contain a column.
    pub fn rows_with(&self, column: usize) -> impl ExactSizeIterator<Item = usize> {
        self.holders.get(column).unwrap_or(const { &BTreeSet::new() }).iter().copied()
    }

    /// Sets an entry, or takes it out.
    pub fn set(&mut self, row: usize, column: usize, entry: Option<T>) {
        match entry {
            Some(entry) => {
                self.rows[row].insert(column, entry);
                self.holders_of(column).insert(row);
            }
            None => {
                self.rows[row].remove(&column);
                self.holders_of(column).remove(&row);
            }
        }
    }

    /// An entry to be changed, `absent` if nothing stood there.
    pub fn entry(&mut self, row: usize, column: usize, absent: T) -> &mut T {
        self.holders_of(column).insert(row);
        self.rows[row].entry(column).or_insert(absent)
    }

    /// Sets all entries of a row that is empty.
    pub fn put_row(&mut self, row: usize, entries: BTreeMap<usize, T>) {
        for &column in entries.keys() {
            self.holders_of(column).insert(row);
        }
        self.rows[row] = entries;
    }

    /// Takes a row out, which is empty afterwards.
    pub fn take_row(&mut self, row: usize) -> BTreeMap<usize, T> {
        let entries = std::mem::take(&mut self.rows[row]);
        for &column in entries.keys() {
            self.holders_of(column).remove(&row);
        }
        entries
    }

    /// Takes a column out.
    pub fn take_column(&mut self, column: usize) -> Vec<(usize, T)> {
        let rows = std::mem::take(self.holders_of(column));
        rows.into_iter().filter_map(|i| Some((i, self.rows[i].remove(&column)?))).collect()
    }

    /// Takes a pivot out with its row and its column; `None` where nothing stands there.
    pub fn take(&mut self, row: usize, column: usize) -> Option<Pivot<T>> {
        let mut entries = self.take_row(row);
        let entry = entries.remove(&column)?;
        Some(Pivot { entry, row: entries, column: self.take_column(column) })
    }

    fn holders_of(&mut self, column: usize) -> &mut BTreeSet<usize> {
        if self.holders.len() <= column {
            self.holders.resize(column + 1, BTreeSet::new());
        }
        &mut self.holders[column]
    }
}

/// A possible pivot.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Its size at the start, in a row scaled to 1; positive.
    pub size: f64,
    /// The cost of choosing it.
    pub cost: usize,
    /// Row and column.
    pub place: (usize, usize),
}

/// Among the pivots that are large enough, the one that costs least; of equals the largest, then the first.
///
/// # Errors
/// [`RemovalError::Dependent`] where none is.
pub fn choose_pivot(mut candidates: Vec<Candidate>) -> Result<(usize, usize), RemovalError> {
    let largest = candidates.iter().fold(0.0_f64, |a, c| a.max(c.size));
    if largest < DEPENDENT {
        return Err(RemovalError::Dependent { pivot: largest, limit: DEPENDENT });
    }
    candidates.retain(|c| c.size >= PIVOT_CHOICE * largest);
    candidates.sort_by(|a, b| a.cost.cmp(&b.cost).then(b.size.total_cmp(&a.size)).then(a.place.cmp(&b.place)));
    Ok(candidates[0].place)
}

/// `Σ_j a_ij x_j + b_i`, expression by expression.
#[derive(Clone, Debug)]
pub struct LinearForms {
    /// `a_ij` by `j`, zeros left out.
    pub rows: Vec<BTreeMap<usize, Expr>>,
    /// `b_i`.
    pub offsets: Vec<Expr>,
}

impl LinearForms {
    /// The expressions as linear forms in `unknowns`.
    ///
    /// # Errors
    /// The place of the first expression that is not linear.
    pub fn new(g: &Graph, expressions: &[Expr], unknowns: &[Symbol]) -> Result<Self, usize> {
        let places: HashMap<Symbol, usize> = unknowns.iter().enumerate().map(|(j, &x)| (x, j)).collect();
        let mut rows = Vec::with_capacity(expressions.len());
        for (i, entries) in g.sparse_jacobian(expressions, unknowns).into_iter().enumerate() {
            if entries.iter().any(|(_, e)| g.symbols_of(*e).iter().any(|s| places.contains_key(s))) {
                return Err(i);
            }
            rows.push(entries.into_iter().filter(|(_, e)| !g.is_zero(*e)).map(|(x, e)| (places[&x], e)).collect());
        }
        let at_zero = unknowns.iter().map(|&x| (x, g.zero())).collect();
        Ok(LinearForms { rows, offsets: g.substitute_all(expressions, &at_zero) })
    }
}
