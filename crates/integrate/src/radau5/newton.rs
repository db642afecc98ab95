//! The equations of the stages, and two iterations for them.
//!
//! ```text
//! h⁻¹ Σ_j (A⁻¹)_ij z_j = F(t + c_i h, y + z_i),   i = 1, 2, 3,     z_i = Y_i − y
//! ```
//!
//! The simplified Newton iteration takes one Jacobian `J` for all `J_i = ∂F/∂y(t + c_i h, y + z_i)`, so that
//! `T` takes the 3n equations apart (Hairer and Wanner, II, IV.8). It contracts by about
//! `(A⁻¹/h − J)⁻¹ (J_i − J)`: by `h N δ²` where a rate `N` acts in a direction that turns by `δ` in a step
//! (friction across a turning blade), so steps are about `(N ω²)^(-1/3)` however smooth the motion. There
//! Newton's iteration proper is taken, with a matrix of 3n rows,
//!
//! ```text
//! (h⁻¹ A⁻¹ ⊗ 1 − diag(J₁, J₂, J₃)) Δz = F − h⁻¹ A⁻¹ z
//! ```
//!
//! which is kept, too, from one iteration to the next while it contracts well.

use nalgebra::{Complex, DMatrix, DVector};

use super::{Factors, GOOD_CONTRACTION, ITERATIONS, Radau5};
use crate::radau5_tableau::{NODES, T, T_INVERSE, eigenvalues, inverse};
use crate::system::Failure;

/// Steps solved by Newton's iteration proper after one that needs it; then the simplified one is tried.
const PROPER_STEPS: usize = 20;

#[derive(Clone, Copy, PartialEq)]
enum Iteration {
    Simplified,
    Proper,
}

impl Radau5<'_, '_> {
    /// Jacobian and factors for steps of length `h`, as far as they are not there.
    pub(super) fn prepare(&mut self, h: f64) -> Result<(), Failure> {
        if !self.jacobian_is_new && (self.factors.is_none() || self.contraction > GOOD_CONTRACTION) {
            self.system.jacobian(self.t, &self.y, &mut self.jacobian)?;
            self.jacobian_is_new = true;
            self.factors = None;
        }
        if self.factors.as_ref().is_some_and(|factors| factors.step == h) {
            return Ok(());
        }
        let n = self.y.len();
        let [gamma, alpha, beta] = eigenvalues();
        let mut real = DMatrix::from_row_iterator(n, n, self.jacobian.iter().map(|j| -j));
        let mut complex = real.map(|x| Complex::new(x, 0.0));
        for i in 0..n {
            real[(i, i)] += gamma / h;
            complex[(i, i)] += Complex::new(alpha / h, beta / h);
        }
        let (real, complex) = (real.lu(), complex.lu());
        if !(real.is_invertible() && complex.is_invertible()) {
            return Err(Failure::Evaluation { reason: format!("γ/h − ∂F/∂y is singular at t = {}", self.t) });
        }
        self.factors = Some(Factors { step: h, real, complex });
        Ok(())
    }

    /// The last step's polynomial beyond its end, or zero.
    fn guess(&mut self, h: f64) {
        let n = self.y.len();
        for (stage, c) in NODES.into_iter().enumerate() {
            for i in 0..n {
                self.z[stage][i] = self.last.as_ref().map_or(0.0, |(before, [one, two, three])| {
                    let s = c * h / before;
                    let inner = two[i] + (s - (NODES[0] - 1.0)) * three[i];
                    s * (one[i] + (s - (NODES[1] - 1.0)) * inner)
                });
            }
        }
        self.guessed_end.copy_from_slice(&self.z[2]);
        for i in 0..n {
            for (row, w) in T_INVERSE.iter().zip(&mut self.w) {
                w[i] = row[0] * self.z[0][i] + row[1] * self.z[1][i] + row[2] * self.z[2][i];
            }
        }
    }

    /// Solves the stages; the number of iterations, or by what the step is to be shortened.
    pub(super) fn stages(&mut self, h: f64) -> Result<Result<usize, f64>, Failure> {
        if self.proper_steps == 0 {
            self.guess(h);
            let solved = self.iterate(h, Iteration::Simplified)?;
            if solved.is_ok() || !self.jacobian_is_new {
                return Ok(solved);
            }
            self.proper_steps = PROPER_STEPS;
        }
        self.guess(h);
        let solved = self.iterate(h, Iteration::Proper)?;
        // the estimate needs the Jacobian of the next step's start; the other iteration contracts otherwise
        (self.contraction, self.margin) = (1.0, 1.0);
        self.proper_steps -= 1;
        Ok(solved)
    }

    fn iterate(&mut self, h: f64, how: Iteration) -> Result<Result<usize, f64>, Failure> {
        (self.margin, self.contraction) = match how {
            Iteration::Simplified => (self.margin.max(f64::EPSILON).powf(0.8), GOOD_CONTRACTION),
            // the matrix is another one in every step, so that how the last one contracted says nothing
            Iteration::Proper => (1.0, 1.0),
        };
        let (mut before, mut ratio_before) = (0.0, 0.0);
        for iteration in 1..=ITERATIONS {
            for (stage, c) in NODES.into_iter().enumerate() {
                for i in 0..self.y.len() {
                    self.argument[i] = self.y[i] + self.z[stage][i];
                }
                self.system.rates(self.t + c * h, &self.argument, &mut self.stages[stage])?;
            }
            let size = match how {
                Iteration::Simplified => self.correct(h),
                Iteration::Proper => self.correct_properly(h)?,
            };
            let Some(size) = size else { return Ok(Err(0.5)) };
            if iteration > 1 && iteration < ITERATIONS {
                let ratio = size / before;
                self.contraction = if iteration == 2 { ratio } else { (ratio * ratio_before).sqrt() };
                ratio_before = ratio;
                if self.contraction >= 0.99 {
                    return Ok(Err(0.5));
                }
                self.margin = self.contraction / (1.0 - self.contraction);
                let left = (ITERATIONS - 1 - iteration) as i32;
                let at_last = self.margin * size * self.contraction.powi(left) / self.newton_tolerance;
                if at_last >= 1.0 {
                    return Ok(Err(0.8 * at_last.clamp(1e-4, 20.0).powf(-1.0 / (4.0 + f64::from(left)))));
                }
            }
            before = size.max(f64::EPSILON);
            if self.margin * size <= self.newton_tolerance {
                return Ok(Ok(iteration));
            }
        }
        Ok(Err(0.5))
    }

    /// One simplified iteration; the size of the correction in units of the tolerance.
    fn correct(&mut self, h: f64) -> Option<f64> {
        let n = self.y.len();
        let [gamma, alpha, beta] = eigenvalues().map(|x| x / h);
        let factors = self.factors.as_ref()?;
        let transformed =
            |row: usize, i: usize| -> f64 { (0..3).map(|stage| T_INVERSE[row][stage] * self.stages[stage][i]).sum() };
        let mut real = DVector::from_fn(n, |i, _| transformed(0, i) - gamma * self.w[0][i]);
        let mut complex = DVector::from_fn(n, |i, _| {
            let (u, v) = (self.w[1][i], self.w[2][i]);
            Complex::new(transformed(1, i) - alpha * u + beta * v, transformed(2, i) - alpha * v - beta * u)
        });
        if !(factors.real.solve_mut(&mut real) && factors.complex.solve_mut(&mut complex)) {
            return None;
        }
        let mut sum = 0.0;
        for i in 0..n {
            let changes = [real[i], complex[i].re, complex[i].im];
            for (w, change) in self.w.iter_mut().zip(changes) {
                w[i] += change;
            }
            let scale = self.scale(i);
            sum += changes.iter().map(|x| (x / scale).powi(2)).sum::<f64>();
            for (row, z) in T.iter().zip(&mut self.z) {
                z[i] = row[0] * self.w[0][i] + row[1] * self.w[1][i] + row[2] * self.w[2][i];
            }
        }
        Some((sum / (3 * n) as f64).sqrt()).filter(|size| size.is_finite())
    }

    /// One iteration with the Jacobians of the stages; the size of the correction in units of the tolerance.
    fn correct_properly(&mut self, h: f64) -> Result<Option<f64>, Failure> {
        let n = self.y.len();
        let inverse = inverse().map(|row| row.map(|x| x / h));
        if self.contraction > GOOD_CONTRACTION || self.all_stages.is_none() {
            let mut block = vec![0.0; n * n];
            let mut matrix = DMatrix::zeros(3 * n, 3 * n);
            for (stage, c) in NODES.into_iter().enumerate() {
                for i in 0..n {
                    self.argument[i] = self.y[i] + self.z[stage][i];
                    for other in 0..3 {
                        matrix[(stage * n + i, other * n + i)] = inverse[stage][other];
                    }
                }
                self.system.jacobian(self.t + c * h, &self.argument, &mut block)?;
                for (at, x) in block.iter().enumerate() {
                    matrix[(stage * n + at / n, stage * n + at % n)] -= x;
                }
            }
            self.all_stages = Some(matrix.lu());
        }
        let mut change = DVector::from_fn(3 * n, |at, _| {
            let (stage, i) = (at / n, at % n);
            self.stages[stage][i] - (0..3).map(|other| inverse[stage][other] * self.z[other][i]).sum::<f64>()
        });
        if !self.all_stages.as_ref().is_some_and(|factors| factors.solve_mut(&mut change)) {
            return Ok(None);
        }
        let mut sum = 0.0;
        for (at, x) in change.iter().enumerate() {
            self.z[at / n][at % n] += x;
            sum += (x / self.scale(at % n)).powi(2);
        }
        Ok(Some((sum / (3 * n) as f64).sqrt()).filter(|size| size.is_finite()))
    }
}
