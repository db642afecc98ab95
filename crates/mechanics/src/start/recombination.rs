//! Constraints that are nearly dependent, replaced by independent combinations of them.

use nalgebra::DMatrix;
use symbolic::Matrix;

use super::error::StartError;
use super::regularity::nearly_dependent;
use crate::{State, System};

/// Ratio of singular values under which constraints are recombined; over it multipliers lose < 4 digits.
const NEARLY_DEPENDENT: f64 = 1e-2;

/// `f' = T f`, `T` constant and regular: at the start `A' = T A` has orthonormal rows in units of the masses.
///
/// `T f = 0` where `f = 0`, so that the motion is the same; only multipliers change, `λ = Tᵀ λ'`. But rows of
/// `A` at an angle `δ` fix the accelerations to `ε/δ²`, those of `A'` to `ε/δ`.
#[derive(Clone, Debug, PartialEq)]
pub struct Recombination {
    /// `T`, lower triangular.
    pub matrix: DMatrix<f64>,
    /// Smallest over largest singular value of `A` at the start: for two constraints about half their angle.
    pub ratio: f64,
}

impl Recombination {
    /// The recombination for a start; `None` where the constraints are well apart as they are.
    ///
    /// # Errors
    /// [`StartError::DependentConstraints`] where they are dependent up to round-off;
    /// [`StartError::NotFinite`].
    pub fn at(system: &System, state: &State) -> Result<Option<Recombination>, StartError> {
        if system.constraints.len() < 2 {
            return Ok(None);
        }
        let Some((scaled, ratio)) = nearly_dependent(system, state, NEARLY_DEPENDENT)? else {
            return Ok(None);
        };
        // Aᵀ = Q R, so that R⁻ᵀ A = Qᵀ
        let inverse = scaled.constraint_jacobian.transpose().qr().r().try_inverse();
        let matrix = inverse.map(|r| r.transpose() * DMatrix::from_diagonal(&scaled.rows));
        Ok(matrix.filter(|t| t.iter().all(|x| x.is_finite())).map(|matrix| Recombination { matrix, ratio }))
    }

    /// The system with constraints `T f`.
    pub fn system(&self, system: &System) -> System {
        let mut other = system.clone();
        let g = &other.graph;
        let (rows, columns) = self.matrix.shape();
        let matrix = Matrix::from_fn(rows, columns, |i, j| g.number(self.matrix[(i, j)]));
        other.constraints = g.mat_vec(&matrix, &system.constraints);
        other
    }
}
