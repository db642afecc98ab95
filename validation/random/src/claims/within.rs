//! What must hold within each formulation.

use mechanics::{SingularValues, State, System};
use motion::VAKONOMIC_COSTATE;
use referees::maggi;
use symbolic::limits::OF_TERMS;

use super::CheckError;
use crate::Case;
use crate::case::Which;
use crate::derived::equations;
use crate::realization::constraint_jacobian;
use motion::band::INSTANTS;

/// Maggi's equations give Chetaev's motion, the costate form the vakonomic one; all keep the constraint.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    if system.constraints.is_empty() {
        return Ok(());
    }
    maggi(case)?;
    let multipliers = case.scene.multipliers.clone();
    let mut costate_form = case.run(equations(&system, VAKONOMIC_COSTATE, None)?, &multipliers)?;
    case.same(0, "vakonomic: multiplier form and costate form", Which::Vakonomic, &mut costate_form);
    let removed = (0..case.removed.len()).map(Which::Removed);
    for which in [Which::Chetaev, Which::Vakonomic].into_iter().chain(removed) {
        keeps_constraint(case, which)?;
    }
    Ok(())
}

/// Chetaev's motion against that of Maggi's equations.
fn maggi(case: &mut Case) -> Result<(), CheckError> {
    let [looser, kept] = &mut case.referee()?.clone();
    compared(case, Which::Chetaev, "Chetaev: multipliers and Maggi's equations", looser, kept)
}

/// Each with its own error estimate.
fn compared(
    case: &mut Case,
    which: Which,
    claim: &'static str,
    looser: &mut maggi::Motion,
    kept: &mut maggi::Motion,
) -> Result<(), CheckError> {
    let (mut gap, mut limit, mut size) = (0.0_f64, 0.0_f64, 1.0_f64);
    let (end, mut last) = (case.end(), kept.end().min(looser.end()));
    let system = case.scene.system.clone();
    let rank = |t: f64, q: &[f64], v: &[f64]| rank(&system, &State { t, q: q.to_vec(), v: v.to_vec() });
    let linear = system.constraints_linear_in_velocity();
    let first = &case.scene.start;
    let least = if linear { 0.0 } else { motion::TRUSTED * rank(first.t, &first.q, &first.v)? };
    let motion = case.motion(which);
    for t in motion.grid(INSTANTS).into_iter().filter(|&t| t <= last) {
        let (own, other) = motion.at_in_both_runs(t)?;
        let (State { q: one, v, .. }, two) = (kept.state(t)?, looser.state(t)?.q);
        if !linear && rank(t, &own.coordinates, &own.velocities)?.min(rank(t, &one, &v)?) < least {
            last = t;
            break;
        }
        let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        gap = gap.max(largest(&own.coordinates, &one));
        limit = limit.max(largest(&own.coordinates, &other.coordinates) + largest(&one, &two));
        size = size.max(own.coordinates.iter().fold(0.0, |a, q| a.max(q.abs())));
    }
    case.found.bound(0, claim, gap, motion::CERTAINTY * (limit + OF_TERMS * size) + case.floor);
    if last < end {
        let because = match last < kept.end() {
            true => "the constraints nearly lose rank".into(),
            false => format!("the referee stops: {:?}", kept.ending()),
        };
        case.found.undecided(0, claim, format!("from t = {last:.4} on, {because}"));
    }
    Ok(())
}

/// The smallest singular value of `∂f/∂v`.
fn rank(system: &System, state: &State) -> Result<f64, CheckError> {
    let values = SingularValues::of(&constraint_jacobian(system, state)?).values;
    Ok(values.iter().copied().fold(f64::INFINITY, f64::min))
}

/// `|f|` stays within what the two runs differ by, and round-off.
fn keeps_constraint(case: &mut Case, which: Which) -> Result<(), CheckError> {
    let mut metric = case.metric.clone();
    let motion = case.motion(which);
    let (mut residual, mut limit) = (0.0_f64, 0.0_f64);
    for t in motion.grid(INSTANTS) {
        let (kept, looser) = motion.at_in_both_runs(t)?;
        let of = |metric: &mut motion::Metric, o: &equations::Outputs| {
            metric.constraint_residual(t, &o.coordinates, &o.velocities)
        };
        let size = kept.velocities.iter().fold(1.0_f64, |a, v| a.max(v.abs()));
        let error = kept.velocities.iter().zip(&looser.velocities).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let (own, other) = (of(&mut metric, &kept), of(&mut metric, &looser));
        residual = residual.max(own);
        // what both runs are off by is no error of theirs
        let error = error + (own - other).abs();
        limit = limit.max(motion::CERTAINTY * size * error + OF_TERMS * size * size);
    }
    case.found.bound(0, "the constraint is kept", residual, limit);
    Ok(())
}
