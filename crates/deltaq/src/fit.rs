//! Fairness: the free constants with which one motion comes closest to another.
//!
//! "Different" has to mean different for *every* choice of the free constants (T9), so a comparison also searches the best one.

use integrate::{BoundaryError, ShootOptions, fit};
use mechanics::{ConstantsRule, Equations};

use crate::gap::subtract;
use crate::metric::Metric;
use crate::motion::Prepared;
use crate::{Motion, Setting, Settings, SolveError, solve};

/// Instants at which the fit compares.
const INSTANTS: usize = 40;

/// Integrates `equations` with the free constants for which the coordinates come closest to those of `target`:
///
/// ```text
/// minimize Σ_k |q(t_k; C) − q_target(t_k)|²   over C, each coordinate weighted by its kinetic length.
/// ```
///
/// Starts from each of `guesses` and keeps the best. `None` where there is no free constant, or no guess leads to a motion.
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
        let weights: Vec<f64> = (0..n)
            .map(|i| {
                let mut unit = vec![0.0; n];
                unit[i] = 1.0;
                metric.length(t, &outputs.coordinates, &outputs.velocities, &unit)
            })
            .collect();
        goal.push((t, outputs.coordinates, weights));
    }
    let mut prepared = Prepared::new(setting, equations.clone(), settings)?;
    let mut residual = |constants: &[f64], residual: &mut [f64]| -> Result<(), BoundaryError> {
        let broken = |reason: String| BoundaryError::Residual { reason };
        let run = prepared.run(constants, end, settings.tolerance, settings).map_err(|e| broken(e.to_string()))?;
        let reached = run.dense.end();
        if reached < end {
            return Err(broken(format!("stops at t = {reached}")));
        }
        let mut y = vec![0.0; prepared.equations.states.len()];
        for ((t, q, weights), residual) in goal.iter().zip(residual.chunks_exact_mut(n)) {
            run.dense.evaluate(*t, &mut y);
            let outputs = prepared.compiled.outputs(*t, &y).map_err(|e| broken(e.to_string()))?;
            for (i, difference) in subtract(&outputs.coordinates, q).into_iter().enumerate() {
                residual[i] = weights[i] * difference;
            }
        }
        Ok(())
    };
    let options = ShootOptions::with_tolerance(settings.tolerance);
    let best = guesses
        .iter()
        .filter_map(|guess| fit(&mut residual, INSTANTS * n, guess, &options).ok())
        .min_by(|a, b| a.residual.total_cmp(&b.residual));
    let Some(best) = best else { return Ok(None) };
    let rule = ConstantsRule::Given(best.unknowns);
    Ok(Some(solve(Setting { end, ..setting }, equations.clone(), &rule, settings)?))
}
