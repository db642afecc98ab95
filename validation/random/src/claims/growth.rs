//! T5: how the divergence begins.

use deltaq::{Pairing, choices, growth};

use super::CheckError;
use crate::Case;
use crate::case::Which;

/// Deviation of the measured exponent from the predicted one, beyond its doubt.
const EXPONENT: f64 = 1e-2;

/// The doubt in a figure, in its changes where the fit has one term less: a change tells the size of what is
/// left out, and is no bound. Exponents are whole numbers: one that is wrong is off by more.
const CHANGES: f64 = 3.0;

/// An exponent that is less certain than this is not judged, nor is a coefficient with that relative doubt.
const UNCERTAIN: f64 = 0.1;

/// Relative deviation of the measured leading coefficient from the predicted one, beyond its doubt.
const COEFFICIENT: f64 = 1e-2;

/// A predicted gap that does not reach this over the run says nothing: its growth cannot be measured.
const VISIBLE: f64 = 1e-5;

/// The growth is measured within this part of the time after which another term is the larger one, and after
/// as many times that up to which one is.
const WITHIN: f64 = 0.5;

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
    let claim = "the leading divergence is the predicted one";
    match growth(&mut case.vakonomic, &mut case.chetaev, &mut case.metric, &limit)? {
        None => case.found.undecided(5, claim, "the gap does not stand out from the errors near the start"),
        Some(measured) if measured.to > WITHIN * predicted.reach || predicted.from > WITHIN * measured.from => {
            let leading = format!("leading from {:.1e} until {:.1e}", predicted.from, predicted.reach);
            let note = format!("seen from t = {:.1e}, and {leading}", measured.from);
            case.found.undecided(5, claim, note);
        }
        Some(measured) if measured.uncertainty > UNCERTAIN => {
            case.found.undecided(5, claim, format!("the exponent is uncertain by {:.1e}", measured.uncertainty));
        }
        Some(measured) => {
            let exponent = (measured.exponent - f64::from(predicted.exponent)).abs();
            case.found.bound(
                5,
                "exponent of the leading divergence",
                exponent,
                EXPONENT + CHANGES * measured.uncertainty,
            );
            let claim = "coefficient of the leading divergence";
            match measured.coefficient_uncertainty {
                doubt if doubt > UNCERTAIN => {
                    case.found.undecided(5, claim, format!("measured with a doubt of {doubt:.1e}"));
                }
                doubt => case.found.bound(5, claim, measured.deviation_from(&predicted), COEFFICIENT + CHANGES * doubt),
            }
            match (predicted.exponent, without) {
                (2, _) => case.found.observe(5, "growth exponent, mu0 not zero", measured.exponent),
                (3, true) => case.found.observe(5, "growth exponent, mu0 = 0", measured.exponent),
                _ => {}
            }
        }
    }
    Ok(())
}
