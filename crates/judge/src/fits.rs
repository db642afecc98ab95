//! Numbers by least squares, with what a jackknife makes of their errors.

use nalgebra::{DMatrix, DVector};

use crate::Number;

/// Pieces of a film, one of which is left out in turn.
const PIECES: usize = 8;
/// A column this much shorter than what it stands beside cannot be seen.
const UNSEEN: f64 = 1e-12;

/// `right ≈ columns · x` sample by sample.
pub(crate) struct Regression {
    /// Per sample: equations by unknowns.
    pub(crate) columns: Vec<DMatrix<f64>>,
    pub(crate) right: Vec<DVector<f64>>,
}

impl Regression {
    /// The unknowns, those that are not seen zero, and the sum of squares that remains.
    fn solved(&self, left_out: Option<usize>) -> DVector<f64> {
        let unknowns = self.columns[0].ncols();
        let piece = |k: usize| k * PIECES / self.columns.len();
        let (mut matrix, mut right) = (DMatrix::zeros(unknowns, unknowns), DVector::zeros(unknowns));
        for (k, (column, r)) in self.columns.iter().zip(&self.right).enumerate() {
            if left_out != Some(piece(k)) {
                matrix += column.transpose() * column;
                right += column.transpose() * r;
            }
        }
        // columns of any size are made alike before it is decided which of them are seen
        let scale = DVector::from_iterator(
            unknowns,
            matrix.diagonal().iter().map(|x: &f64| 1.0 / x.sqrt().max(f64::MIN_POSITIVE)),
        );
        let scaled = DMatrix::from_diagonal(&scale) * matrix * DMatrix::from_diagonal(&scale);
        let found = scaled.svd(true, true).solve(&right.component_mul(&scale), UNSEEN);
        found.map_or_else(|_| DVector::zeros(unknowns), |x| x.component_mul(&scale))
    }

    /// The unknowns with their standard errors.
    pub(crate) fn numbers(&self) -> Vec<Number> {
        let value = self.solved(None);
        let parts: Vec<DVector<f64>> = (0..PIECES).map(|piece| self.solved(Some(piece))).collect();
        let mean = parts.iter().sum::<DVector<f64>>() / PIECES as f64;
        let spread: DVector<f64> = parts.iter().map(|part| (part - &mean).map(|x| x * x)).sum();
        let error = spread.map(|x| (x * (PIECES - 1) as f64 / PIECES as f64).sqrt());
        value.iter().zip(&error).map(|(&value, &error)| Number { value, error }).collect()
    }

    /// The root of the mean square of what remains with these numbers.
    pub(crate) fn rest(&self, numbers: &[Number]) -> f64 {
        let x = DVector::from_iterator(numbers.len(), numbers.iter().map(|number| number.value));
        let rests = self.columns.iter().zip(&self.right).map(|(column, right)| (right - column * &x).norm_squared());
        root_mean(rests, self.right.len())
    }
}

/// The root of the mean of these squares.
pub(crate) fn root_mean(squares: impl Iterator<Item = f64>, count: usize) -> f64 {
    (squares.sum::<f64>() / count as f64).sqrt()
}
