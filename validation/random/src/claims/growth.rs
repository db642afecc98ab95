//! T5: how the divergence begins.

use comparison::{Growth, LeadingTerm, Pairing, growth};
use motion::choices;

use super::CheckError;
use crate::case::Which;
use crate::{Case, Findings};

/// Deviation of the measured exponent from the predicted one, and of the coefficient relative to it, beyond
/// their doubt.
const EXPONENT: f64 = 1e-2;

/// The doubt in a figure, in its changes where the fit has one term less: a change tells the size of what is
/// left out, and is not a bound. Exponents are whole numbers: one that is wrong is off by more.
const CHANGES: f64 = 3.0;

/// An exponent that is less certain than this is neither judged nor counted, nor is a coefficient with that
/// relative doubt.
const UNCERTAIN: f64 = 0.1;

/// A predicted gap that does not reach this over the run says nothing: its growth cannot be measured.
const VISIBLE: f64 = 1e-5;

/// `q_vak − q_chet = y_k t^{k+2}/((k+1)(k+2))`, `y_k ≠ 0` first in the mismatch, for every `f`, `μ₀`.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let (scene, multipliers) = (&case.scene, &case.scene.multipliers);
    if scene.system.constraints.is_empty() {
        return Ok(());
    }
    let choices = choices(scene);
    let pairing = Pairing::new(scene, &choices[0], &choices[1])?;
    let Some(predicted) = pairing.leading_term(multipliers)? else { return Ok(()) };
    let within = scene.duration.min(predicted.reach);
    if predicted.length * within.powi(predicted.exponent as i32) < VISIBLE {
        return Ok(());
    }
    let without = multipliers.iter().all(|&mu| mu == 0.0);
    let gap = case.gap(Which::Chetaev, Which::Vakonomic)?;
    let limit = |t: f64| gap.limit_at(t);
    let measured = growth(&mut case.vakonomic, &mut case.chetaev, &mut case.metric, &limit)?;
    judge(&mut case.found, measured.as_ref(), &predicted, without);
    Ok(())
}

/// Whether a growth tells its exponent.
pub(super) fn is_certain(growth: &Growth) -> bool {
    growth.uncertainty <= UNCERTAIN
}

/// Holds a growth, if one was seen, against the predicted one, whose multipliers are zero if it is `without`.
pub fn judge(found: &mut Findings, measured: Option<&Growth>, predicted: &LeadingTerm, without: bool) {
    let claim = "the leading divergence is the predicted one";
    let Some(measured) = measured else {
        return found.undecided(5, claim, "the gap does not stand out from the errors near the start");
    };
    if !predicted.leads(measured.from, measured.to) {
        let leading = format!("leading from {:.1e} until {:.1e}", predicted.from, predicted.reach);
        return found.undecided(5, claim, format!("seen from t = {:.1e}, and {leading}", measured.from));
    }
    if !is_certain(measured) {
        return found.undecided(5, claim, format!("the exponent is uncertain by {:.1e}", measured.uncertainty));
    }
    let off = (measured.exponent - f64::from(predicted.exponent)).abs();
    found.bound(5, "exponent of the leading divergence", off, EXPONENT + CHANGES * measured.uncertainty);
    let claim = "coefficient of the leading divergence";
    match measured.coefficient_uncertainty {
        doubt if doubt > UNCERTAIN => found.undecided(5, claim, format!("measured with a doubt of {doubt:.1e}")),
        doubt => found.bound(5, claim, measured.deviation_from(predicted), EXPONENT + CHANGES * doubt),
    }
    match (predicted.exponent, without) {
        (2, _) => found.observe(5, "growth exponent, mu0 not zero", measured.exponent),
        (3, true) => found.observe(5, "growth exponent, mu0 = 0", measured.exponent),
        _ => {}
    }
}
