//! Small dense linear equations in any wide type.

use crate::Wide;

/// A scaled pivot under this is taken for zero.
const PIVOT_LIMIT: f64 = 1e-13;

/// The matrix is singular, or not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Singular {
    /// Smallest scaled pivot.
    pub(crate) pivot: f64,
}

/// An LU decomposition by Gaussian elimination with scaled partial pivoting.
#[derive(Clone)]
pub(crate) struct Factors<T> {
    size: usize,
    lu: Vec<T>,
    rows: Vec<usize>,
}

impl<T: Wide> Factors<T> {
    /// Factorizes `matrix`, row-major.
    ///
    /// Rows and columns are compared with the powers of two next to their largest entries, so that neither units nor the scaling round.
    pub(crate) fn new(matrix: &[T], size: usize) -> Result<Self, Singular> {
        let power = |largest: f64| if largest > 0.0 { 2.0_f64.powi(-(largest.log2().floor() as i32)) } else { 0.0 };
        let columns: Vec<f64> =
            (0..size).map(|j| power((0..size).fold(0.0, |a: f64, i| a.max(matrix[i * size + j].size())))).collect();
        let row_scale: Vec<f64> = (0..size)
            .map(|i| power((0..size).fold(0.0, |a: f64, j| a.max(matrix[i * size + j].size() * columns[j]))))
            .collect();
        let mut factors = Factors { size, lu: matrix.to_vec(), rows: (0..size).collect() };
        let lu = &mut factors.lu;
        for k in 0..size {
            let scaled = |i: usize, lu: &[T]| lu[i * size + k].size() * row_scale[factors.rows[i]] * columns[k];
            let best = (k..size).max_by(|&a, &b| scaled(a, lu).total_cmp(&scaled(b, lu))).unwrap_or(k);
            let pivot = scaled(best, lu);
            if !(pivot > PIVOT_LIMIT && pivot.is_finite()) {
                return Err(Singular { pivot });
            }
            factors.rows.swap(k, best);
            for j in 0..size {
                lu.swap(k * size + j, best * size + j);
            }
            for i in k + 1..size {
                let factor = lu[i * size + k] / lu[k * size + k];
                lu[i * size + k] = factor;
                if factor.size() == 0.0 {
                    continue;
                }
                for j in k + 1..size {
                    lu[i * size + j] = lu[i * size + j] - factor * lu[k * size + j];
                }
            }
        }
        Ok(factors)
    }

    /// The solution for the right-hand side `b`.
    pub(crate) fn solve(&self, b: &[T]) -> Vec<T> {
        let n = self.size;
        let mut x: Vec<T> = self.rows.iter().map(|&row| b[row]).collect();
        for i in 0..n {
            x[i] = (0..i).fold(x[i], |rest, j| rest - self.lu[i * n + j] * x[j]);
        }
        for i in (0..n).rev() {
            x[i] = (i + 1..n).fold(x[i], |rest, j| rest - self.lu[i * n + j] * x[j]) / self.lu[i * n + i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DoubleDouble;
    use symbolic::Scalar;

    #[test]
    fn solves_in_any_units_to_the_last_digits() {
        // [ 2 0 −1; 0 1 −1; 1 1 0 ] z = (1, 2, 3), z = (2/3, 7/3, 1/3)
        for unit in [1e-12, 1.0, 1e12] {
            let number = DoubleDouble::from_f64;
            let (u, zero, one) = (number(unit), number(0.0), number(1.0));
            let matrix = [number(2.0), zero, -u, zero, one, -u, u, u, zero];
            let z = Factors::new(&matrix, 3).unwrap().solve(&[one, number(2.0), u * number(3.0)]);
            let right = [(2, 3), (7, 3), (1, 3)].map(|(p, q)| DoubleDouble::from_ratio(p, q));
            assert!((z[0] - right[0]).size().max((z[1] - right[1]).size()) < 1e-30);
            assert!((z[2] * u - right[2]).size() < 1e-30);
        }
    }

    #[test]
    fn refuses_dependent_rows() {
        assert!(Factors::new(&[1.0, 2.0, 2.0, 4.0], 2).is_err());
        assert!(Factors::new(&[0.0, 0.0, 2.0, 4.0], 2).is_err());
        assert!(Factors::new(&[f64::NAN, 1.0, 2.0, 4.0], 2).is_err());
    }
}
