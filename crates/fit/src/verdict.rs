//! Which formulation films support.

use deltaq::{CHETAEV, Choice};
use equations::Formulation;

use crate::question::is_law;
use crate::{Fit, FitError, Identifiability, Problem};

/// A formulation is excluded where its χ² is this much above the least.
pub const EXCLUDED: f64 = 15.0;

/// The verdict of films on a formulation.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It fits, and all others are excluded, by the least χ² that was found of each.
    Supported,
    /// Its χ² is above the least by the square of this.
    Excluded {
        /// `√(χ² − least χ²)`.
        sigmas: f64,
    },
    /// It fits, and so do these, or they could not be fitted.
    CannotTell {
        /// Labels of the others.
        from: Vec<String>,
        /// Factor by which a film has to be longer, at least, to exclude this formulation if one of these is
        /// right; `None` where up to 8 times the length do not suffice. See
        /// [`fit_formulations`](crate::fit_formulations).
        needs: Vec<Option<f64>>,
    },
    /// Tests on residuals reject every formulation that is not excluded: something else is wrong.
    None,
    /// It could not be fitted.
    NotFitted(FitError),
}

/// A formulation with its fit and verdict.
#[derive(Clone)]
pub struct Row {
    /// The formulation, removal and constants that were fitted.
    pub choice: Choice,
    /// The fit.
    pub fit: Result<Fit, FitError>,
    /// Whether such films can show its unknowns at all; `None` where this cannot be computed.
    pub shown: Option<Identifiability>,
    /// The problem that was fitted, for further evaluations; its unknowns are the first of
    /// [`Fit::estimates`].
    pub problem: Option<Problem>,
    /// The verdict.
    pub verdict: Verdict,
}

/// Verdicts on fits of formulations to the same films.
pub fn verdicts(fits: Vec<(Choice, Result<Fit, FitError>)>) -> Vec<Row> {
    let fitted = || fits.iter().filter_map(|(_, fit)| fit.as_ref().ok());
    let of = |fit: &Fit| (fit.chi_squared, fit.objections().next().is_some());
    let least = fitted().map(of).min_by(|a, b| a.0.total_cmp(&b.0));
    // one that fits, and that the least does not exclude
    let fine = fitted().map(of).any(|(x, objects)| !objects && least.is_some_and(|(least, _)| x - least < EXCLUDED));
    let least = least.map(|(least, _)| (least, !fine));
    let is_open = |fit: &Result<Fit, FitError>| match (fit, least) {
        (Ok(fit), Some((least, _))) => fit.chi_squared - least < EXCLUDED,
        _ => true,
    };
    let open: Vec<(String, &'static Formulation)> = fits
        .iter()
        .filter(|(_, fit)| is_open(fit))
        .map(|(choice, _)| (choice.label.clone(), choice.formulation))
        .collect();
    let verdict = |(choice, fit): &(Choice, Result<Fit, FitError>)| match (fit, least) {
        (Err(error), _) => Verdict::NotFitted(error.clone()),
        (_, Some((_, true)) | None) => Verdict::None,
        (Ok(fit), Some((least, false))) => {
            let above = fit.chi_squared - least;
            if above >= EXCLUDED {
                return Verdict::Excluded { sigmas: above.sqrt() };
            }
            let others = open.iter().filter(|(label, f)| *label != choice.label && !is_part(choice.formulation, f));
            let from: Vec<String> = others.map(|(label, _)| label.clone()).collect();
            if from.is_empty() {
                Verdict::Supported
            } else {
                Verdict::CannotTell { needs: vec![None; from.len()], from }
            }
        }
    };
    let verdicts: Vec<Verdict> = fits.iter().map(verdict).collect();
    fits.into_iter()
        .zip(verdicts)
        .map(|((choice, fit), verdict)| Row { choice, fit, shown: None, problem: None, verdict })
        .collect()
}

/// Whether one of two formulations is the other with more numbers, so that both can be right: Chetaev's law
/// is that of first order with ε = 0.
fn is_part(a: &Formulation, b: &Formulation) -> bool {
    let is = |x: &Formulation, y: &Formulation| x.name == y.name;
    is(a, b) || (is_law(a) && is(b, CHETAEV)) || (is(a, CHETAEV) && is_law(b)) || (is_law(a) && is_law(b))
}
