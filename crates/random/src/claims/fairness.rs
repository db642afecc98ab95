//! T9: the fit of free constants.

use deltaq::{Sampling, Setting, Settings, best_fit, compare_motions_by};

use super::CheckError;
use crate::case::{Which, equations};
use crate::{Case, Kind, Word};

/// A planted motion is found from a guess that is this far off, and from zero.
const OFF: f64 = 0.2;

/// Plants a vakonomic motion and lets the fit find it; then fits vakonomic motions to the Chetaev motion and measures what remains.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let h = case.scene.system.constraints.len();
    if h == 0 || case.recipe.kind == Kind::NearRankLoss {
        return Ok(());
    }
    let system = case.scene.system.clone();
    let start = case.scene.start.clone();
    let setting = Setting { system: &system, start: &start, end: case.end() };
    let settings = Settings { max_steps: 3_000, ..Settings::default() };
    let equations = equations(&system, "vakonomic", None)?;
    let planted = case.scene.multipliers.clone();
    let near: Vec<f64> = planted.iter().enumerate().map(|(i, mu)| mu + if i % 2 == 0 { OFF } else { -OFF }).collect();
    let mut target = case.vakonomic.clone();
    let mut metric = case.metric.clone();
    let claim = "a planted vakonomic motion is found";
    match best_fit(setting, &equations, &mut target, &[vec![0.0; h], near], &mut metric, &settings)? {
        Some(mut found) => {
            case.same(9, claim, Which::Vakonomic, &mut found);
            // the search is a local one: that it ends elsewhere says nothing about the claim
            if let Some(last) = case.found.findings.last_mut().filter(|f| f.word == Word::Fails) {
                last.word = Word::Undecided;
                last.note = format!("the search ends elsewhere, {}", last.note);
            }
        }
        None => case.found.undecided(9, claim, "no guess led to a motion"),
    }
    if case.recipe.kind.is_integrable() {
        return Ok(());
    }
    let sampling = Sampling { instants: 80, ..Sampling::default() };
    let mut chetaev = case.chetaev.clone();
    let guesses = [vec![0.0; h], planted];
    let Some(mut fitted) = best_fit(setting, &equations, &mut chetaev, &guesses, &mut metric, &settings)? else {
        return Ok(());
    };
    let before = case.gap(Which::Chetaev, Which::Vakonomic)?;
    let after = compare_motions_by(&mut chetaev, &mut fitted, &mut metric, &sampling)?;
    if before.certain_from.is_some() && before.largest > 0.0 {
        case.found.count(
            9,
            "vakonomic differs from Chetaev, and still does after the best fit",
            after.certain_from.is_some(),
        );
        case.found.observe(9, "gap after the best fit over gap before", after.largest / before.largest);
    }
    Ok(())
}
