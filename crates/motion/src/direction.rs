//! Derivatives of starts and constants with respect to numbers of a scene, as prepared equations store them.

use nalgebra::DMatrix;

/// Derivatives of a motion's start and constants with respect to a number, times `scale`.
#[derive(Clone)]
pub struct Direction {
    /// Of the start, `dy(t₀)`.
    pub start: Vec<f64>,
    /// Of the free constants, parameters that vary included.
    pub constants: Vec<f64>,
    /// The size of the number: derivatives by it are those along the direction over this.
    pub scale: f64,
}

/// Natural constants of a motion, and the inverse of the Jacobian there: those of motions with other numbers
/// are found by few runs from it, whatever was found before.
#[derive(Clone)]
pub(crate) struct Chord {
    pub(crate) constants: Vec<f64>,
    pub(crate) inverse: DMatrix<f64>,
}
