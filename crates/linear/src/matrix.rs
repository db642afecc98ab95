//! Parts of matrices, and matrices in other units.

use nalgebra::{DMatrix, DVector, Scalar, linalg::balancing::balance_parlett_reinsch};

/// The rows and columns at some places.
pub(crate) fn part<T: Scalar + Copy>(matrix: &DMatrix<T>, places: &[usize]) -> DMatrix<T> {
    DMatrix::from_fn(places.len(), places.len(), |i, j| matrix[(places[i], places[j])])
}

/// A matrix in units in which its rows are about as large as its columns, its errors in them, and the units.
pub(crate) fn balanced(mut matrix: DMatrix<f64>, noise: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>, DVector<f64>) {
    let units = balance_parlett_reinsch(&mut matrix);
    let noise = in_units(noise, &units);
    (matrix, noise, units)
}

pub(crate) fn in_units(matrix: DMatrix<f64>, units: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.nrows(), |i, j| matrix[(i, j)] * units[j] / units[i])
}
