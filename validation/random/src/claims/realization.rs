//! T8: what friction and added mass tend to, and the family between.

use motion::{CERTAINTY, Metric, Motion, Setting, SolveError};

use super::CheckError;
use crate::case::Which;
use crate::derived::equations;
use crate::realization::{Realization, distance, realize, with_kappa};
use crate::{Case, Kind};
use motion::band::INSTANTS;

/// The first `N`, and the first `κ` in 1/s of a kick; each further one is ten times the one before.
pub(super) const STRENGTH: f64 = 1e2;

/// The first `κ` in 1/s, in the same way: large ones make the equations stiff.
const KAPPA: f64 = 1e1;

/// Distances measured, and one more where these have not shown it yet: `a/N + b/N² + …` shrinks tenfold in
/// the end, and how soon depends on `b/a`.
const FEW: i32 = 3;

/// What the distance must shrink by at last. `O(1/N)` is ten, and more where the first term vanishes.
const RATE: f64 = 7.0;

/// A second distance that small says nothing about a rate.
pub const VISIBLE: f64 = 1e-7;

/// Constraints linear in the velocities.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let system = case.scene.system.clone();
    if system.constraints.is_empty()
        || !system.constraints_linear_in_velocity()
        || case.recipe.kind == Kind::NearRankLoss
    {
        return Ok(());
    }
    let (start, multipliers) = (case.scene.start.clone(), case.scene.multipliers.clone());
    let setting = Setting { system: &system, start: &start, end: case.end() };
    // what slips has f' = −N A M⁻¹ Aᵀ f + …: with negative inertia friction may drive it on
    let slows = !case.recipe.drawn.indefinite;
    for (kind, claim, what) in [
        (
            Realization::Friction,
            "friction tends to Chetaev at rate 1/N",
            "friction: distance at N = 1000 over that at 10000",
        ),
        (
            Realization::AddedMass,
            "added mass tends to vakonomic at rate 1/N",
            "added mass: distance at N = 1000 over that at 10000",
        ),
    ] {
        if kind == Realization::Friction && !slows {
            continue;
        }
        judge(case, claim, what, |case, power| {
            let mut motion = realize(kind, STRENGTH * power, setting, &multipliers)?;
            apart(case, if kind == Realization::Friction { Which::Chetaev } else { Which::Vakonomic }, &mut motion)
        })?;
    }
    between(case)
}

/// The distance of a motion from one of the case's own, and its own error.
fn apart(case: &mut Case, which: Which, motion: &mut Motion) -> Result<[f64; 2], CheckError> {
    let mut metric = case.metric.clone();
    Ok([distance(case.motion(which), motion, &mut metric)?, own_error(motion, &mut metric)?])
}

/// `d/dt 𝓛_v − 𝓛_q = Q − κ Aᵀ μ` is vakonomic at `κ = 0`, and tends to Chetaev at the rate `1/κ`.
fn between(case: &mut Case) -> Result<(), CheckError> {
    let (system, multipliers) = (case.scene.system.clone(), case.scene.multipliers.clone());
    let motion = |case: &mut Case, kappa: f64| {
        case.run(equations(&with_kappa(&system, kappa), motion::KAPPA, None)?, &multipliers)
    };
    let mut at_zero = motion(case, 0.0)?;
    case.same(8, "the family between begins at vakonomic", Which::Vakonomic, &mut at_zero);
    judge(
        case,
        "the family between tends to Chetaev at rate 1/kappa",
        "kappa: distance at 100 over that at 1000",
        |case, power| {
            let mut motion = motion(case, KAPPA * power)?;
            apart(case, Which::Chetaev, &mut motion)
        },
    )
}

/// The largest difference of a motion's two runs, as a kinetic length.
pub(super) fn own_error(motion: &mut Motion, metric: &mut Metric) -> Result<f64, SolveError> {
    let mut largest = 0.0_f64;
    for t in motion.grid(INSTANTS) {
        let (now, difference) = (motion.at(t)?, motion.difference_of_runs(t)?);
        let n = now.coordinates.len();
        largest = largest.max(metric.length(t, &now.coordinates, &now.velocities, &difference[..n]));
    }
    Ok(largest)
}

/// The last two distances must be about ten apart or more; `measured` gives distance and own error at
/// powers of ten.
///
/// # Errors
/// Those of `measured`.
pub fn judge(
    case: &mut Case,
    claim: &'static str,
    what: &'static str,
    measured: impl Fn(&mut Case, f64) -> Result<[f64; 2], CheckError>,
) -> Result<(), CheckError> {
    let mut distances = Vec::new();
    let (mut rate, mut error) = (f64::NAN, 0.0_f64);
    for count in 1..=FEW + 1 {
        let [distance, own] = measured(case, 10_f64.powi(count - 1))?;
        distances.push(distance);
        error = error.max(own);
        if count < FEW {
            continue;
        }
        let [.., before, last] = distances[..] else { continue };
        if before < VISIBLE {
            if count > FEW {
                case.found.undecided(8, claim, "the motions come too close before they show a rate");
            }
            return Ok(());
        }
        if before <= CERTAINTY * error {
            case.found.undecided(8, claim, format!("distance {before:.1e}, own error {error:.1e}"));
            return Ok(());
        }
        rate = before / last;
        if count == FEW {
            case.found.observe(8, what, rate);
        }
        if rate >= RATE {
            break;
        }
    }
    let note = distances.iter().map(|d| format!("{d:.1e}")).collect::<Vec<_>>().join(", ");
    // what both distances are off by moves their quotient
    let most = match distances[..] {
        [.., before, last] => (before + error) / (last - error).max(0.0),
        _ => rate,
    };
    match rate.is_nan() {
        true => case.found.undecided(8, claim, "a motion stops early"),
        false if rate < RATE && most >= RATE => {
            case.found.undecided(8, claim, format!("distances {note}, own error {error:.1e}"));
        }
        false => {
            let holds = rate >= RATE || shows_two_terms(&distances);
            case.found.require(8, claim, holds, format!("distances {note}"));
        }
    }
    Ok(())
}

/// What two terms tell of the distance before those they are taken from; of `1/N²` they would tell 1.2 of it.
const TOLD: std::ops::RangeInclusive<f64> = 0.85..=1.15;

/// Whether the last of four distances, at powers of ten, are `|a/N + b/N²|`, and `a/N` the larger term at
/// last. Where the two nearly cancel, as after a switch that is faster than `1/N`, a quotient is not ten yet.
pub fn shows_two_terms(distances: &[f64]) -> bool {
    let [.., first, before, last] = distances[..] else { return false };
    // a + b at last, 10 a + 100 b before
    let with_sign = |sign: f64| {
        let b = (sign * before - 10.0 * last) / 90.0;
        let a = last - b;
        let part = (100.0 * a + 1e4 * b).abs() / first;
        a.abs() > b.abs() && TOLD.contains(&part)
    };
    distances.len() > FEW as usize && [1.0, -1.0].into_iter().any(with_sign)
}
