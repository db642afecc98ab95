//! T12: the deliberately wrong formulation.

use deltaq::{Verdict, multipliers_of};

use super::CheckError;
use crate::case::{Which, equations};
use crate::{Case, Kind};
use referees::maggi::Maggi;

/// Fractions of the run at which the control's equations are put to the test.
const PLACES: [f64; 5] = [0.05, 0.2, 0.45, 0.7, 0.95];

/// Distances of the differences, in parts of the run: the lesser error counts, round-off of near ones or, in
/// a switch, that of far ones.
const DISTANCES: [f64; 2] = [1e-3, 1e-4];

/// Over `WRONG` of Maggi's residual the control motion is wrong, under `RIGHT` right, between undecided.
const WRONG: f64 = 1e-6;
const RIGHT: f64 = 1e-12;

/// Flagged wherever Maggi's equations say wrong; called right where right, above all in Chaplygin's form.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    if case.control.is_none() || case.recipe.kind == Kind::Free {
        return Ok(());
    }
    criterion(case)?;
    let residual = residual(case)?;
    let gap = case.gap(Which::Chetaev, Which::Control)?;
    let flagged = gap.certain_from.is_some();
    if case.recipe.kind == Kind::ChaplyginIntegrable {
        let note = format!("residual {residual:.1e}, gap {:.1e}", gap.largest);
        case.found.require(12, "right in Chaplygin's integrable form", gap.verdict == Verdict::Same, note);
    } else if residual > WRONG {
        case.found.count(12, "the wrong formulation is wrong, and flagged", flagged);
        match flagged {
            true => case.found.require(12, "flagged where it is wrong", true, ""),
            false => case.found.undecided(
                12,
                "flagged where it is wrong",
                format!("residual {residual:.1e}, gap {:.1e}", gap.largest),
            ),
        }
    } else if residual < RIGHT {
        case.found.require(12, "not flagged where it is right", !flagged, format!("residual {residual:.1e}"));
    }
    Ok(())
}

/// Where `L` in the parameters is free of memory variables (Chaplygin's form), the control is the vakonomic
/// motion with `P = 0`, `c = 0` in `(c − L_ṡ)_b 𝓑ᵇ_{αβ} ṙ^β`: right where Chetaev's admits these.
fn criterion(case: &mut Case) -> Result<(), CheckError> {
    let (system, Some((removal, _))) = (case.scene.system.clone(), case.control.clone()) else { return Ok(()) };
    let reduced = removal.rewrite(&system, system.lagrangian);
    if removal.memory.iter().any(|w| system.graph.depends_on(reduced, w.symbol)) {
        return Ok(());
    }
    let Some(mu) = multipliers_of(&case.scene, &removal, &vec![0.0; removal.memory.len()])? else { return Ok(()) };
    let mut motion = case.run(equations(&system, "vakonomic", None)?, &mu)?;
    case.same(12, "substitution is the vakonomic motion with c = 0", Which::Control, &mut motion);
    let Some(found) = case.membership()? else { return Ok(()) };
    let (right, gap) = (found.decision.admits(&mu), case.gap(Which::Chetaev, Which::Control)?);
    let note = format!("mismatch {:.1e}, gap {:.1e}", found.decision.mismatch_at(&mu), gap.largest);
    let claim = "right exactly where c = 0 gives Chetaev's motion";
    match (right, gap.certain_from.is_some()) {
        (true, flagged) => case.found.require(12, claim, !flagged, note),
        (false, true) => case.found.require(12, claim, true, note),
        (false, false) => case.found.undecided(12, claim, note),
    }
    Ok(())
}

/// Largest relative residual of Maggi's equations on the control motion, accelerations by differences.
fn residual(case: &mut Case) -> Result<f64, CheckError> {
    let mut maggi = Maggi::new(&case.scene.system)?;
    let (start, duration) = (case.scene.start.t, case.scene.duration);
    let motion = case.motion(Which::Control);
    let mut worst = 0.0_f64;
    for place in PLACES {
        let mut least = f64::INFINITY;
        for h in DISTANCES.map(|h| h * duration) {
            let t = start + place * duration;
            let mut velocity = |t: f64| motion.at(t).map(|o| o.velocities);
            let (a, b, c, d) = (velocity(t - 2.0 * h)?, velocity(t - h)?, velocity(t + h)?, velocity(t + 2.0 * h)?);
            let derivative = |i: usize| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h);
            let acceleration: Vec<f64> = (0..a.len()).map(derivative).collect();
            let now = motion.at(t)?;
            least = least.min(maggi.residual(t, &now.coordinates, &now.velocities, &acceleration)?.largest());
        }
        worst = worst.max(least);
    }
    Ok(worst)
}
