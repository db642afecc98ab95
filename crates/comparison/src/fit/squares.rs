//! The constants for which the sum of squares, or of higher powers, is least, with exact derivatives.

use integrate::{BoundaryError, Options, Residuals, ShootOptions, Shot, Status, fit};
use nalgebra::DVector;

use super::{CLOSE, COARSE, Differences};
use motion::band::NEARLY_ZERO;
use motion::{Settings, TIGHTER};
use motion::{VariationalRun, Which};

/// Which sum is minimized: `Σ |r_k|^p`, `r_k` at every `stride`-th instant, by the squares of `w_k r_k` with
/// `w_k = (|r_k|/s)^(p/2 − 1)`.
#[derive(Clone, Copy)]
pub struct Power {
    /// `p`
    pub power: f64,
    /// `s`
    pub scale: f64,
    /// Of so many instants one is taken.
    pub stride: usize,
    /// The part of the motion.
    pub part: f64,
}

impl Power {
    /// `w` of a gap.
    fn weight(&self, gap: f64) -> f64 {
        if self.power == 2.0 { 1.0 } else { (gap / self.scale).powf(0.5 * self.power - 1.0) }
    }
}

impl Differences {
    /// The constants of a minimum of the sum of squares over 40 instants near `guess`.
    pub(super) fn squares(&mut self, guess: &[f64], settings: &Settings) -> Option<Vec<f64>> {
        let coarse = self.coarse.clone();
        let squares = Power { power: 2.0, scale: 1.0, stride: COARSE, part: 1.0 };
        let found = self.least((self.tolerance, NEARLY_ZERO), &coarse, guess, &squares)?;
        let close = found.residual < CLOSE * self.way(1.0, squares.stride);
        let fine = (settings.tolerance * TIGHTER, 0.0);
        let refined = if close { self.least(fine, settings, &found.unknowns, &squares) } else { None };
        Some(refined.unwrap_or(found).unknowns)
    }

    /// The constants of a minimum of such a sum near `guess`; these where nothing is found.
    pub(super) fn minimum(&mut self, guess: &[f64], power: &Power) -> Vec<f64> {
        let coarse = self.coarse.clone();
        self.least((self.tolerance, NEARLY_ZERO), &coarse, guess, power).map_or(guess.to_vec(), |found| found.unknowns)
    }

    /// The minimum at this tolerance, as soon as an iteration brings less than this part.
    pub fn least(
        &mut self,
        (tolerance, least_gain): (f64, f64),
        limits: &Settings,
        guess: &[f64],
        power: &Power,
    ) -> Option<Shot> {
        let full = ShootOptions::with_tolerance(tolerance * self.way(power.part, power.stride));
        let least_gain = f64::max(least_gain, full.least_gain);
        let options = ShootOptions { least_gain, ..full };
        let count = self.instants(power.part, power.stride) * self.dimension();
        fit(&mut Weighted { differences: self, tolerance, limits, power }, count, guess, &options).ok()
    }
}

/// `w_k r_k`, as functions of the constants.
struct Weighted<'a> {
    differences: &'a mut Differences,
    tolerance: f64,
    limits: &'a Settings,
    power: &'a Power,
}

impl Residuals for Weighted<'_> {
    fn residual(&mut self, constants: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError> {
        let differences =
            self.differences.fill(constants, self.power.part, self.power.stride, self.tolerance, self.limits)?;
        residual.copy_from_slice(differences.as_slice());
        for apart in residual.chunks_exact_mut(self.differences.dimension()) {
            let weight = self.power.weight(norm(apart));
            apart.iter_mut().for_each(|x| *x *= weight);
        }
        Ok(())
    }

    /// Of the derivative of `w r`, the part along `r` is taken times `2(p−1)/p`, and that across it times
    /// `√(p−1)`: so the step is Newton's for the sum of powers, except second derivatives of `r`.
    fn jacobian(&mut self, constants: &[f64], jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        let Differences { prepared, goal, start, end, .. } = &mut *self.differences;
        let Power { power, stride, part, .. } = *self.power;
        let end = *start + (*end - *start) * part;
        let method = prepared.method.method;
        if !VariationalRun::is_by(method) {
            return Ok(false);
        }
        let broken = |error: motion::SolveError| BoundaryError::Residual { reason: error.to_string() };
        prepared.set_constants(constants);
        let options = Settings { method: Some(method), ..self.limits.clone() }.options(self.tolerance);
        let along: Vec<_> = (0..constants.len()).map(|i| prepared.along_constant(i, 1.0)).collect();
        let options = Options { wanted: None, ..options };
        let mut carried = VariationalRun::run(prepared, &along, end, &options, Which::Kept).map_err(broken)?;
        if *carried.status() != Status::Completed {
            return Ok(false);
        }
        let (k, n) = (constants.len(), goal[0].1.len());
        let instants = goal.iter().skip(stride - 1).step_by(stride);
        for (rows, (t, q, factor)) in jacobian.chunks_exact_mut(k * n).zip(instants) {
            let (now, derivatives) = carried.at(prepared, *t).map_err(broken)?;
            let apart = factor * (DVector::from_vec(now.coordinates) - q);
            let weight = self.power.weight(apart.norm());
            let direction = apart.try_normalize(0.0).unwrap_or_else(|| DVector::zeros(n));
            let across = (power - 1.0).sqrt();
            for (j, derivatives) in derivatives.into_iter().enumerate() {
                let column = factor * DVector::from_vec(derivatives.coordinates);
                let along = (power - 1.0 - across) * direction.dot(&column);
                let column = (column * across + &direction * along) * weight;
                column.iter().enumerate().for_each(|(i, x)| rows[i * k + j] = *x);
            }
        }
        Ok(true)
    }
}

/// The Euclidean length.
fn norm(apart: &[f64]) -> f64 {
    apart.iter().map(|x| x * x).sum::<f64>().sqrt()
}
