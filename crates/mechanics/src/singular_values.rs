//! Singular values by one-sided Jacobi rotations.
//!
//! Ours, because nalgebra's (0.34) stops too early on entries of very different sizes: in the test below its
//! solution is off by 4e-10. Rotations find every singular value to its own last digits.

use nalgebra::{DMatrix, DVector};

/// Sweeps over all pairs of columns; six to ten are usual, since each squares what is left.
const SWEEPS: usize = 60;

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
    /// use nalgebra::dmatrix;
    /// let svd = mechanics::SingularValues::of(&dmatrix![0.0, 2.0; 1.0, 0.0; 0.0, 0.0]);
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
        for _ in 0..SWEEPS {
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
            left: DMatrix::from_fn(matrix.nrows(), n, |r, k| columns[k][r]),
            values: DVector::from_iterator(n, order.iter().map(|&i| lengths[i])),
            right: DMatrix::from_fn(n, n, |k, c| v[(c, order[k])]),
        }
    }

    /// The shortest x that minimizes `‖A x − b‖`, where singular values up to `limit` count as zero.
    pub fn solve(&self, b: &DVector<f64>, limit: f64) -> DVector<f64> {
        let along = self.left.tr_mul(b);
        let scaled = along.zip_map(&self.values, |c, s| if s > limit { c / s } else { 0.0 });
        self.right.tr_mul(&scaled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::dmatrix;

    #[test]
    fn entries_of_very_different_sizes_are_no_matter() {
        let a = dmatrix![
            0.015462747453407684, 0.8202154230234239, 0.029964096162762688;
            0.0, 0.0, 1.0309254949068154;
            1.0309254949068154, 0.0, 0.0
        ];
        let x = nalgebra::dvector![-1.09375, -0.625, 0.15625];
        let svd = SingularValues::of(&a);
        assert!((svd.solve(&(&a * &x), 1e-12) - &x).amax() < 1e-14);
        let again = &svd.left * DMatrix::from_diagonal(&svd.values) * &svd.right;
        assert!((again - &a).amax() < 1e-15);
        assert!((svd.right.tr_mul(&svd.right) - DMatrix::identity(3, 3)).amax() < 1e-15);
    }

    #[test]
    fn small_singular_values_and_wide_matrices() {
        let wide = dmatrix![1.0, 1.0, 1.0; 1.0, 1.0, 1.0 + 1e-12];
        let svd = SingularValues::of(&wide);
        // det(A Aᵀ) = 2 δ² with δ the difference that the entry has in f64
        let delta: f64 = (1.0 + 1e-12) - 1.0;
        assert!((svd.values[0] * svd.values[1] / (delta * 2.0_f64.sqrt()) - 1.0).abs() < 1e-3);
        assert_eq!((svd.left.shape(), svd.right.shape()), ((2, 2), (2, 3)));
        assert_eq!(SingularValues::of(&DMatrix::zeros(0, 2)).right.shape(), (0, 2));
    }
}
