//! Equations of `L`, `f` and `q` without a scene file.

use motion::{EquationStyle, SolveError, equations_of, equations_text};

#[test]
fn equations_of_formulas_are_those_of_the_scene_with_them() {
    let text = equations_text(
        &equations_of("3*(x'^2 + y'^2)/2", &["x*x' + y*y'"], &["x", "y"]).unwrap(),
        EquationStyle::Plain,
    );
    assert!(text.contains("3*x'' - x*lambda_1 = 0") && text.contains("3*y'' - y*lambda_1 = 0"), "{text}");
}

#[test]
fn what_cannot_be_read_is_named_with_its_place() {
    let wrong = [
        ("x'^2 + k*x", &["x'"][..], &["x"][..], "k"),
        ("x'^2", &["y'"], &["x"], "y'"),
        ("x'^2", &[], &["x", "x"], "x"),
        ("x'^2", &[], &["x y"], "x y"),
        ("x'^2 +", &[], &["x"], "ends where"),
        ("0", &[], &[], "coordinate"),
    ];
    for (lagrangian, constraints, coordinates, named) in wrong {
        let Err(error) = equations_of(lagrangian, constraints, coordinates) else { panic!("{lagrangian} is accepted") };
        assert!(matches!(error, SolveError::Scene(_) | SolveError::Formula(_)), "{error}");
        assert!(error.to_string().contains(named), "{lagrangian}, {coordinates:?}: {error}");
    }
}
