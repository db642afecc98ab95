//! Scales of states: how far they may be displaced before the Jacobian changes, in any units.

use nalgebra::{DMatrix, linalg::balancing::balance_parlett_reinsch};

use crate::LinearError;
use crate::matrix::{in_units, part};
use crate::point::Point;
use crate::spectrum::{components, coupled, reached};
use crate::weyl::Weyl;

/// Powers of ten by which states are moved: from minus this to this.
const MOST: i32 = 30;
/// A change of the Jacobian by this fraction of its length counts.
const ANOTHER: f64 = 0.1;

impl Point {
    /// A distance for each of the states `kept`, `matrix` the Jacobian of their rates: about as far as those
    /// coupled with it both ways can be moved together before their part of the Jacobian is another one;
    /// units are those in which its rows are as large as its columns. Where it never is another one, and
    /// where a state is coupled with none both ways, so that its unit cannot be known, the state as it is.
    pub(crate) fn scales(&mut self, kept: &[usize], matrix: &DMatrix<f64>) -> Result<Vec<f64>, LinearError> {
        let y = self.y.clone();
        let all = self.jacobian(&y)?;
        let noise = self.noise(&y, &all)?;
        let noise = part(&noise, kept);
        let mut scales: Vec<f64> = kept.iter().map(|&i| y[i].abs()).collect();
        for set in components(&reached(&coupled(matrix, &noise))).into_iter().filter(|set| set.len() > 1) {
            let places: Vec<usize> = set.iter().map(|&k| kept[k]).collect();
            if let Some(distances) = self.reach(&places, part(matrix, &set)) {
                set.iter().zip(distances).for_each(|(&k, distance)| scales[k] = distance);
            }
        }
        Ok(scales)
    }

    /// How far the states at `places` can be moved before `here`, their part of the Jacobian, is another one.
    fn reach(&mut self, places: &[usize], mut here: DMatrix<f64>) -> Option<Vec<f64>> {
        let units = balance_parlett_reinsch(&mut here);
        let (mut random, limit) = (Weyl::default(), ANOTHER * here.norm());
        let mut is_another = |reach: f64| -> Result<bool, LinearError> {
            let mut y = self.y.clone();
            for (&i, unit) in places.iter().zip(units.iter()) {
                y[i] += reach * unit * random.number();
            }
            let there = in_units(part(&self.jacobian(&y)?, places), &units);
            Ok((there - &here).norm() > limit)
        };
        // what cannot be evaluated is far enough, too
        let mut reaches = (-MOST..=MOST).map(|k| 10_f64.powi(k));
        let reach = reaches.find(|&reach| is_another(reach).unwrap_or(true))?;
        Some(units.iter().map(|unit| reach * unit).collect())
    }
}
