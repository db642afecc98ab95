//! T5: how the divergence begins.

use decision::{ExactStart, Family, Question};
use deltaq::{LeadingTerm, SolveError, growth};

use super::CheckError;
use crate::Case;
use crate::case::{Which, as_derived};

/// Deviation of the measured exponent from the predicted one, beyond its own uncertainty.
const EXPONENT: f64 = 1e-2;

/// An exponent that is less certain than this is not judged.
const UNCERTAIN: f64 = 0.1;

/// Relative deviation of the measured leading coefficient from the predicted one.
const COEFFICIENT: f64 = 1e-2;

/// A predicted gap that does not reach this over the run says nothing: its growth cannot be measured.
const VISIBLE: f64 = 1e-5;

/// The growth is measured within this part of the time after which another term is the larger one.
const WITHIN: f64 = 0.5;

/// `q_vak − q_chet = y_k t^{k+2}/((k+1)(k+2))` with the first coefficient `y_k` of the mismatch that is not zero, for every `f` and `μ₀`.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let (scene, multipliers) = (&case.scene, &case.scene.multipliers);
    let (system, start) = (&scene.system, &scene.start);
    if system.constraints.is_empty() {
        return Ok(());
    }
    let family = Family::new(system, &as_derived(system, "vakonomic")?, false).map_err(SolveError::from)?;
    let chetaev = as_derived(system, "chetaev")?;
    let question = Question::new(system, &chetaev, &[], &family).map_err(SolveError::from)?;
    let exact = ExactStart::new(system, start, &scene.completion, None).map_err(SolveError::from)?;
    let Some(term) = question.leading_difference(system, start, Some(&exact), multipliers) else { return Ok(()) };
    let length = case.metric.length(start.t, &start.q, &start.v, &term.coefficient);
    let predicted = LeadingTerm { exponent: term.exponent as u32, coefficient: term.coefficient, length };
    if length * scene.duration.min(term.reach).powi(term.exponent as i32) < VISIBLE {
        return Ok(());
    }
    let without = multipliers.iter().all(|&mu| mu == 0.0);
    let gap = case.gap(Which::Chetaev, Which::Vakonomic)?;
    let limit = |t: f64| gap.limit_at(t);
    let claim = "the leading divergence is the predicted one";
    match growth(&mut case.vakonomic, &mut case.chetaev, &mut case.metric, &limit)? {
        None => case.found.undecided(5, claim, "the gap does not stand out from the errors near the start"),
        Some(measured) if measured.to > WITHIN * term.reach => {
            let note = format!("seen from t = {:.1e}, and leading until {:.1e}", measured.from, term.reach);
            case.found.undecided(5, claim, note);
        }
        Some(measured) if measured.uncertainty > UNCERTAIN => {
            case.found.undecided(5, claim, format!("the exponent is uncertain by {:.1e}", measured.uncertainty));
        }
        Some(measured) => {
            let exponent = (measured.exponent - f64::from(predicted.exponent)).abs();
            case.found.bound(5, "exponent of the leading divergence", exponent, EXPONENT + measured.uncertainty);
            case.found.bound(
                5,
                "coefficient of the leading divergence",
                measured.deviation_from(&predicted),
                COEFFICIENT,
            );
            match (predicted.exponent, without) {
                (2, _) => case.found.observe(5, "growth exponent, mu0 not zero", measured.exponent),
                (3, true) => case.found.observe(5, "growth exponent, mu0 = 0", measured.exponent),
                _ => {}
            }
        }
    }
    Ok(())
}
