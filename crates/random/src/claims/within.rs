//! What must hold within each formulation.

use super::CheckError;
use crate::Case;
use crate::case::Which;
use crate::derived::equations;

/// Instants at which the constraint is looked at.
const INSTANTS: usize = 12;

/// Maggi's equations give Chetaev's motion, the costate form the vakonomic one; all keep the constraint.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    if system.constraints.is_empty() {
        return Ok(());
    }
    maggi(case)?;
    let multipliers = case.scene.multipliers.clone();
    let mut costate_form = case.run(equations(&system, "vakonomic-costate", None)?, &multipliers)?;
    case.same(0, "vakonomic: multiplier form and costate form", Which::Vakonomic, &mut costate_form);
    let removed = (0..case.removed.len()).map(Which::Removed);
    for which in [Which::Chetaev, Which::Vakonomic].into_iter().chain(removed) {
        keeps_constraint(case, which)?;
    }
    Ok(())
}

/// Chetaev's motion against that of Maggi's equations, each with its own error estimate.
fn maggi(case: &mut Case) -> Result<(), CheckError> {
    let (end, [looser, kept]) = (case.end(), &mut case.referee()?.clone());
    let (mut gap, mut limit, mut size) = (0.0_f64, 0.0_f64, 1.0_f64);
    let last = kept.end().min(looser.end());
    for t in case.chetaev.grid(INSTANTS).into_iter().filter(|&t| t <= last) {
        let (own, other) = case.chetaev.at_in_both_runs(t)?;
        let (one, two) = (kept.state(t)?.q, looser.state(t)?.q);
        let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        gap = gap.max(largest(&own.coordinates, &one));
        limit = limit.max(largest(&own.coordinates, &other.coordinates) + largest(&one, &two));
        size = size.max(own.coordinates.iter().fold(0.0, |a, q| a.max(q.abs())));
    }
    let claim = "Chetaev: multipliers and Maggi's equations";
    case.found.bound(0, claim, gap, deltaq::CERTAINTY * (limit + ROUND_OFF * size) + case.floor);
    if last < end {
        case.found.undecided(0, claim, format!("the referee stops at t = {last:.4}: {:?}", kept.ending()));
    }
    Ok(())
}

/// Round-off relative to the size of a quantity.
const ROUND_OFF: f64 = 1e-13;

/// `|f|` stays within what the two runs differ by, and round-off.
fn keeps_constraint(case: &mut Case, which: Which) -> Result<(), CheckError> {
    let mut metric = case.metric.clone();
    let motion = case.motion(which);
    let (mut residual, mut limit) = (0.0_f64, 0.0_f64);
    for t in motion.grid(INSTANTS) {
        let (kept, looser) = motion.at_in_both_runs(t)?;
        let of = |metric: &mut deltaq::Metric, o: &equations::Outputs| {
            metric.constraint_residual(t, &o.coordinates, &o.velocities)
        };
        let size = kept.velocities.iter().fold(1.0_f64, |a, v| a.max(v.abs()));
        let error = kept.velocities.iter().zip(&looser.velocities).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let (own, other) = (of(&mut metric, &kept), of(&mut metric, &looser));
        residual = residual.max(own);
        // what both runs are off by is no error of theirs
        let error = error + (own - other).abs();
        limit = limit.max(deltaq::CERTAINTY * size * error + ROUND_OFF * size * size);
    }
    case.found.bound(0, "the constraint is kept", residual, limit);
    Ok(())
}
