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
    fn least(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Choice, Metric, VAKONOMIC, choices, derive_in_form, setting, solve_choice};
    use mechanics::ConstantsRule;
    use scene::Scene;

    /// `cargo test --release -p deltaq --lib squares:: -- --nocapture` prints the table.
    #[test]
    fn fits_with_derivatives_that_are_carried_end_at_the_same_constants_in_fewer_runs() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../catalogue/scenes/");
        println!(
            "{:<20}{:>10}{:>14}{:>22}{:>8}{:>8}",
            "fit of mu0", "constants", "differences", "carried (with them)", "ms", "ms"
        );
        for (name, goal) in [("heisenberg", &[0.7][..]), ("disc", &[0.3, -0.2]), ("trailer", &[0.4, 0.1])] {
            let text = std::fs::read_to_string(format!("{folder}{name}.toml")).expect("a scene");
            let mut scene = Scene::parse(name, &text).unwrap_or_else(|error| panic!("{error}"));
            scene.duration = 2.0;
            let vakonomic = choices(&scene).into_iter().find(|c| c.formulation == VAKONOMIC).expect("vakonomic");
            let goal: Vec<f64> = (0..scene.multipliers.len()).map(|i| goal[i % goal.len()]).collect();
            let given = Choice { constants: ConstantsRule::Given(goal.clone()), ..vakonomic.clone() };
            let settings = Settings::default();
            let mut target = solve_choice(&scene, &given, &settings).expect("a motion");
            let equations =
                derive_in_form(&scene.system, &scene.start, &vakonomic, settings.form).expect("equations").0;
            let mut metric = Metric::new(&scene.system).expect("a metric");
            let guess: Vec<f64> = goal.iter().map(|mu| mu * 0.6 + 0.05).collect();
            let mut searched = |carries: bool| {
                let differences =
                    Differences::new(setting(&scene), &equations, &mut target, INSTANTS, &mut metric, &settings);
                let mut differences = differences.expect("differences");
                let clock = crate::clock::Clock::start();
                let shot = differences.least((1e-13, 0.0), &settings, &guess, carries).expect("a fit");
                (shot, 1e3 * clock.seconds())
            };
            let ((old, slow), (new, fast)) = (searched(false), searched(true));
            let carried = format!("{} ({})", new.evaluations + new.exact, new.exact);
            println!("{name:<20}{:>10}{:>14}{carried:>22}{slow:>8.1}{fast:>8.1}", goal.len(), old.evaluations);
            assert_eq!((old.exact, new.exact), (0, new.iterations), "{name}");
            assert!(new.evaluations + new.exact < old.evaluations, "{name}: {new:?}, {old:?}");
            for shot in [&old, &new] {
                for (found, mu) in shot.unknowns.iter().zip(&goal) {
                    assert!((found - mu).abs() < 1e-8, "{name}: {shot:?} for {goal:?}");
                }
            }
        }
    }
}
