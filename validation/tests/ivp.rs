//! Problems of the Test Set for IVP Solvers against the referee, and the referee against what is printed.

use integrate::Method;
use validation::ivp::{Errors, problems};

/// Largest errors of coordinates and multipliers at the tolerance of 1e-10.
const LIMITS: [(&str, f64, f64); 4] =
    [("car-axis", 1e-13, 1e-14), ("andrews", 1e-11, 1e-9), ("fekete", 1e-11, 1e-11), ("pleiades", 1e-10, 0.0)];

#[test]
fn ends_are_those_of_the_referee() {
    for problem in problems().expect("the tables") {
        let (_, coordinates, multipliers) = LIMITS.into_iter().find(|limit| limit.0 == problem.name).expect("a limit");
        let methods = if problem.name == "andrews" { vec![None, Some(Method::Dop853)] } else { vec![None] };
        for method in methods {
            let point = problem.measure(1e-10, method).expect("a scene");
            let errors = point.errors.unwrap_or_else(|reason| panic!("{}: {reason}", problem.name));
            assert!(errors.coordinates <= coordinates, "{}: {errors:?}", problem.name);
            assert!(errors.coordinates <= point.estimate, "{}: {errors:?}, estimate {}", problem.name, point.estimate);
            assert!(errors.multipliers.unwrap_or(0.0) <= multipliers, "{}: {errors:?}", problem.name);
            assert!(problem.gap <= coordinates, "{}: the referee's own gap is {:.1e}", problem.name, problem.gap);
        }
    }
}

/// What is printed agrees with the referee as far as it can be trusted, and no further: the page says so.
#[test]
fn printed_ends_are_off_by_what_the_page_says() {
    let known = |name: &str, which: usize| -> Errors {
        let problem =
            problems().expect("the tables").into_iter().find(|problem| problem.name == name).expect("a problem");
        problem.errors(&problem.printed[which].values)
    };
    let between =
        |x: f64, low: f64, high: f64| assert!(low <= x && x <= high, "{x:.3e} is not in [{low:.0e}, {high:.0e}]");
    between(known("car-axis", 0).coordinates, 3e-13, 4e-13);
    between(known("car-axis", 0).multipliers.expect("multipliers"), 1e-10, 3e-10);
    between(known("car-axis", 1).coordinates, 1e-13, 2e-13);
    between(known("andrews", 0).coordinates, 1e-9, 2e-9);
    between(known("andrews", 0).multipliers.expect("multipliers"), 1e-5, 2e-5);
    between(known("fekete", 0).coordinates, 2e-12, 3e-12);
    between(known("pleiades", 0).coordinates, 1e-15, 1e-13);
}
