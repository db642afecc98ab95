//! Fairness: the free constants with which one motion comes closest to another.
//!
//! "Different" means different for *every* choice of free constants (T9), so a comparison searches the best.

use equations::Equations;
use integrate::{BoundaryError, ShootOptions, fit};
use mechanics::ConstantsRule;
use nalgebra::DVector;

use crate::{Metric, Motion, Prepared, Setting, Settings, SolveError, TIGHTER, solve};

/// Instants at which the fit compares.
const INSTANTS: usize = 40;

/// Tolerance of the integrations while the best constants are searched, and the limits on the search.
const SEARCH_TOLERANCE: f64 = 1e-7;
const SEARCH_STEPS: usize = 5_000;
const SEARCH_ITERATIONS: usize = 30;
/// The coarse search is done where an iteration brings less than this part.
const SEARCH_GAIN: f64 = 1e-4;

/// Where the search comes this close, relative to the length of the way, it is refined at the full tolerance.
const CLOSE: f64 = 1e-4;

/// Integrates `equations` with the free constants whose coordinates come closest to those of `target`:
///
/// ```text
/// minimize Σ_k Δqᵀ M Δq ,   Δq = q(t_k; C) − q_target(t_k) ,   over C .
/// ```
///
/// Searches at a coarse tolerance from that of `guesses` which is closest, and refines what comes close: then
/// it may be exact. `None` where there is no free constant, or no guess leads to a motion.
///
/// # Errors
/// [`SolveError`] where the motion cannot be started or `target` cannot be read off.
pub fn best_fit(
    setting: Setting,
    equations: &Equations,
    target: &mut Motion,
    guesses: &[Vec<f64>],
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Motion>, SolveError> {
    if equations.free_constants.is_empty() {
        return Ok(None);
    }
    let n = setting.system.dimension();
    let (start, end) = (target.start(), target.end());
    let mut goal = Vec::new();
    for k in 1..=INSTANTS {
        let t = start + (end - start) * k as f64 / INSTANTS as f64;
        let outputs = target.at(t)?;
        let factor = metric.factor(t, &outputs.coordinates, &outputs.velocities);
        goal.push((t, DVector::from_vec(outputs.coordinates), factor));
    }
    let origin = DVector::from_vec(target.at(start)?.coordinates);
    let way = goal.iter().map(|(_, q, factor)| (factor * (q - &origin)).norm_squared()).sum::<f64>().sqrt();
    let mut prepared = Prepared::new(setting, equations.clone(), settings)?;
    let settings = &Settings { method: Some(prepared.method.method), ..settings.clone() };
    let mut difference = |tolerance: f64, limits: &Settings, constants: &[f64], residual: &mut [f64]| {
        let broken = |reason: String| BoundaryError::Residual { reason };
        prepared.set_constants(constants);
        let run = prepared.integrate(end, &limits.options(tolerance)).map_err(|e| broken(e.to_string()))?;
        run.solution.completed()?;
        for ((t, q, factor), residual) in goal.iter().zip(residual.chunks_exact_mut(n)) {
            let outputs = run.at(&mut prepared.compiled, *t).map_err(|e| broken(e.to_string()))?;
            let difference = factor * (DVector::from_vec(outputs.coordinates) - q);
            residual.copy_from_slice(difference.as_slice());
        }
        Ok(())
    };
    let coarse = Settings { max_steps: SEARCH_STEPS, ..settings.clone() };
    let mut apart = vec![0.0; INSTANTS * n];
    let mut begun = |guess: &Vec<f64>| -> f64 {
        difference(SEARCH_TOLERANCE, &coarse, guess, &mut apart)
            .map_or(f64::INFINITY, |()| apart.iter().map(|d| d * d).sum())
    };
    let closest = match guesses {
        [only] => Some(only),
        several => {
            let distances: Vec<f64> = several.iter().map(&mut begun).collect();
            several.iter().zip(distances).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(guess, _)| guess)
        }
    };
    let mut search = |tolerance: f64, least_gain: f64, limits: &Settings, guess: &[f64]| {
        let full = ShootOptions::with_tolerance(tolerance * way);
        let least_gain = least_gain.max(full.least_gain);
        let options = ShootOptions { max_iterations: SEARCH_ITERATIONS, least_gain, ..full };
        fit(
            &mut |constants: &[f64], residual: &mut [f64]| difference(tolerance, limits, constants, residual),
            INSTANTS * n,
            guess,
            &options,
        )
    };
    let mut best = closest.and_then(|guess| search(SEARCH_TOLERANCE, SEARCH_GAIN, &coarse, guess).ok());
    if let Some(found) = &best
        && found.residual < CLOSE * way
        && let Ok(refined) = search(settings.tolerance * TIGHTER, 0.0, settings, &found.unknowns)
    {
        best = Some(refined);
    }
    let Some(best) = best else { return Ok(None) };
    let rule = ConstantsRule::Given(best.unknowns);
    Ok(Some(solve(Setting { end, ..setting }, equations.clone(), &rule, settings)?))
}
