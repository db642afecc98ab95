//! Constraints that are nearly dependent, replaced by independent combinations of them.

use std::collections::HashMap;

use nalgebra::DMatrix;
use symbolic::{Expr, Graph};

use super::StartError;
use super::regularity::scaled_constraint_jacobian;
use crate::equations::{Equations, LeftOut, Named};
use crate::{State, System};

/// Ratios of singular values under which constraints are recombined: multipliers of the others lose less than four digits.
const NEARLY_DEPENDENT: f64 = 1e-2;

/// `f' = T f` with a constant, regular `T` such that the rows of `A' = T A` are orthonormal at the start, coordinates in the units of their masses.
///
/// `T f = 0` where `f = 0`, so that the motion is the same; only multipliers change, `λ = Tᵀ λ'`. But rows of `A` at an angle `δ` fix the accelerations
/// to `ε/δ²`, those of `A'` to `ε/δ`.
#[derive(Clone, Debug, PartialEq)]
pub struct Recombination {
    /// `T`, lower triangular.
    pub matrix: DMatrix<f64>,
    /// Smallest over largest singular value of `A` at the start: for two constraints half the angle between them, nearly.
    pub ratio: f64,
}

impl Recombination {
    /// The recombination for a start; `None` where the constraints are well apart as they are.
    ///
    /// # Errors
    /// [`StartError::DependentConstraints`] where they cannot be told apart; [`StartError::NotFinite`].
    pub fn at(system: &System, state: &State) -> Result<Option<Recombination>, StartError> {
        if system.constraints.len() < 2 {
            return Ok(None);
        }
        let (jacobian, row_scale, ratio) = scaled_constraint_jacobian(system, state)?;
        if ratio > NEARLY_DEPENDENT {
            return Ok(None);
        }
        // Aᵀ = Q R, so that R⁻ᵀ A = Qᵀ
        let inverse = jacobian.transpose().qr().r().try_inverse();
        let matrix = inverse.map(|r| r.transpose() * DMatrix::from_diagonal(&row_scale));
        Ok(matrix.filter(|t| t.iter().all(|x| x.is_finite())).map(|matrix| Recombination { matrix, ratio }))
    }

    /// The system with constraints `T f`.
    pub fn system(&self, system: &System) -> System {
        let mut other = system.clone();
        let g = &other.graph;
        other.constraints =
            (0..self.matrix.nrows()).map(|i| combination(g, &self.matrix, i, &system.constraints)).collect();
        other
    }

    /// Equations of [`Recombination::system`] whose multipliers, handed out and given at the start, are those of `f`.
    pub fn restore(&self, mut equations: Equations) -> Equations {
        let g = &equations.graph;
        let back = self.matrix.transpose();
        let own: Vec<Expr> = equations.multipliers.iter().map(|m| m.expression).collect();
        if own.len() == back.ncols() {
            let names = equations.multipliers.iter().map(|m| m.name.clone()).enumerate();
            let restored = names.map(|(i, name)| Named { name, expression: combination(g, &back, i, &own) }).collect();
            equations.multipliers = restored;
        }
        // μ = Tᵀ μ', so that μ'₀ = T⁻ᵀ μ₀
        let starts = equations.constant_symbols();
        if let Some(inverse) = back.try_inverse().filter(|m| m.ncols() == starts.len()) {
            let given = g.variables(&starts);
            let map: HashMap<_, _> =
                starts.iter().enumerate().map(|(i, &symbol)| (symbol, combination(g, &inverse, i, &given))).collect();
            for state in &mut equations.states {
                state.start = g.substitute(state.start, &map);
            }
            for guess in equations.blocks.iter_mut().flat_map(|block| &mut block.guess) {
                *guess = g.substitute(*guess, &map);
            }
        }
        let words = format!(
            "the constraints are nearly dependent at the start (ratio of singular values {:.1e}) and were replaced by orthonormal combinations of them, \
             which have the same motion; multipliers are handed out for the constraints as given",
            self.ratio
        );
        equations.left_out.push(LeftOut { variables: Vec::new(), words });
        equations.lost_digits = self.ratio.recip();
        equations
    }
}

/// `Σ_j M_ij e_j`.
fn combination(g: &Graph, matrix: &DMatrix<f64>, row: usize, expressions: &[Expr]) -> Expr {
    let terms = expressions.iter().enumerate().filter(|(j, _)| matrix[(row, *j)] != 0.0);
    g.sum(&terms.map(|(j, &e)| g.mul(g.number(matrix[(row, j)]), e)).collect::<Vec<_>>())
}
