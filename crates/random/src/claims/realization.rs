//! T8: what friction and added mass tend to, and the family between.

use deltaq::Setting;

use super::CheckError;
use crate::case::{Which, equations};
use crate::realization::{Realization, distance, realize, with_kappa};
use crate::{Case, Kind};

/// `N`, each ten times the one before.
const STRENGTHS: [f64; 3] = [1e2, 1e3, 1e4];

/// `κ` in 1/s, likewise: larger ones make the equations stiff.
const KAPPAS: [f64; 3] = [1e1, 1e2, 1e3];

/// What the distance must shrink by from the second to the third: ten, within this factor.
const RATE: std::ops::RangeInclusive<f64> = 7.0..=14.0;

/// A second distance that small says nothing about a rate.
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
        judge(case, claim, what, &distances);
    }
    between(case)
}

/// `d/dt 𝓛_v − 𝓛_q = Q − κ Aᵀ μ` is vakonomic at `κ = 0`, and tends to Chetaev at the rate `1/κ`.
fn between(case: &mut Case) -> Result<(), CheckError> {
    let (system, multipliers) = (case.scene.system.clone(), case.scene.multipliers.clone());
    let motion =
        |case: &mut Case, kappa: f64| case.run(equations(&with_kappa(&system, kappa), "kappa", None)?, &multipliers);
    let mut at_zero = motion(case, 0.0)?;
    case.same(8, "the family between begins at vakonomic", Which::Vakonomic, &mut at_zero);
    let mut distances = Vec::new();
    for kappa in KAPPAS {
        let mut motion = motion(case, kappa)?;
        distances.push(distance(&mut case.chetaev, &mut motion, &mut case.metric)?);
    }
    judge(
        case,
        "the family between tends to Chetaev at rate 1/kappa",
        "kappa: distance at 100 over that at 1000",
        &distances,
    );
    Ok(())
}

/// The last two distances must be about ten apart.
fn judge(case: &mut Case, claim: &'static str, what: &'static str, distances: &[f64]) {
    if distances.iter().any(|d| d.is_nan()) {
        case.found.undecided(8, claim, "a motion stops early");
    } else if distances[1] >= VISIBLE {
        let rate = distances[1] / distances[2];
        let note = format!("distances {:.1e}, {:.1e}, {:.1e}", distances[0], distances[1], distances[2]);
        case.found.require(8, claim, RATE.contains(&rate), note);
        case.found.observe(8, what, rate);
    }
}
