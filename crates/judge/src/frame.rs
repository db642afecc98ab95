//! What mechanics says of one instant of a film.

use first_order::curvature;
use mechanics::System;
use nalgebra::{DMatrix, DVector};
use symbolic::{Evaluator, Expr};

use crate::JudgeError;
use crate::film::Instant;

/// The program that computes [`Frame`].
pub(crate) struct Frames {
    program: Evaluator<f64>,
    parameters: Vec<f64>,
    n: usize,
    h: usize,
}

/// Quantities of an instant. Those with a tilde of `M = G Gᵀ` (Cholesky): lengths are those by `M⁻¹`.
#[derive(Clone)]
pub(crate) struct Frame {
    /// `ρ̃ = G⁻¹ (d/dt ∂L/∂v − ∂L/∂q − Q)`, the reaction.
    pub(crate) reaction: DVector<f64>,
    /// The same without `G⁻¹`.
    pub(crate) balance: DVector<f64>,
    /// `Ã = A G⁻ᵀ` and `A`.
    pub(crate) tilde_rows: DMatrix<f64>,
    pub(crate) rows: DMatrix<f64>,
    /// `C̃ = G⁻¹ C`.
    pub(crate) curvature: DMatrix<f64>,
    /// `∂f/∂q`.
    pub(crate) slopes: DMatrix<f64>,
    /// `Gᵀ v` and `Gᵀ a`.
    pub(crate) velocity: DVector<f64>,
    pub(crate) acceleration: DVector<f64>,
    /// `∂L/∂v`, and the diagonal of `M`.
    pub(crate) momenta: DVector<f64>,
    pub(crate) masses: DVector<f64>,
    /// `f`, and `df/dt` without `A a`.
    pub(crate) constraint: DVector<f64>,
    pub(crate) drift: DVector<f64>,
    /// `Σ (A_ij v_j)²`.
    pub(crate) terms: f64,
    /// `(Ã Ãᵀ)⁻¹`.
    inverse: DMatrix<f64>,
}

impl Frames {
    pub(crate) fn new(system: &System) -> Result<Frames, JudgeError> {
        let g = &system.graph;
        let (n, h) = (system.dimension(), system.constraints.len());
        if h == 0 {
            return Err(JudgeError::Unconstrained);
        }
        let (q, v, flow) = (system.positions(), system.velocities(), system.flow());
        let momenta = g.gradient(system.lagrangian, &v);
        let gradient = g.gradient(system.lagrangian, &q);
        let mut outputs: Vec<Expr> = (0..n)
            .map(|i| g.sub(g.total_derivative(momenta[i], &flow), g.add(gradient[i], system.forces[i])))
            .collect();
        outputs.extend(system.velocity_hessian().entries());
        outputs.extend(system.constraint_jacobian().entries());
        outputs.extend(g.jacobian(&system.constraints, &q).entries());
        for k in 0..h {
            let unit: Vec<Expr> = (0..h).map(|i| if i == k { g.one() } else { g.zero() }).collect();
            outputs.extend(curvature(system, &unit));
        }
        outputs.extend(&momenta);
        outputs.extend(&system.constraints);
        outputs.extend(system.constraints.iter().map(|&f| g.total_derivative(f, &flow)));
        let parameters: Vec<_> = system.parameters.iter().map(|p| p.symbol).collect();
        let inputs = [&[system.time], &q[..], &v, &system.accelerations(), &parameters].concat();
        let tape = g.compile(&inputs, &outputs, &Default::default());
        let tape = tape.map_err(|error| JudgeError::Compile(error.to_string()))?;
        let parameters = system.parameters.iter().map(|p| p.value).collect();
        Ok(Frames { program: Evaluator::new(tape), parameters, n, h })
    }

    pub(crate) fn at(&mut self, instant: &Instant) -> Result<Frame, JudgeError> {
        let (n, h, t) = (self.n, self.h, instant.t);
        let inputs = [&[t], &instant.q[..], &instant.v, &instant.a, &self.parameters].concat();
        let mut values = self.program.evaluate(&inputs).iter().copied();
        let mut take = |count: usize| -> Vec<f64> { values.by_ref().take(count).collect() };
        let balance = DVector::from_vec(take(n));
        let mass = DMatrix::from_row_slice(n, n, &take(n * n));
        let rows = DMatrix::from_row_slice(h, n, &take(h * n));
        let slopes = DMatrix::from_row_slice(h, n, &take(h * n));
        let curvature = DMatrix::from_column_slice(n, h, &take(n * h));
        let momenta = DVector::from_vec(take(n));
        let (constraint, rate) = (DVector::from_vec(take(h)), DVector::from_vec(take(h)));
        let masses = mass.diagonal();
        let root = mass.cholesky().ok_or(JudgeError::Indefinite { t })?.l();
        let solve = |right: &DMatrix<f64>| root.solve_lower_triangular(right).expect("a root has a diagonal");
        let tilde_rows = solve(&rows.transpose()).transpose();
        let (v, a) = (DVector::from_column_slice(&instant.v), DVector::from_column_slice(&instant.a));
        let inverse = (&tilde_rows * tilde_rows.transpose()).try_inverse().ok_or(JudgeError::Dependent { t })?;
        let reaction = root.solve_lower_triangular(&balance).expect("a root has a diagonal");
        let all = reaction.iter().chain(&inverse).chain(&constraint).chain(&rate).all(|x| x.is_finite());
        if !all {
            return Err(JudgeError::NotFinite { t });
        }
        Ok(Frame {
            reaction,
            balance,
            drift: &rate - &rows * &a,
            terms: rows
                .row_iter()
                .flat_map(|row| row.iter().zip(&v).map(|(a, v)| (a * v).powi(2)).collect::<Vec<_>>())
                .sum(),
            curvature: solve(&curvature),
            velocity: root.transpose() * v,
            acceleration: root.transpose() * a,
            tilde_rows,
            rows,
            slopes,
            momenta,
            masses,
            constraint,
            inverse,
        })
    }
}

impl Frame {
    /// `(Ã Ãᵀ)⁻¹ Ã x`: the multipliers of `x`.
    pub(crate) fn multipliers(&self, x: &DVector<f64>) -> DVector<f64> {
        &self.inverse * (&self.tilde_rows * x)
    }

    /// What of `x` no reaction `Aᵀ λ` gives.
    pub(crate) fn tangential(&self, x: &DVector<f64>) -> DVector<f64> {
        x - self.tilde_rows.transpose() * self.multipliers(x)
    }
}
