//! Projection of a velocity onto the constraint.

use nalgebra::{DMatrix, DVector};

use super::error::{StartError, check_lengths};
use super::numeric::AtState;
use super::regularity::check_constraints;
use crate::newton::{Evaluation, NewtonError, NewtonOptions, solve};
use crate::{State, System};

/// The smallest `δv`, in the metric `M = ∂²L/∂v²` at `state`, to `f(q, v, t) = 0`; its length `√(δvᵀ M δv)`.
///
/// Solves `M δv + Aᵀ κ = 0`, `f(q, v + δv, t) = 0` for `(δv, κ)`. `M` regular on the kernel of `A` is enough;
/// where `M` is indefinite the change is stationary, not smallest, and the length that of `|δvᵀ M δv|`.
///
/// # Errors
/// [`StartError::Projection`] where Newton's method does not reach the constraint;
/// [`StartError::WrongLength`]; those of [`check_regularity`](super::check_regularity).
pub fn project_velocity(system: &System, state: &State) -> Result<(State, f64), StartError> {
    check_lengths(system, state)?;
    check_constraints(system, state)?;
    let (n, h) = (system.dimension(), system.constraints.len());
    if h == 0 {
        return Ok((state.clone(), 0.0));
    }
    let mass = mass_matrix(system, state)?;
    let mut equations = Equations::new(system, state, &mass)?;
    let root = solve(|x| equations.evaluate(x), DVector::zeros(n + h), &NewtonOptions::default())
        .map_err(StartError::Projection)?;
    let change = root.x.rows(0, n).into_owned();
    if !change.iter().all(|x| x.is_finite()) {
        return Err(StartError::Projection(NewtonError::NotFinite { iteration: root.iterations }));
    }
    let length = change.dot(&(&mass * &change)).abs().sqrt();
    let v = state.v.iter().zip(change.iter()).map(|(v, dv)| v + dv).collect();
    Ok((State { t: state.t, q: state.q.clone(), v }, length))
}

fn mass_matrix(system: &System, state: &State) -> Result<DMatrix<f64>, StartError> {
    let n = system.dimension();
    let mut numeric = AtState::new(system, system.velocity_hessian().entries())?;
    Ok(DMatrix::from_row_slice(n, n, numeric.at(state)))
}

/// The stationarity conditions in `(δv, κ/σ)`; the factor `σ` makes `M` and `σ Aᵀ` of one size.
struct Equations<'a> {
    state: &'a State,
    mass: &'a DMatrix<f64>,
    constraints: usize,
    sigma: f64,
    /// Outputs: `f`, `A` row-major, `∂f/∂q` row-major, then `∂A/∂v`, one n×n block a constraint.
    numeric: AtState,
}

impl<'a> Equations<'a> {
    fn new(system: &System, state: &'a State, mass: &'a DMatrix<f64>) -> Result<Self, StartError> {
        let g = &system.graph;
        let (n, h) = (system.dimension(), system.constraints.len());
        let a = system.constraint_jacobian();
        let mut outputs = system.constraints.clone();
        outputs.extend(a.entries());
        outputs.extend(g.jacobian(&system.constraints, &system.positions()).entries());
        outputs.extend(g.jacobian(a.entries(), &system.velocities()).entries());
        let mut numeric = AtState::new(system, &outputs)?;
        let a = DMatrix::from_row_slice(h, n, &numeric.at(state)[h..h + h * n]);
        let sigma = mass.amax() / a.amax();
        let sigma = if sigma > 0.0 && sigma.is_finite() { sigma } else { 1.0 };
        Ok(Equations { state, mass, constraints: h, sigma, numeric })
    }

    fn evaluate(&mut self, x: &DVector<f64>) -> Evaluation {
        let (n, h) = (self.mass.nrows(), self.constraints);
        let v: Vec<f64> = self.state.v.iter().zip(x.iter()).map(|(v, dv)| v + dv).collect();
        let state = State { t: self.state.t, q: self.state.q.clone(), v };
        let values = self.numeric.at(&state);
        let a = DMatrix::from_row_slice(h, n, &values[h..h + h * n]);
        let by_position = DMatrix::from_row_slice(h, n, &values[h + h * n..h + 2 * h * n]);
        let hessians = &values[h + 2 * h * n..];
        let (change, multiplier) = (x.rows(0, n), x.rows(n, h) * self.sigma);
        let mut residual = DVector::zeros(n + h);
        residual.rows_mut(0, n).copy_from(&(self.mass * change + a.tr_mul(&multiplier)));
        residual.rows_mut(n, h).copy_from_slice(&values[..h]);
        let mut magnitude = DVector::zeros(n + h);
        magnitude.rows_mut(0, n).copy_from(&(self.mass.abs() * change.abs() + a.abs().tr_mul(&multiplier.abs())));
        let speeds = DVector::from_column_slice(&state.v).abs();
        let places = DVector::from_column_slice(&state.q).abs();
        magnitude.rows_mut(n, h).copy_from(&(a.abs() * speeds + by_position.abs() * places));
        let mut jacobian = DMatrix::zeros(n + h, n + h);
        for i in 0..n {
            for j in 0..n {
                let bent: f64 = (0..h).map(|k| multiplier[k] * hessians[(k * n + i) * n + j]).sum();
                jacobian[(i, j)] = self.mass[(i, j)] + bent;
            }
        }
        jacobian.view_mut((n, 0), (h, n)).copy_from(&a);
        jacobian.view_mut((0, n), (n, h)).copy_from(&(a.transpose() * self.sigma));
        Evaluation { residual, jacobian, magnitude }
    }
}
