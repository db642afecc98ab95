//! Singular values by one-sided Jacobi rotations.
//!
//! Ours, because nalgebra's (0.34) stops too early on entries of very different sizes: in their test its
//! solution is off by 4e-10. Rotations find every singular value to its own last digits.

use nalgebra::{DMatrix, DVector};
use symbolic::limits::ITERATIONS;

/// `A = U diag(σ) V`, σ falling: `U` is m×k, `V` k×n, k = min(m, n). Columns of `U` with σ = 0 are zero.
pub struct SingularValues {
    /// `U`, left singular vectors in its columns.
    pub left: DMatrix<f64>,
    /// `σ`.
    pub values: DVector<f64>,
    /// `V`, right singular vectors in its rows.
    pub right: DMatrix<f64>,
}

impl SingularValues {
    /// Of a matrix whose entries are finite.
    ///
    /// ```
    /// use nalgebra::DMatrix;
    /// let matrix = DMatrix::from_row_slice(3, 2, &[0.0, 2.0, 1.0, 0.0, 0.0, 0.0]);
    /// let svd = mechanics::SingularValues::of(&matrix);
    /// assert_eq!(svd.values.as_slice(), [2.0, 1.0]);
    /// ```
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        if matrix.nrows() < matrix.ncols() {
            let SingularValues { left, values, right } = Self::of(&matrix.transpose());
            return SingularValues { left: right.transpose(), values, right: left.transpose() };
        }
        let n = matrix.ncols();
        let (mut u, mut v) = (matrix.clone(), DMatrix::identity(n, n));
        let mut squares: Vec<f64> = u.column_iter().map(|column| column.norm_squared()).collect();
        for _ in 0..ITERATIONS {
            let mut turned = false;
            for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
                let (a, b) = (squares[i], squares[j]);
                let c = u.column(i).dot(&u.column(j));
                if c.abs() <= f64::EPSILON * (a * b).sqrt() || c == 0.0 {
                    continue;
                }
                turned = true;
                let ratio = (b - a) / (2.0 * c);
                let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                let sine = cosine * tangent;
                for m in [&mut u, &mut v] {
                    let (mut x, mut y) = m.columns_range_pair_mut(i, j);
                    for (x, y) in x.iter_mut().zip(y.iter_mut()) {
                        (*x, *y) = (*x * cosine - *y * sine, *x * sine + *y * cosine);
                    }
                }
                (squares[i], squares[j]) = (u.column(i).norm_squared(), u.column(j).norm_squared());
            }
            if !turned {
                break;
            }
        }
        let lengths: Vec<f64> = u.column_iter().map(|c| c.norm()).collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&i, &j| lengths[j].total_cmp(&lengths[i]));
        let unit = |&i: &usize| if lengths[i] > 0.0 { u.column(i) / lengths[i] } else { u.column(i).into_owned() };
        let columns: Vec<DVector<f64>> = order.iter().map(unit).collect();
        SingularValues {
            left: DMatrix::from_fn(u.nrows(), n, |r, k| columns[k][r]),
            values: DVector::from_iterator(n, order.iter().map(|&i| lengths[i])),
            right: DMatrix::from_fn(n, n, |k, c| v[(c, order[k])]),
        }
    }

    /// A lower bound of the smallest one of a matrix with no more rows than columns, in a fraction of the
    /// time: `σ = 1/‖L⁻¹‖ ≥ 1/‖L⁻¹‖_F` for Cholesky's `L Lᵀ = A Aᵀ`, less the round-off of `A Aᵀ`. Zero says
    /// nothing.
    pub fn least_at_least(matrix: &DMatrix<f64>) -> f64 {
        let round_off = 4.0 * (matrix.nrows() + matrix.ncols()) as f64 * f64::EPSILON * matrix.norm_squared();
        let rows = matrix.transpose();
        let lower = rows.tr_mul(&rows).cholesky().map(|factors| factors.l());
        let inverse = lower.and_then(|l| l.solve_lower_triangular(&DMatrix::identity(l.nrows(), l.nrows())));
        inverse.map_or(0.0, |inverse| (inverse.norm_squared().recip() - round_off).max(0.0).sqrt())
    }

    /// How many are over this part of the largest.
    pub(crate) fn rank(&self, limit: f64) -> usize {
        self.values.iter().filter(|value| **value > limit * self.values[0]).count()
    }

    /// The shortest x that minimizes `‖A x − b‖`, where singular values up to `limit` count as zero.
    pub fn solve(&self, b: &DVector<f64>, limit: f64) -> DVector<f64> {
        let along = self.left.tr_mul(b);
        let scaled = along.zip_map(&self.values, |c, s| if s > limit { c / s } else { 0.0 });
        self.right.tr_mul(&scaled)
    }

    /// The orthogonal projection on the kernel, where singular values up to `limit` count as zero.
    pub fn on_kernel(&self, limit: f64) -> DMatrix<f64> {
        let n = self.right.ncols();
        let seen = (0..self.values.len()).filter(|&k| self.values[k] > limit).map(|k| self.right.row(k));
        seen.fold(DMatrix::identity(n, n), |rest, row| rest - row.transpose() * row)
    }
}
