//! Which formulation films support.

use equations::Formulation;
use motion::{CHETAEV, Choice};

use crate::distribution::{sigmas, threshold};
use crate::question::is_law;
use crate::{Fit, FitError, Identifiability, Problem};

/// The significance to one digit, downwards; beyond 100 nobody can tell.
pub fn significance(sigmas: f64) -> String {
    if sigmas >= 100.0 {
        return "over 100 σ".into();
    }
    let unit = if sigmas >= 10.0 { 10.0 } else { 1.0 };
    format!("over {} σ", (sigmas / unit).floor() * unit)
}

/// The verdict of films on a formulation.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It fits, and all others are excluded, by the least χ² that was found of each.
    Supported,
    /// Its χ² is above the least by this.
    Excluded {
        /// In standard deviations of a normal distribution.
        sigmas: f64,
    },
    /// It would be excluded, if the least of its χ² that was found were its least: too few starts reach it.
    Unsettled {
        /// As of an exclusion.
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
    /// It fits with what is not modelled, or what it would exclude does or has not settled.
    Explained {
        /// What it is with.
        with: Option<String>,
        /// What these films cannot tell it from.
        from: Vec<String>,
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
    /// What else has to be known of the verdict, in words.
    pub notes: Vec<String>,
}

/// What is shown, beside a fit: what ranks at random numbers do not show and the fit does, is open.
pub(crate) fn beside(shown: Identifiability, fit: Option<&Fit>) -> Identifiability {
    let Identifiability::Hidden { combinations, order } = &shown else { return shown };
    let is_shown =
        |name: &String| fit.is_some_and(|fit| fit.estimates.iter().any(|e| e.name == *name && e.error.is_finite()));
    match combinations.iter().find(|names| names.iter().all(is_shown)) {
        None => shown,
        Some(names) => {
            let names = names.join(" with ");
            Identifiability::Open(format!("derivatives to order {order} do not show {names}, and these films do"))
        }
    }
}

/// How far a fit's χ² is above the least, and how many unknowns the other has more.
pub(crate) fn above(fit: &Fit, least: &Fit) -> (f64, usize) {
    (fit.chi_squared - least.chi_squared, fit.freedom.saturating_sub(least.freedom).max(1))
}

/// Whether a formulation of this fit is excluded beside that of the other.
pub(crate) fn is_excluded(fit: &Fit, least: &Fit) -> bool {
    let (above, more) = above(fit, least);
    above >= threshold(more)
}

/// The fit of least χ².
pub(crate) fn least<'a>(fits: impl Iterator<Item = &'a Fit>) -> Option<&'a Fit> {
    fits.min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared))
}

/// Verdicts on fits of formulations to the same films.
pub fn verdicts(fits: Vec<(Choice, Result<Fit, FitError>)>) -> Vec<Row> {
    let fitted = || fits.iter().filter_map(|(_, fit)| fit.as_ref().ok());
    let least = least(fitted()).cloned();
    // one that fits, and that the least does not exclude
    let fine = |fit: &Fit, least: &Fit| fit.faults().next().is_none() && !is_excluded(fit, least);
    let fine = least.as_ref().is_some_and(|least| fitted().any(|fit| fine(fit, least)));
    let is_open = |fit: &Result<Fit, FitError>| match (fit, &least) {
        (Ok(fit), Some(least)) => !is_excluded(fit, least),
        _ => true,
    };
    let open: Vec<(String, &'static Formulation)> = fits
        .iter()
        .filter(|(_, fit)| is_open(fit))
        .map(|(choice, _)| (choice.label.clone(), choice.formulation))
        .collect();
    let verdict = |(choice, fit): &(Choice, Result<Fit, FitError>)| match (fit, &least) {
        (Err(error), _) => Verdict::NotFitted(error.clone()),
        (Ok(fit), Some(least)) if fine => {
            if is_excluded(fit, least) {
                let (above, more) = above(fit, least);
                return Verdict::Excluded { sigmas: sigmas(above, more) };
            }
            let others = open.iter().filter(|(label, f)| *label != choice.label && !is_part(choice.formulation, f));
            let from: Vec<String> = others.map(|(label, _)| label.clone()).collect();
            if from.is_empty() {
                Verdict::Supported
            } else {
                Verdict::CannotTell { needs: vec![None; from.len()], from }
            }
        }
        _ => Verdict::None,
    };
    let verdicts: Vec<Verdict> = fits.iter().map(verdict).collect();
    let row = |((choice, fit), verdict)| Row { choice, fit, shown: None, problem: None, verdict, notes: Vec::new() };
    fits.into_iter().zip(verdicts).map(row).collect()
}

/// Whether one of two formulations is the other with more numbers, so that both can be right: Chetaev's law
/// is that of first order with ε = 0.
fn is_part(a: &Formulation, b: &Formulation) -> bool {
    let is = |x: &Formulation, y: &Formulation| x.name == y.name;
    is(a, b) || (is_law(a) && is(b, CHETAEV)) || (is(a, CHETAEV) && is_law(b)) || (is_law(a) && is_law(b))
}
