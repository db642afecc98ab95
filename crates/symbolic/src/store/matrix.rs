//! Matrices of expressions.

use crate::Expr;

/// Dense matrix of expressions, row-major.
///
/// ```
/// use symbolic::{Graph, Matrix};
/// let g = Graph::new();
/// let identity = Matrix::from_fn(2, 2, |i, j| if i == j { g.one() } else { g.zero() });
/// assert_eq!(identity.transpose(), identity);
/// assert_eq!(identity[(1, 1)], g.one());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    entries: Vec<Expr>,
}

impl Matrix {
    /// A matrix from its entries, row by row.
    ///
    /// # Panics
    /// If there are not exactly `rows · columns` entries.
    pub fn new(rows: usize, columns: usize, entries: Vec<Expr>) -> Self {
        let count = entries.len();
        assert_eq!(rows * columns, count, "a {rows}×{columns} matrix was given {count} entries");
        Self { rows, columns, entries }
    }

    /// The matrix with `entry(i, j)` in row i, column j.
    pub fn from_fn(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> Expr) -> Self {
        let mut entries = Vec::with_capacity(rows * columns);
        for i in 0..rows {
            for j in 0..columns {
                entries.push(entry(i, j));
            }
        }
        Self { rows, columns, entries }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// All entries, row by row.
    pub fn entries(&self) -> &[Expr] {
        &self.entries
    }

    /// Row i, counted from 0.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, i: usize) -> &[Expr] {
        assert!(i < self.rows, "row {i} of a matrix with {} rows", self.rows);
        &self.entries[i * self.columns..(i + 1) * self.columns]
    }

    /// Column j, counted from 0.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn column(&self, j: usize) -> Vec<Expr> {
        (0..self.rows).map(|i| self[(i, j)]).collect()
    }

    /// The transposed matrix.
    pub fn transpose(&self) -> Matrix {
        Matrix::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }
}

impl std::ops::Index<(usize, usize)> for Matrix {
    type Output = Expr;

    fn index(&self, (i, j): (usize, usize)) -> &Expr {
        assert!(j < self.columns, "column {j} of a matrix with {} columns", self.columns);
        &self.row(i)[j]
    }
}
