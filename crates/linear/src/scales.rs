//! How far states may be moved before their rates are others to first order, in whatever units they come.

use nalgebra::{DMatrix, linalg::balancing::balance_parlett_reinsch};

use crate::LinearError;
use crate::point::{COORDINATES, Point};
use crate::weyl::Weyl;

/// Powers of ten, of the unit of a coordinate, by which states are moved: from one up to the other.
const LEAST: i32 = -30;
const MOST: i32 = 30;
/// The Jacobian is another one where it changes by this part of its length.
const ANOTHER: f64 = 0.1;

impl Point {
    /// A distance for each of the states `kept`: about as far as they can be moved together before the
    /// Jacobian `matrix` of their rates is another one; units are those in which rows of the matrix are as
    /// large as its columns. Where it never is another one, the states as they are.
    pub(crate) fn scales(&mut self, kept: &[usize], matrix: &DMatrix<f64>) -> Vec<f64> {
        let mut here = matrix.clone();
        let mut units = balance_parlett_reinsch(&mut here);
        let coordinates = self.places(&COORDINATES);
        let of_coordinates = (0..kept.len()).filter(|&k| coordinates.contains(&kept[k])).map(|k| units[k]);
        let Some(largest) = of_coordinates.reduce(f64::max) else { return units.as_slice().to_vec() };
        units /= largest;
        let (mut random, limit) = (Weyl::default(), ANOTHER * here.norm());
        let mut is_another = |reach: f64| -> Result<bool, LinearError> {
            let mut y = self.y.clone();
            for (&i, unit) in kept.iter().zip(units.iter()) {
                y[i] += reach * unit * random.number();
            }
            let there = self.jacobian(&y)?;
            let entry = |i: usize, j: usize| there[(kept[i], kept[j])] * units[j] / units[i];
            Ok((DMatrix::from_fn(kept.len(), kept.len(), entry) - &here).norm() > limit)
        };
        // what cannot be evaluated is far enough, too
        let mut reaches = (LEAST..=MOST).map(|k| 10_f64.powi(k));
        let reach = reaches.find(|&reach| is_another(reach).unwrap_or(true));
        match reach {
            Some(reach) => units.iter().map(|unit| reach * unit).collect(),
            None => kept.iter().map(|&i| self.y[i].abs()).collect(),
        }
    }
}
