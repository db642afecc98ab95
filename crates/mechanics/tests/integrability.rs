//! Frobenius' verdict on constraints whose integrability is known by construction.

use mechanics::{Integrability, RemovalError, Undecided, integrability};

use crate::systems;

#[track_caller]
fn verdict(coordinates: &[&str], constraints: &[&str]) -> Integrability {
    let (system, state) = systems::kinetic(coordinates, &[("a", 0.7), ("Omega", 1.3)], constraints);
    integrability(&system, &state, 3.0).unwrap_or_else(|e| panic!("{constraints:?}: {e}"))
}

#[track_caller]
fn must_be_integrable(coordinates: &[&str], constraints: &[&str]) {
    let verdict = verdict(coordinates, constraints);
    assert!(matches!(verdict, Integrability::Integrable { .. }), "{constraints:?}: {verdict}");
    assert!(verdict.is_integrable());
}

#[track_caller]
fn must_be_nonintegrable(coordinates: &[&str], constraints: &[&str], depth: usize) {
    let verdict = verdict(coordinates, constraints);
    assert_eq!(verdict, Integrability::Nonintegrable { depth }, "{constraints:?}: {verdict}");
    assert!(!verdict.is_integrable());
}

#[test]
fn no_constraint() {
    assert_eq!(verdict(&["x", "y"], &[]), Integrability::Unconstrained);
    assert!(Integrability::Unconstrained.is_integrable());
}

#[test]
fn nonintegrable_constraints_with_the_depth_of_their_brackets() {
    must_be_nonintegrable(&["x", "y", "phi"], &["y'*cos(phi) - x'*sin(phi)"], 1);
    must_be_nonintegrable(&["x", "y", "z"], &["z' - (x*y' - y*x')/2"], 1);
    // the dimension grows 2, 3, 4
    must_be_nonintegrable(&["x", "y", "psi", "phi"], &["x' - a*psi'*cos(phi)", "y' - a*psi'*sin(phi)"], 2);
    // a chain: 2, 3, 4, 5
    must_be_nonintegrable(&["x", "y", "z", "w", "s"], &["y' - z*x'", "z' - w*x'", "w' - s*x'"], 3);
    // Martinet: the first bracket vanishes only where x = 0
    must_be_nonintegrable(&["x", "y", "z"], &["z' - x^2*y'"], 1);
}

#[test]
fn total_derivatives_are_integrable() {
    must_be_integrable(&["x", "y"], &["2*x*x' + 2*y*y'"]);
    must_be_integrable(&["x", "y", "z"], &["x*x' + y*y' + z*z'"]);
    must_be_integrable(&["x", "y", "z"], &["z' - cos(x)*x'*exp(y) - sin(x)*exp(y)*y'"]);
    // with an integrating factor
    must_be_integrable(&["x", "y", "z"], &["y*z*x' + x*z*y' + 2*x*y*z'"]);
    must_be_integrable(&["x", "y", "z"], &["(1 + x^2)*(z' - y*x' - x*y')"]);
}

#[test]
fn a_parameter_is_its_formula_and_a_rounded_number_nothing_exact() {
    // `a` has the value of its formula, or another since
    let form = |a: &str, value: Option<f64>, b: f64| {
        let (mut system, state) =
            systems::kinetic(&["x", "y", "z"], &[("a", 0.0), ("b", b)], &["z' - a*x*y' - b*y*x'"]);
        let formula = system.expression(a).expect("a formula");
        let own = system.graph.evaluate(formula, &Default::default()).expect("a number");
        system.parameters[0].value = value.unwrap_or(own);
        system.parameters[0].formula = Some(formula);
        integrability(&system, &state, 3.0).expect("a verdict")
    };
    let exactly = Integrability::Integrable { exact: true };
    assert_eq!(form("sqrt(2)*sqrt(3)/sqrt(6)", None, 1.0), exactly);
    assert_eq!(form("sqrt(2)*sqrt(3)/sqrt(6)", Some(0.5), 0.5), exactly);
    assert_eq!(form("sqrt(2)*sqrt(3)/sqrt(6)", Some(0.5), 1.0), Integrability::Nonintegrable { depth: 1 });
    assert_eq!(form("1 + 1/100000000000000000", None, 1.0), Integrability::Nonintegrable { depth: 1 });
    // of unknown digits, or with more than are held
    let open = Integrability::Undecided { why: Undecided::AtPoints, depth: 0, at_most: 1, constraints: 1 };
    assert_eq!(form("1 + log(4) - 2*log(2)", None, 1.0), open);
    assert_eq!(verdict(&["x", "y", "z"], &["z' - 12345678901234567890123*x*y' - 12345678901234567890122*y*x'"]), open);
    assert_eq!(verdict(&["x", "y", "z"], &["z' - 12345678901234567890123*x*y' - 12345678901234567890123*y*x'"]), open);
}

/// `d/dt(xy + z)` and `d/dt(w − x²)`.
const FIRST: &str = "(x'*y + x*y' + z')";
const SECOND: &str = "(w' - 2*x*x')";

#[test]
fn integrable_constraints_are_found_behind_a_recombination() {
    let coordinates = ["x", "y", "z", "w"];
    must_be_integrable(&coordinates, &[FIRST, SECOND]);
    let one = format!("cos(y)*{FIRST} + (1 + x^2)*{SECOND}");
    let two = format!("exp(x)*{SECOND} - z*{FIRST}");
    must_be_integrable(&coordinates, &[&one, &two]);
}

#[test]
fn one_integrable_combination_of_two() {
    let coordinates = ["x", "y", "z", "w"];
    let partly = Integrability::PartlyIntegrable { integrals: 1, constraints: 2, exact: true };
    assert_eq!(verdict(&coordinates, &["w' - x*x'", "z' - y*x'"]), partly);
    assert!(!partly.is_integrable());
    // brackets that add nothing at points are not zero: ranks over a finite field have the word
    let open = Integrability::Undecided { why: Undecided::AtPoints, depth: 1, at_most: 1, constraints: 2 };
    let hidden = ["cos(y)*(w' - x*x') + x*(z' - y*x')", "2*(z' - y*x') - w*(w' - x*x')"];
    assert_eq!(verdict(&coordinates, &hidden), open);
}

#[test]
fn affine_constraints_are_judged_in_space_and_time() {
    // d/dt(z − xy − sin t)
    must_be_integrable(&["x", "y", "z"], &["z' - x'*y - x*y' - cos(t)"]);
    must_be_integrable(&["x", "y"], &["x*x' + y*y' - t"]);
    // linear part integrable, the whole not
    must_be_nonintegrable(&["x", "y", "z"], &["z' - a*y"], 1);
    must_be_nonintegrable(&["x", "y"], &["y' - x*t"], 1);
    // a turning table under a ball, Euler angles z-x-z
    let table = [
        "x' - a*(theta'*sin(psi) - phi'*sin(theta)*cos(psi)) + Omega*y",
        "y' + a*(theta'*cos(psi) + phi'*sin(theta)*sin(psi)) - Omega*x",
    ];
    must_be_nonintegrable(&["x", "y", "psi", "theta", "phi"], &table, 1);
}

#[test]
fn one_direction_left_is_always_integrable() {
    must_be_integrable(&["x", "y"], &["y' - x*y*x'"]);
    must_be_integrable(&["x", "y", "z"], &["z' - y*x'", "y' - (x + z^2)*x'"]);
    // but not where time drives it as well
    let verdict = verdict(&["x", "y"], &["y' - sin(x)"]);
    assert_eq!(verdict, Integrability::Nonintegrable { depth: 1 });
}

#[test]
fn the_test_does_not_apply_to_nonlinear_constraints() {
    let found = verdict(&["x", "y", "z"], &["z'^2 - a^2*(x'^2 + y'^2)"]);
    assert_eq!(found, Integrability::NonlinearInVelocity);
    assert!(!found.is_integrable());
}

#[test]
fn dependent_constraints_are_refused() {
    let (system, state) = systems::kinetic(&["x", "y", "z"], &[], &["z' - y*x'", "2*z' - 2*y*x'"]);
    let error = integrability(&system, &state, 3.0).unwrap_err();
    assert!(matches!(error, RemovalError::Dependent { pivot, limit } if pivot < limit), "{error}");
}

/// A car with `n` trailers, each with place and heading: 2n hitches are integrable, n + 1 axles are not. To
/// each hitch its own axle can be added.
fn train(n: usize, with_axles: bool) -> Integrability {
    let coordinates: Vec<String> = (0..=n).flat_map(|i| ["x", "y", "theta"].map(|name| format!("{name}{i}"))).collect();
    let axle = |i: usize| format!("y{i}'*cos(theta{i}) - x{i}'*sin(theta{i})");
    let hitches = (1..=n).flat_map(|i| {
        let front = i - 1;
        let hitch = [("x", "-", "sin"), ("y", "+", "cos")];
        hitch.map(|(c, sign, f)| {
            let hitch = format!("{c}{i}' - {c}{front}' {sign} a*theta{i}'*{f}(theta{i})");
            if with_axles { format!("{hitch} + {}", axle(i)) } else { hitch }
        })
    });
    let constraints: Vec<String> = (0..=n).map(axle).chain(hitches).collect();
    verdict(
        &coordinates.iter().map(|c| &c[..]).collect::<Vec<_>>(),
        &constraints.iter().map(|f| &f[..]).collect::<Vec<_>>(),
    )
}

#[test]
fn hitches_of_a_train_are_integrable_and_axles_are_not() {
    for n in 1..=4 {
        let partly = Integrability::PartlyIntegrable { integrals: 2 * n, constraints: 3 * n + 1, exact: true };
        assert_eq!(train(n, false), partly);
    }
}

#[test]
fn long_brackets_in_which_much_cancels_do_not_raise_the_rank() {
    for n in 1..=2 {
        let Integrability::Undecided { why: Undecided::AtPoints, at_most, constraints, .. } = train(n, true) else {
            panic!("{}", train(n, true))
        };
        assert_eq!([at_most, constraints], [2 * n, 3 * n + 1]);
    }
}

#[test]
fn brackets_that_are_too_long_leave_it_undecided() {
    let found = train(5, false);
    let Integrability::Undecided { why: Undecided::TooLong, depth, at_most, constraints } = found else {
        panic!("{found}")
    };
    assert!(depth >= 3 && at_most >= 10 && constraints == 16, "{depth}, {at_most}, {constraints}");
    assert!(!found.is_integrable());
}

/// What is left without exact constraints of `q = 1, 2, …`, `v = 0.1, 0.2, …`: names, constraints, places.
#[track_caller]
fn left(coordinates: &[&str], constraints: &[&str]) -> (Vec<String>, Vec<String>, Vec<f64>) {
    let (system, mut state) = systems::kinetic(coordinates, &[("a", 0.7), ("zero", 0.0)], constraints);
    state.q.iter_mut().zip(1..).for_each(|(q, i)| *q = f64::from(i));
    let (rest, state) = system.without_exact_constraints(&state).unwrap_or_else(|e| panic!("{constraints:?}: {e}"));
    assert_eq!(rest.forces.len(), rest.coordinates.len());
    assert_eq!(state.v.len(), rest.coordinates.len());
    let names = rest.coordinates.iter().map(|c| c.name.clone()).collect();
    (names, rest.constraints.iter().map(|&f| rest.graph.plain(f)).collect(), state.q)
}

#[test]
fn an_exact_constraint_goes_with_a_coordinate_that_stands_nowhere() {
    let xyz = ["x", "y", "z"];
    let found = left(&xyz, &["a*x' - cos(t)*z' + z*sin(t)", "y' - z*x'"]);
    assert_eq!(found.0, ["y", "z"]);
    assert_eq!(found.2, [2.0, 3.0]);
    assert_eq!(found.1.len(), 1);
    // the second is exact once the first is in it
    assert_eq!(left(&xyz, &["x' - y*y'", "z' + y*x' - y^2*y'"]).1, Vec::<String>::new());
}

#[test]
fn what_is_not_exact_for_certain_stays() {
    for stays in [
        // no total derivative
        "x' - y*z'",
        "x' - y*cos(t)",
        "x' - cos(t)*z'",
        // its coordinates stand in it
        "x*y' + y*x' + cos(z)*z'",
        "x' + x",
        // its coefficient is zero, or may be
        "zero*x' - y*y'",
        "a*cos(y)*x' - y*z'",
    ] {
        let found = left(&["x", "y", "z"], &[stays]);
        assert_eq!((found.0.len(), found.1.len()), (3, 1), "{stays}: {found:?}");
    }
    // x stands in the other one
    assert_eq!(left(&["x", "y", "z", "w"], &["x' - y*y'", "z' - x*w'"]).1.len(), 2);
}

/// Integrals that exact constraints hide behind `y`: without `x' = y y'` the other is `z' = y² y'`.
#[test]
fn exact_constraints_are_counted_with_the_others() {
    must_be_integrable(&["x", "y", "z"], &["x' - y*y'", "z' - y*x'"]);
    must_be_integrable(&["x", "y", "z"], &["x' - y*y' - cos(t)", "z' - t"]);
    let partly = Integrability::PartlyIntegrable { integrals: 1, constraints: 2, exact: true };
    assert_eq!(verdict(&["x", "y", "z"], &["x' - y*y' - cos(t)", "z' - sin(y)"]), partly);
}

#[test]
fn dependent_exact_constraints_are_refused() {
    let (system, state) = systems::kinetic(&["x", "y", "z"], &[], &["z' - x'", "2*z' - 2*x'"]);
    let error = integrability(&system, &state, 3.0).unwrap_err();
    assert!(matches!(error, RemovalError::Dependent { pivot, limit } if pivot < limit), "{error}");
}

#[test]
fn what_begins_elsewhere_is_not_called_integrable() {
    let begins = ["(1 + tanh(40*(x - 9)))/2", "exp(-(x - 30)^2)", "(1 + tanh(4*(t - 8)))/2"];
    for f in begins {
        let found = verdict(&["x", "y", "z"], &[&format!("z' - y*{f}*x'")]);
        assert!(!found.is_integrable(), "{f}: {found}");
    }
}

#[test]
fn no_value_at_any_point_is_no_rank() {
    // nothing is negative but under the first root
    let found = verdict(&["x", "y", "z"], &["z' - (sqrt(x) + sqrt(a))*y'"]);
    assert_eq!(found, Integrability::Nonintegrable { depth: 1 });
    // in the domain at none of six points on either side of zero
    for roots in ["sqrt(x) + sqrt(a) + sqrt(b)", "sqrt(x) + sqrt(-a) + sqrt(b)", "sqrt(x) + sqrt(a) + sqrt(1 - a)"] {
        let found = verdict(&["x", "y", "z", "a", "b"], &[&format!("z' - ({roots})*y'")]);
        assert!(!found.is_integrable(), "{roots}: {found}");
    }
    let nowhere = verdict(&["x", "y", "z"], &["z' - sqrt(x - 200)*y'"]);
    assert!(!nowhere.is_integrable(), "{nowhere}");
}

#[test]
fn small_coefficients_are_no_round_off() {
    for small in ["1e-7", "1e-15", "1e-30", "1e-150"] {
        must_be_nonintegrable(&["x", "y", "z"], &[&format!("z' - {small}*y*x'")], 1);
        must_be_nonintegrable(&["x", "y", "z"], &[&format!("{small}*z' - y*x'")], 1);
    }
    must_be_nonintegrable(&["x", "y", "psi", "phi"], &["x' - 5e8*psi'*cos(phi)", "y' - 5e8*psi'*sin(phi)"], 2);
}
