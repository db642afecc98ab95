//! T8: what friction and added mass tend to.

use deltaq::Setting;

use super::CheckError;
use crate::realization::{Realization, distance, realize};
use crate::{Case, Kind};

/// `N`, each ten times the one before.
const STRENGTHS: [f64; 3] = [1e2, 1e3, 1e4];

/// What the distance must shrink by from `N = 10³` to `10⁴`: ten, within this factor.
const RATE: std::ops::RangeInclusive<f64> = 7.0..=14.0;

/// A distance that small at `N = 10³` says nothing about a rate.
const VISIBLE: f64 = 1e-7;

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
        let limit = if kind == Realization::Friction { &mut case.chetaev } else { &mut case.vakonomic };
        let mut distances = Vec::new();
        for strength in STRENGTHS {
            let mut motion = realize(kind, strength, setting, &multipliers)?;
            distances.push(distance(limit, &mut motion, &mut case.metric)?);
        }
        if distances.iter().any(|d| d.is_nan()) {
            case.found.undecided(8, claim, "a motion stops early");
            continue;
        }
        if distances[1] < VISIBLE {
            continue;
        }
        let rate = distances[1] / distances[2];
        let note = format!("distances {:.1e}, {:.1e}, {:.1e}", distances[0], distances[1], distances[2]);
        case.found.require(8, claim, RATE.contains(&rate), note);
        case.found.observe(8, what, rate);
    }
    Ok(())
}
