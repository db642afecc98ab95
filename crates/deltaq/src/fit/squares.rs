//! The constants for which the sum of squares is least, with exact derivatives where these cost less.

use integrate::{BoundaryError, Options, Residuals, ShootOptions, Shot, Status, fit};
use nalgebra::DVector;

use super::{CLOSE, Differences, INSTANTS, SEARCH_TOLERANCE};
use crate::carried::{Carried, PLAIN_RUNS, Which};
use crate::{Settings, TIGHTER};

/// Limit on the search.
const ITERATIONS: usize = 30;
/// The coarse search is done where an iteration brings less than this part.
const GAIN: f64 = 1e-4;

impl Differences {
    /// The constants of a minimum of the sum of squares over 40 instants near `guess`.
    pub(crate) fn squares(&mut self, guess: &[f64], settings: &Settings) -> Option<Vec<f64>> {
        let carries = 2 * guess.len() > PLAIN_RUNS;
        let coarse = self.coarse.clone();
        let found = self.least((SEARCH_TOLERANCE, GAIN), &coarse, guess, carries)?;
        let close = found.residual < CLOSE * self.way(1.0, self.stride());
        let fine = (settings.tolerance * TIGHTER, 0.0);
        let refined = if close { self.least(fine, settings, &found.unknowns, carries) } else { None };
        Some(refined.unwrap_or(found).unknowns)
    }

    /// The minimum at this tolerance, with derivatives carried or by differences.
    pub fn least(
        &mut self,
        (tolerance, least_gain): (f64, f64),
        limits: &Settings,
        guess: &[f64],
        carries: bool,
    ) -> Option<Shot> {
        let stride = self.stride();
        let full = ShootOptions::with_tolerance(tolerance * self.way(1.0, stride));
        let least_gain = f64::max(least_gain, full.least_gain);
        let options = ShootOptions { max_iterations: ITERATIONS, least_gain, ..full };
        let count = self.instants(1.0, stride) * self.dimension();
        fit(&mut Squares { differences: self, tolerance, limits, stride, carries }, count, guess, &options).ok()
    }

    fn stride(&self) -> usize {
        self.goal.len() / INSTANTS
    }
}

/// All differences, as functions of the constants.
struct Squares<'a> {
    differences: &'a mut Differences,
    tolerance: f64,
    limits: &'a Settings,
    stride: usize,
    carries: bool,
}

impl Residuals for Squares<'_> {
    fn residual(&mut self, constants: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError> {
        let differences = self.differences.fill(constants, 1.0, self.stride, self.tolerance, self.limits)?;
        residual.copy_from_slice(differences.as_slice());
        Ok(())
    }

    fn jacobian(&mut self, constants: &[f64], jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        let Differences { prepared, goal, end, work, .. } = &mut *self.differences;
        let method = prepared.method.method;
        if !self.carries || !Carried::is_by(method) {
            return Ok(false);
        }
        let broken = |error: crate::SolveError| BoundaryError::Residual { reason: error.to_string() };
        prepared.set_constants(constants);
        let options = Settings { method: Some(method), ..self.limits.clone() }.options(self.tolerance);
        let along: Vec<_> = (0..constants.len()).map(|i| prepared.along_constant(i, 1.0)).collect();
        let options = Options { wanted: None, ..options };
        let mut carried = Carried::run(prepared, &along, *end, &options, Which::Kept).map_err(broken)?;
        *work += PLAIN_RUNS * carried.steps() * prepared.compiled.cost()[1].operations();
        if *carried.status() != Status::Completed {
            return Ok(false);
        }
        let (k, n) = (constants.len(), goal[0].1.len());
        for (rows, (t, _, factor)) in
            jacobian.chunks_exact_mut(k * n).zip(goal.iter().skip(self.stride - 1).step_by(self.stride))
        {
            let (_, derivatives) = carried.at(prepared, *t).map_err(broken)?;
            for (j, derivatives) in derivatives.into_iter().enumerate() {
                let column = factor * DVector::from_vec(derivatives.coordinates);
                column.iter().enumerate().for_each(|(i, x)| rows[i * k + j] = *x);
            }
        }
        Ok(true)
    }
}
