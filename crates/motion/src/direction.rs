//! Derivatives of starts and constants with respect to numbers of a scene, as prepared equations store them.

use nalgebra::DMatrix;

use crate::SolveError;
use crate::differences::derivative;

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

impl Direction {
    /// That of the number of this name at `x`, times `scale`; `at` says what the start and the constants are
    /// with other values of it. This goes by way of formulas, velocities that constraints supply, a
    /// projection and momenta: a map that costs microseconds and is right to the last digits. Its derivative
    /// is a difference ([`crate::differences`]).
    pub(crate) fn by(
        name: &str,
        x: f64,
        scale: f64,
        at: &mut dyn FnMut(f64) -> Result<[Vec<f64>; 2], SolveError>,
    ) -> Result<Direction, SolveError> {
        let mut states = 0;
        let both = derivative(name, x, &mut |x| {
            let both = at(x)?;
            states = both[0].len();
            Ok(both.concat())
        })?;
        let mut start: Vec<f64> = both.into_iter().map(|x| x * scale).collect();
        let constants = start.split_off(states);
        Ok(Direction { start, constants, scale })
    }
}

/// Natural constants of a motion, and the inverse of the Jacobian there: those of motions with other numbers
/// are found by few runs from it, whatever was found before.
#[derive(Clone)]
pub(crate) struct Chord {
    pub(crate) constants: Vec<f64>,
    pub(crate) inverse: DMatrix<f64>,
}
