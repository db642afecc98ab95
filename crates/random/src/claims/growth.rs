//! T5: how the divergence begins.

use deltaq::{Pairing, choices, growth};

use super::CheckError;
use crate::Case;
use crate::case::Which;

/// Deviation of the measured exponent from the predicted one, beyond its own uncertainty.
const EXPONENT: f64 = 1e-2;

/// An exponent that is less certain than this is not judged.
const UNCERTAIN: f64 = 0.1;

/// Relative deviation of the measured leading coefficient from the predicted one.
const COEFFICIENT: f64 = 1e-2;

/// A predicted gap that does not reach this over the run says nothing: its growth cannot be measured.
const VISIBLE: f64 = 1e-5;

/// `q_vak − q_chet = ½ Π C μ₀ t²`, or `−⅙ Π C λ₀ t³` where `μ₀ = 0`; constraints linear in the velocities.
pub(super) fn check(case: &mut Case) -> Result<(), CheckError> {
    let choices = choices(&case.scene);
    let Some(predicted) = Pairing::new(&case.scene, &choices[0], &choices[1])?.leading_term(&case.scene.multipliers)?
    else {
        return Ok(());
    };
    if predicted.length * case.scene.duration.powi(predicted.exponent as i32) < VISIBLE {
        return Ok(());
    }
    let gap = case.gap(Which::Chetaev, Which::Vakonomic)?;
    let limit = |t: f64| gap.limit_at(t);
    let claim = "the leading divergence is the predicted one";
    match growth(&mut case.vakonomic, &mut case.chetaev, &mut case.metric, &limit)? {
        None => case.found.undecided(5, claim, "the gap does not stand out from the errors near the start"),
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
            let what =
                if predicted.exponent == 2 { "growth exponent, mu0 not zero" } else { "growth exponent, mu0 = 0" };
            case.found.observe(5, what, measured.exponent);
        }
    }
    Ok(())
}
