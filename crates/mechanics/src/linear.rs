//! Small dense linear systems in place, without allocation: the one solve of every instant.
//!
//! In `f64` and the wide types of references. Written here: it runs once an evaluation on matrices of 1 to 20
//! rows, where a general factorization mostly allocates. What runs once is left to nalgebra.

use symbolic::Scalar;
/// Pivots under this fraction of the scaled matrix are taken for zero.
pub use symbolic::limits::OF_TERMS as PIVOT_LIMIT;

/// A number type in which linear systems are solved.
pub trait Entry: Scalar {
    /// `|x|` as `f64`: for norms, pivots and step sizes, never for the solution itself.
    fn size(self) -> f64;
    /// Relative spacing of the numbers.
    const EPSILON: f64;
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
}

impl Entry for f64 {
    const EPSILON: f64 = f64::EPSILON;
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline]
    fn size(self) -> f64 {
        self.abs()
    }
}

/// A matrix that cannot be solved with: the smallest pivot over the largest after scaling, and the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singular {
    /// Smallest pivot over the largest.
    pub reciprocal: f64,
}

/// A smaller pivot may be the work of units.
const DOUBTFUL: f64 = 1e-6;

/// Sweeps over rows and columns that bring all entries near 1.
const BALANCES: usize = 4;

/// LU factors of an n×n matrix, row-major, partial pivoting; rows and columns scaled against units.
#[derive(Clone, Debug)]
pub struct Factors<T = f64> {
    n: usize,
    lu: Vec<T>,
    rows: Vec<usize>,
    row_scale: Vec<T>,
    column_scale: Vec<T>,
    work: Vec<T>,
}

impl<T: Entry> Factors<T> {
    /// Room for n×n.
    pub fn new(n: usize) -> Self {
        let [zero, one] = [0.0, 1.0].map(T::from_f64);
        let (lu, rows) = (vec![zero; n * n], vec![0; n]);
        Factors { n, lu, rows, row_scale: vec![one; n], column_scale: vec![one; n], work: vec![zero; n] }
    }

    /// Factorizes `matrix` (row-major, n×n). Where a pivot is small with rows and columns scaled to a largest
    /// entry of 1, all entries are brought as near to 1 as can be: other units may make it large.
    pub fn factorize(&mut self, matrix: &[T]) -> Result<(), Singular> {
        let first = self.factorize_scaled(matrix, false);
        if first.as_ref().is_ok_and(|least| *least >= DOUBTFUL) {
            return Ok(());
        }
        let balanced = self.factorize_scaled(matrix, true);
        let least = |found: &Result<f64, Singular>| found.as_ref().ok().copied().unwrap_or(0.0);
        if balanced.is_ok() && least(&balanced) >= least(&first) {
            return Ok(());
        }
        first.and_then(|_| self.factorize_scaled(matrix, false)).map(|_| ())
    }

    /// The smallest pivot.
    fn factorize_scaled(&mut self, matrix: &[T], balanced: bool) -> Result<f64, Singular> {
        self.lu.copy_from_slice(matrix);
        self.column_scale.fill(T::from_f64(1.0));
        self.row_scale.fill(T::from_f64(1.0));
        if balanced {
            self.balance();
        }
        self.scale()?;
        self.eliminate()
    }

    fn eliminate(&mut self) -> Result<f64, Singular> {
        let n = self.n;
        let mut least = f64::INFINITY;
        for (i, row) in self.rows.iter_mut().enumerate() {
            *row = i;
        }
        for k in 0..n {
            let mut best = (k, self.lu[k * n + k].size());
            for i in k + 1..n {
                let x = self.lu[i * n + k].size();
                if x > best.1 {
                    best = (i, x);
                }
            }
            if best.1.is_nan() || best.1 < PIVOT_LIMIT {
                return Err(Singular { reciprocal: best.1 });
            }
            least = least.min(best.1);
            if best.0 != k {
                self.rows.swap(k, best.0);
                for j in 0..n {
                    self.lu.swap(k * n + j, best.0 * n + j);
                }
            }
            let (upper, lower) = self.lu.split_at_mut((k + 1) * n);
            let pivot_row = &upper[k * n..];
            for row in lower.chunks_exact_mut(n) {
                if row[k].size() == 0.0 {
                    continue;
                }
                let factor = row[k] / pivot_row[k];
                row[k] = factor;
                for j in k + 1..n {
                    row[j] = row[j] - factor * pivot_row[j];
                }
            }
        }
        Ok(least)
    }

    /// Scales rows and columns by powers of 2 so that their largest and smallest entries are as far from 1.
    /// Rows and columns that both stay as they are do so in each later sweep.
    fn balance(&mut self) {
        let n = self.n;
        let mut at_rest = 0;
        for sweep in 0..2 * BALANCES {
            if at_rest == 2 {
                return;
            }
            at_rest += 1;
            for i in 0..n {
                let place = |j: usize| if sweep % 2 == 0 { i * n + j } else { j * n + i };
                let sizes = || (0..n).map(|j| self.lu[place(j)].size()).filter(|size| *size > 0.0);
                let (least, largest) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
                let scale = (-0.5 * (least.log2() + largest.log2())).round().exp2();
                if scale.is_normal() && scale != 1.0 {
                    at_rest = 0;
                    let scale = T::from_f64(scale);
                    let by = if sweep % 2 == 0 { &mut self.row_scale } else { &mut self.column_scale };
                    by[i] = by[i] * scale;
                    (0..n).for_each(|j| self.lu[place(j)] = self.lu[place(j)] * scale);
                }
            }
        }
    }

    /// Scales columns, then rows, to a largest entry of 1.
    fn scale(&mut self) -> Result<(), Singular> {
        let n = self.n;
        for j in 0..n {
            let largest = (0..n).fold(0.0_f64, |a, i| a.max(self.lu[i * n + j].size()));
            if largest == 0.0 || !largest.is_finite() {
                return Err(Singular { reciprocal: if largest == 0.0 { 0.0 } else { f64::NAN } });
            }
            let scale = T::from_f64(1.0 / largest);
            self.column_scale[j] = self.column_scale[j] * scale;
            (0..n).for_each(|i| self.lu[i * n + j] = self.lu[i * n + j] * scale);
        }
        for (i, row) in self.lu.chunks_exact_mut(n).enumerate() {
            let mut largest = 0.0_f64;
            for x in row.iter() {
                largest = largest.max(x.size());
            }
            if largest == 0.0 || !largest.is_finite() {
                return Err(Singular { reciprocal: if largest == 0.0 { 0.0 } else { f64::NAN } });
            }
            let scale = T::from_f64(1.0 / largest);
            self.row_scale[i] = self.row_scale[i] * scale;
            for x in row {
                *x = *x * scale;
            }
        }
        Ok(())
    }

    /// `|L| |U| |x|`, in the rows and units of the matrix: what elimination adds up on the way to `x`.
    pub fn eliminated(&self, x: &[T]) -> Vec<f64> {
        let n = self.n;
        let sizes: Vec<f64> = x.iter().zip(&self.column_scale).map(|(x, scale)| x.size() / scale.size()).collect();
        let upper = |i: usize| (i..n).map(|j| self.lu[i * n + j].size() * sizes[j]).sum::<f64>();
        let upper: Vec<f64> = (0..n).map(upper).collect();
        let mut sums = vec![0.0; n];
        for (i, &row) in self.rows.iter().enumerate() {
            let lower: f64 = (0..i).map(|j| self.lu[i * n + j].size() * upper[j]).sum();
            sums[row] = (lower + upper[i]) / self.row_scale[row].size();
        }
        sums
    }

    /// Overwrites `b` by the solution.
    pub fn solve(&mut self, b: &mut [T]) {
        let n = self.n;
        for i in 0..n {
            let row = self.rows[i];
            let mut x = b[row] * self.row_scale[row];
            for j in 0..i {
                x = x - self.lu[i * n + j] * self.work[j];
            }
            self.work[i] = x;
        }
        for i in (0..n).rev() {
            let mut x = self.work[i];
            for j in i + 1..n {
                x = x - self.lu[i * n + j] * self.work[j];
            }
            self.work[i] = x / self.lu[i * n + i];
        }
        for (x, (z, scale)) in b.iter_mut().zip(self.work.iter().zip(&self.column_scale)) {
            *x = *z * *scale;
        }
    }
}
