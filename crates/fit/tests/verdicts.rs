//! Verdicts on formulations, from their fits.

use fit::{Fit, FitError, ResidualTest, Verdict, verdicts};
use mechanics::ConstantsRule;
use motion::{CHETAEV, Choice, VAKONOMIC};

fn fitted(chi_squared: f64) -> Result<Fit, FitError> {
    Ok(Fit {
        estimates: Vec::new(),
        chi_squared,
        freedom: 10,
        bic: chi_squared,
        hidden: Vec::new(),
        tests: Vec::new(),
        minima: vec![chi_squared],
        starts: 1,
        reached: 1,
        by_half: chi_squared,
        excluded_by: None,
        residuals: Vec::new(),
    })
}

fn choice(formulation: &'static equations::Formulation) -> Choice {
    Choice { label: formulation.title.into(), formulation, removal: None, constants: ConstantsRule::Zero }
}

/// What could not be fitted is not excluded: nothing is supported beside it.
#[test]
fn a_formulation_is_supported_where_all_others_are_excluded() {
    let first = |other: Result<Fit, FitError>| {
        verdicts(vec![(choice(CHETAEV), fitted(9.0)), (choice(VAKONOMIC), other)])[0].verdict.clone()
    };
    let cannot = Verdict::CannotTell { from: vec![VAKONOMIC.title.into()], needs: vec![None] };
    assert_eq!(first(fitted(24.0)), Verdict::Supported);
    assert_eq!(first(fitted(23.9)), cannot);
    assert_eq!(first(Err(FitError::ShowsNothing)), cannot);
}

/// A rival that is objected to takes no verdict away from one that fits, and that it does not exclude.
#[test]
fn objections_count_where_nothing_fits_as_well() {
    let objected = |chi_squared: f64| {
        let test =
            ResidualTest { name: "runs of x".into(), found: 1.0, expected: 9.0, probability: 0.0, objects: true };
        Ok(Fit { tests: vec![test], ..fitted(chi_squared).unwrap() })
    };
    let second = |other: Result<Fit, FitError>| {
        verdicts(vec![(choice(CHETAEV), other), (choice(VAKONOMIC), fitted(14.0))])[1].verdict.clone()
    };
    let cannot = Verdict::CannotTell { from: vec![CHETAEV.title.into()], needs: vec![None] };
    assert_eq!(second(objected(9.0)), cannot);
    assert_eq!(second(objected(-2.0)), Verdict::None);
}
