//! The balance of forces along samples, as numbers in the kinetic metric.

use mechanics::System;
use nalgebra::{DMatrix, DVector};
use symbolic::{Evaluator, Expr, Symbol};

use crate::differences::derivative;
use crate::{JudgeError, Samples};

/// What the scene says of one sample. With `M = S Sᵀ` forces are multiplied by `S⁻¹`, so that their lengths
/// are `√E/T` whatever the units of the coordinates.
#[derive(Clone, Debug)]
pub struct Instant {
    /// The time.
    pub t: f64,
    /// `q`, `v`, `a`.
    pub state: [Vec<f64>; 3],
    /// `S⁻¹ (E − Q)`, `E = d/dt ∂L/∂v − ∂L/∂q`, n.
    pub balance: DVector<f64>,
    /// `S⁻¹ Aᵀ`, n×h.
    pub along: DMatrix<f64>,
    /// `S⁻¹ C`, n×h.
    pub curvature: DMatrix<f64>,
    /// `Sᵀ v`, n: what a drag `−γ M v` is multiplied with.
    pub momentum: DVector<f64>,
    /// `S⁻¹ M a`, n.
    pub inertia: DVector<f64>,
    /// `f`, h.
    pub constraint: DVector<f64>,
    /// `ḟ − A a`, h: the rate of the constraint that has no acceleration in it.
    pub rest: DVector<f64>,
    /// `A a`, h.
    pub driven: DVector<f64>,
    /// `√(Σⱼ (Aᵢⱼ vⱼ)²)`, h: how large the parts of each constraint are.
    pub parts: Vec<f64>,
    /// `S⁻¹ p ∂(E − Q)/∂p`, n, for each parameter p that is not zero.
    pub by_parameter: Vec<DVector<f64>>,
    /// `S⁻¹`, n×n.
    pub unit_forces: DMatrix<f64>,
}

/// The expressions of a scene, compiled.
pub struct Balance {
    program: Evaluator<f64>,
    n: usize,
    h: usize,
    /// Parameters that are not zero.
    pub parameters: Vec<(String, f64)>,
}

impl Balance {
    /// Those of `system`.
    ///
    /// # Errors
    /// [`JudgeError::Unconstrained`], and where the scene cannot be evaluated.
    pub fn new(system: &System) -> Result<Balance, JudgeError> {
        let g = &system.graph;
        let (n, h) = (system.dimension(), system.constraints.len());
        if h == 0 {
            return Err(JudgeError::Unconstrained);
        }
        let flow = system.flow();
        let momenta = g.gradient(system.lagrangian, &system.velocities());
        let gradient = g.gradient(system.lagrangian, &system.positions());
        let still: Vec<(Symbol, Expr)> = {
            let v = system.velocities();
            flow.iter().copied().filter(|(s, _)| !v.contains(s)).collect()
        };
        let mut outputs: Vec<Expr> = (0..n)
            .map(|i| g.sub(g.total_derivative(momenta[i], &flow), g.add(gradient[i], system.forces[i])))
            .collect();
        outputs.extend(system.velocity_hessian().entries());
        outputs.extend(system.constraint_jacobian().entries());
        for i in 0..h {
            let unit: Vec<Expr> = (0..h).map(|j| if i == j { g.one() } else { g.zero() }).collect();
            outputs.extend(first_order::euler_lagrange(system, &unit));
        }
        outputs.extend(&system.constraints);
        outputs.extend(g.total_derivatives(&system.constraints, &still));
        let own: Vec<_> = system.parameters.iter().filter(|p| p.value != 0.0).collect();
        let forces: Vec<Expr> = outputs[..n].to_vec();
        outputs.extend(own.iter().flat_map(|p| forces.iter().map(|&e| g.derivative(e, p.symbol)).collect::<Vec<_>>()));
        let parameters = own.iter().map(|p| (g.name(p.symbol), p.value)).collect();
        Ok(Balance { program: system.evaluator(&inputs(system), &outputs)?, n, h, parameters })
    }

    /// The numbers at one sample.
    ///
    /// # Errors
    /// [`JudgeError::MassMatrix`], [`JudgeError::NotFinite`] and [`JudgeError::Dependent`].
    pub fn at(&mut self, t: f64, state: [Vec<f64>; 3]) -> Result<Instant, JudgeError> {
        let (n, h) = (self.n, self.h);
        let mut rest = self.program.evaluate(&[&[t], &state[0][..], &state[1], &state[2]].concat());
        let mut take = |count: usize| {
            let (first, others) = rest.split_at(count);
            rest = others;
            first
        };
        let balance = DVector::from_column_slice(take(n));
        let mass = DMatrix::from_row_slice(n, n, take(n * n));
        let jacobian = DMatrix::from_row_slice(h, n, take(h * n));
        let curvature = DMatrix::from_column_slice(n, h, take(n * h));
        let [constraint, rest] = [0, 1].map(|_| DVector::from_column_slice(take(h)));
        let by_parameter: Vec<DVector<f64>> =
            self.parameters.iter().map(|(_, value)| DVector::from_column_slice(take(n)) * *value).collect();
        let [v, a] = [1, 2].map(|i| DVector::from_column_slice(&state[i]));
        let factor = mass.clone().cholesky().ok_or(JudgeError::MassMatrix { t })?.l();
        let divided = |m: DMatrix<f64>| factor.solve_lower_triangular(&m).ok_or(JudgeError::MassMatrix { t });
        let column = |v: DVector<f64>| factor.solve_lower_triangular(&v).ok_or(JudgeError::MassMatrix { t });
        let instant = Instant {
            t,
            balance: column(balance)?,
            along: divided(jacobian.transpose())?,
            curvature: divided(curvature)?,
            momentum: factor.transpose() * &v,
            inertia: column(mass * &a)?,
            constraint,
            rest,
            driven: &jacobian * &a,
            by_parameter: by_parameter.into_iter().map(column).collect::<Result<_, _>>()?,
            unit_forces: divided(DMatrix::identity(n, n))?,
            parts: jacobian.row_iter().map(|row| row.transpose().component_mul(&v).norm()).collect(),
            state,
        };
        let Instant { balance, momentum, inertia, constraint, rest, driven, along, curvature, .. } = &instant;
        // what is squared has to stay finite
        let lengths = [balance, momentum, inertia, constraint, rest, driven].map(|v| v.norm_squared());
        let sizes = [along, curvature].map(|m| m.norm_squared());
        let parts = instant.parts.iter().map(|x| x * x);
        if lengths.into_iter().chain(sizes).chain(parts).any(|x| !x.is_finite()) {
            return Err(JudgeError::NotFinite { t });
        }
        let regular = along.clone().svd(false, false).singular_values;
        if regular.min() <= 1e-12 * regular.max() {
            return Err(JudgeError::Dependent { t });
        }
        Ok(instant)
    }

    /// The numbers at all samples that have `margin ≥ reach` others on both sides. Rates that the table
    /// lacks, and accelerations, are derivatives of the polynomial through `2 reach + 1` samples.
    ///
    /// # Errors
    /// [`JudgeError::TooFew`], and those of [`Balance::at`].
    pub fn along(&mut self, samples: &Samples, reach: usize, margin: usize) -> Result<Vec<Instant>, JudgeError> {
        let (found, needed) = (samples.t.len(), 2 * margin + 12);
        if found < needed {
            return Err(JudgeError::TooFew { found, needed });
        }
        (margin..found - margin).map(|i| self.instant(samples, i, reach)).collect()
    }

    /// The numbers at the first samples, before those that [`Balance::along`] has with this margin.
    ///
    /// # Errors
    /// Those of [`Balance::at`].
    pub fn before(&mut self, samples: &Samples, reach: usize, margin: usize) -> Result<Vec<Instant>, JudgeError> {
        (0..margin).map(|i| self.instant(samples, i, reach)).collect()
    }

    fn instant(&mut self, samples: &Samples, i: usize, reach: usize) -> Result<Instant, JudgeError> {
        let [v, a] = match &samples.v {
            Some(v) => [v[i].clone(), derivative(&samples.t, v, i, reach, 1)],
            None => [1, 2].map(|d| derivative(&samples.t, &samples.q, i, reach, d)),
        };
        self.at(samples.t[i], [samples.q[i].clone(), v, a])
    }
}

/// `(t, q, v, a)`.
pub fn inputs(system: &System) -> Vec<Symbol> {
    [&[system.time], &system.positions()[..], &system.velocities(), &system.accelerations()].concat()
}
