//! Sets of constants.

use nalgebra::DVector;

/// Constants `point + span(directions)`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AffineSet {
    /// The element of least norm, each constant in its scale; an element far along a direction if only that
    /// has no mismatch.
    pub point: Vec<f64>,
    /// Orthonormal directions; none for a single point, all for every choice.
    pub directions: Vec<Vec<f64>>,
}

impl AffineSet {
    /// Its dimension.
    pub fn dimension(&self) -> usize {
        self.directions.len()
    }

    /// The distance of `constants` from it.
    pub fn distance(&self, constants: &[f64]) -> f64 {
        let mut rest = DVector::from_column_slice(constants) - DVector::from_column_slice(&self.point);
        for direction in &self.directions {
            let direction = DVector::from_column_slice(direction);
            rest -= &direction * direction.dot(&rest);
        }
        rest.norm()
    }
}
