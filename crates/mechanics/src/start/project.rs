//! Projection of a velocity onto the constraint.

use nalgebra::{DMatrix, DVector};

use symbolic::{Evaluator, Symbol};

use super::error::{StartError, check_lengths};
use super::numeric::{AtState, Program, state_symbols};
use super::regularity::Regularity;
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
    Projection::new(system, &[]).project(&mut Regularity::new(system, &[]), state, &[])
}

/// [`project_velocity`] compiled for values of some parameters.
#[derive(Clone)]
pub(super) struct Projection {
    mass: AtState,
    /// `f`, `A` row-major, `∂f/∂q` row-major, then `∂A/∂v`, one n×n block a constraint.
    constraints: Program<f64>,
    /// h and n.
    shape: (usize, usize),
}

impl Projection {
    pub(super) fn new(system: &System, varied: &[Symbol]) -> Self {
        let g = &system.graph;
        let a = system.constraint_jacobian();
        let by_positions = g.jacobian(&system.constraints, &system.positions());
        let bent = g.jacobian(a.entries(), &system.velocities());
        let outputs = [&system.constraints[..], a.entries(), by_positions.entries(), bent.entries()];
        Projection {
            mass: AtState::new(system, varied, system.velocity_hessian().entries()),
            constraints: Program::new(system, &state_symbols(system, varied), &outputs.concat()),
            shape: (system.constraints.len(), system.dimension()),
        }
    }

    pub(super) fn project(
        &mut self,
        regularity: &mut Regularity,
        state: &State,
        varied: &[f64],
    ) -> Result<(State, f64), StartError> {
        regularity.check_constraints(state, varied)?;
        let (h, n) = self.shape;
        if h == 0 {
            return Ok((state.clone(), 0.0));
        }
        let mass = DMatrix::from_row_slice(n, n, self.mass.at(state, varied)?);
        let mut equations = Equations::new(state, &mass, self.constraints.evaluator()?, h, varied);
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
}

/// The stationarity conditions in `(δv, κ/σ)`; the factor `σ` makes `M` and `σ Aᵀ` of one size.
struct Equations<'a> {
    state: &'a State,
    mass: &'a DMatrix<f64>,
    constraints: usize,
    sigma: f64,
    numeric: &'a mut Evaluator<f64>,
    varied: &'a [f64],
}

impl<'a> Equations<'a> {
    fn new(
        state: &'a State,
        mass: &'a DMatrix<f64>,
        numeric: &'a mut Evaluator<f64>,
        constraints: usize,
        varied: &'a [f64],
    ) -> Self {
        let (n, h) = (mass.nrows(), constraints);
        let values = numeric.evaluate(&[&state.q[..], &state.v, &[state.t], varied].concat());
        let a = DMatrix::from_row_slice(h, n, &values[h..h + h * n]);
        let sigma = mass.amax() / a.amax();
        let sigma = if sigma > 0.0 && sigma.is_finite() { sigma } else { 1.0 };
        Equations { state, mass, constraints, sigma, numeric, varied }
    }

    fn evaluate(&mut self, x: &DVector<f64>) -> Evaluation {
        let (n, h) = (self.mass.nrows(), self.constraints);
        let v: Vec<f64> = self.state.v.iter().zip(x.iter()).map(|(v, dv)| v + dv).collect();
        let values = self.numeric.evaluate(&[&self.state.q[..], &v, &[self.state.t], self.varied].concat());
        let a = DMatrix::from_row_slice(h, n, &values[h..h + h * n]);
        let by_position = DMatrix::from_row_slice(h, n, &values[h + h * n..h + 2 * h * n]);
        let hessians = &values[h + 2 * h * n..];
        let (change, multiplier) = (x.rows(0, n), x.rows(n, h) * self.sigma);
        let mut residual = DVector::zeros(n + h);
        residual.rows_mut(0, n).copy_from(&(self.mass * change + a.tr_mul(&multiplier)));
        residual.rows_mut(n, h).copy_from_slice(&values[..h]);
        let mut magnitude = DVector::zeros(n + h);
        magnitude.rows_mut(0, n).copy_from(&(self.mass.abs() * change.abs() + a.abs().tr_mul(&multiplier.abs())));
        let speeds = DVector::from_column_slice(&v).abs();
        let places = DVector::from_column_slice(&self.state.q).abs();
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
