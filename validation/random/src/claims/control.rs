//! T12: the deliberately wrong formulation.

use comparison::multipliers_of;
use decision::Verdict;
use motion::{Setting, VAKONOMIC, setting};

use super::CheckError;
use crate::case::Which;
use crate::derived::equations;
use crate::{Case, Kind, Word, found_out};

/// Flagged wherever Maggi's equations say wrong; called right where right, above all in Chaplygin's form.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    if case.control.is_none() || case.recipe.kind == Kind::Free {
        return Ok(());
    }
    criterion(case)?;
    let gap = case.gap(Which::Chetaev, Which::Control)?;
    let mut referee = case.referee()?.clone();
    let (mut control, mut metric) = (case.motion(Which::Control).clone(), case.metric.clone());
    let setting = Setting { end: case.end(), ..setting(&case.scene) };
    let found = found_out(setting, &mut control, &gap, &mut referee, &mut metric, case.floor)?;
    if found.is_wrong() {
        case.found.count(12, "the wrong formulation is wrong, and flagged", found.flagged);
    }
    let claim = match (case.recipe.kind, found.is_right()) {
        (Kind::ChaplyginIntegrable, _) => {
            case.note(12, "right in Chaplygin's integrable form", &gap, case.floor);
            return Ok(());
        }
        (_, true) => "not flagged where it is right",
        (_, false) => "flagged where it is wrong, and only there",
    };
    match found.word {
        None => {}
        Some(Word::Undecided) => case.found.undecided(12, claim, found.note),
        Some(word) => case.found.require(12, claim, word == Word::Holds, found.note),
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
    let mut motion = case.run(equations(&system, VAKONOMIC, None)?, &mu)?;
    case.same(12, "substitution is the vakonomic motion with c = 0", Which::Control, &mut motion);
    let Some(found) = case.membership()? else { return Ok(()) };
    let (verdict, gap) = (found.decision.verdict_at(&mu), case.gap(Which::Chetaev, Which::Control)?);
    let until = found.decision.until.map_or(String::new(), |t| format!(" up to {t:.1e} s"));
    let note = format!("mismatch {:.1e}{until}, gap {:.1e}", found.decision.mismatch_at(&mu), gap.largest);
    let claim = "right exactly where c = 0 gives Chetaev's motion";
    match (verdict, gap.certain_from.is_some()) {
        // what was decided of the beginning says nothing of later
        (Verdict::Contained, true) if found.decision.until.is_some() => case.found.undecided(12, claim, note),
        (Verdict::Contained, flagged) => case.found.require(12, claim, !flagged, note),
        (Verdict::NotContained, true) => case.found.require(12, claim, true, note),
        _ => case.found.undecided(12, claim, note),
    }
    Ok(())
}
