//! `[start]`: `equations`.

use mechanics::StartError;
use scene::{Scene, SceneError, SceneErrorKind};

/// A ball of radius 1 that rolls on a table, by angles that turn about the axes of space and of the body.
const BALL: &str = r#"
title = "ball"
[parameters]
spin = 5
[coordinates]
x = { start = 0 }
y = { start = 0 }
psi = { start = 0.3 }
theta = { start = 0.7 }
phi = { start = 0.2 }
[definitions]
R = "rotation(zxz, psi, theta, phi)"
W = "angular_velocity(R)"
n = "[0, 0, 1]"
[system]
lagrangian = "(x'^2 + y'^2)/2 + dot(W, W)/5"
constraints = ["x' - W.y", "y' + W.x"]
[start]
EQUATIONS
[start.velocities]
GIVEN
[run]
duration = 1
"#;

fn ball(equations: &str, given: &str) -> Result<Scene, SceneError> {
    ball_with(equations, given, &[])
}

fn ball_with(equations: &str, given: &str, overrides: &[(String, f64)]) -> Result<Scene, SceneError> {
    let text = BALL.replace("EQUATIONS", equations).replace("GIVEN", given);
    Scene::parse_with("ball", &text, overrides)
}

fn refused(equations: &str, given: &str) -> (StartError, String) {
    let error = ball(equations, given).expect_err("no start");
    let told = error.to_string();
    let SceneErrorKind::Start(error) = *error.kind else { panic!("{told}") };
    (error, told)
}

/// `W` by hand: of turns about z, the line of nodes, and the axis of the figure.
fn angular_velocity(scene: &Scene) -> [f64; 3] {
    let [.., psi, theta, _] = scene.start.q[..] else { unreachable!() };
    let [.., by_psi, by_theta, by_phi] = scene.start.v[..] else { unreachable!() };
    [
        by_theta * psi.cos() + by_phi * theta.sin() * psi.sin(),
        by_theta * psi.sin() - by_phi * theta.sin() * psi.cos(),
        by_psi + by_phi * theta.cos(),
    ]
}

#[test]
fn velocities_follow_from_equations() {
    // one of three by the name of a parameter, a vector by components, and the form that constraints have
    for (equations, expected) in [
        ("equations = [\"dot(W, n) = spin\"]", [0.4, 0.2, 5.0]),
        ("equations = [\"W - [0.4, 0, 5] = [0, 0.2, 0]\"]", [0.4, 0.2, 5.0]),
        ("equations = [\"cross(W, n) = 0\", \"W.z - 2*spin\"]", [0.0, 0.0, 10.0]),
    ] {
        let given = if equations.contains("dot") { "\"x'\" = 0.2\n\"y'\" = -0.4" } else { "" };
        let scene = ball(equations, given).unwrap_or_else(|e| panic!("{e}"));
        let found = angular_velocity(&scene);
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{equations}: {found:?}");
        assert!((scene.start.v[0] - expected[1]).abs() < 1e-14 && (scene.start.v[1] + expected[0]).abs() < 1e-14);
        assert!(scene.completion.residual < 1e-10);
        let written = Scene::parse("written", &scene.to_toml()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((written.start, written.completion.equations.len()), (scene.start, 0));
    }
}

#[test]
fn other_numbers_are_completed_alike() {
    let (equations, given) = ("equations = [\"dot(W, n) = spin\", \"norm(W) = 2*spin + x\"]", "\"x'\" = 0.2");
    let near = "guess = { \"y'\" = 3, \"psi'\" = 1, \"theta'\" = 1, \"phi'\" = 1 }";
    let (equations, names) = (format!("{equations}\n{near}"), ["spin", "x", "x'", "theta"]);
    let scene = ball(&equations, given).unwrap_or_else(|e| panic!("{e}"));
    let mut starts = scene.starts(&names).unwrap_or_else(|e| panic!("{e}"));
    for row in [[5.0, 0.0, 0.2, 0.7], [3.0, 0.1, -0.3, 0.9], [4.0, -0.5, 1.0, 0.4]] {
        let overrides: Vec<_> = names.iter().map(|name| name.to_string()).zip(row).collect();
        let read = ball_with(&equations, given, &overrides).unwrap_or_else(|e| panic!("{e}"));
        let found = starts.at(&row).unwrap_or_else(|e| panic!("{e}"));
        let pairs = found.state.v.iter().zip(&read.start.v);
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}, {:?}", read.start);
        let w = angular_velocity(&read);
        let size = w.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((w[2] - row[0]).abs() < 1e-12 && (size - 2.0 * row[0] - row[1]).abs() < 1e-12, "{w:?}");
    }
    let error = starts.at(&[0.01, 0.0, 3.0, 0.7]).expect_err("too slow");
    assert!(matches!(error, SceneErrorKind::Start(StartError::ContradictoryEquation { equation: 2, .. })), "{error}");
}

#[test]
fn an_equation_may_be_in_rates_of_a_removal() {
    let text = include_str!("../../scene/scenes/sledge.toml");
    let start = text.find("[start").expect("a start");
    let removal = text.find("[removal").expect("a removal");
    let given = "[start]\nequations = [\"phi' = 2 + 1.8*(x'*cos(phi) + y'*sin(phi))\"]\nvelocities = { \"u'\" = -0.5 }";
    let text = format!("{}{given}\n{}", &text[..start], &text[removal..]);
    let scene = Scene::parse("sledge", &text).unwrap_or_else(|e| panic!("{e}"));
    let expected = [-0.5 * f64::cos(0.3), -0.5 * f64::sin(0.3), 1.1];
    assert!(scene.start.v.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{:?}", scene.start);
}

#[test]
fn what_is_wrong_with_an_equation_is_said() {
    let all = "\"x'\" = 0.2\n\"y'\" = -0.4";
    // of two that exclude each other the second, with what it comes to where the first holds
    let (error, told) = refused("equations = [\"dot(W, n) = 5\", \"2*W.z = 6\"]", all);
    let StartError::ContradictoryEquation { equation: 2, value, residual, limit } = error else { panic!("{told}") };
    assert!((value - 4.0).abs() < 1e-13 && residual > limit, "{told}");
    assert!(told.starts_with("ball:19:31: start equation 2 contradicts") && told.contains("4.0000e0"), "{told}");
    // one that the given velocities exclude
    let (error, told) = refused("equations = [\"W.y = 0.5\", \"W.z = 1\"]", all);
    let StartError::ContradictoryEquation { equation: 1, value, .. } = error else { panic!("{told}") };
    assert!((value + 0.3).abs() < 1e-14, "{told}");
    // no real solution
    let (error, told) = refused("equations = [\"dot(W, W) = 0.1\"]", all);
    assert!(matches!(error, StartError::ContradictoryEquation { equation: 1, value, .. } if value > 0.09), "{told}");
    // constraints that are at fault themselves are blamed
    let (error, told) =
        refused("equations = [\"W.z = 1\"]", "\"x'\" = 0.2\n\"theta'\" = 0\n\"phi'\" = 0\n\"psi'\" = 1");
    assert!(matches!(error, StartError::Contradictory { constraint: 1, .. }), "{told}");
    // too few: one that follows from what is there adds nothing
    let (error, told) = refused("equations = [\"W.y = 0.2\"]", all);
    assert_eq!(error, StartError::Undetermined { velocities: vec!["psi'".into()], idle: vec![1] });
    assert!(told.contains("start equation 1 follows from the others") && told.contains("equations = ["), "{told}");
    let (error, told) = refused("equations = [\"dot(W, W) = 25\"]", all);
    assert!(matches!(error, StartError::Ambiguous { .. }), "{told}");
    let (error, told) = refused("project = true\nequations = [\"W.z = 1\"]", all);
    assert!(error == StartError::ProjectedEquations && told.starts_with("ball:19:1:"), "{told}");
    // one that holds anyway does no harm, as a velocity too many does none
    let scene = ball("equations = [\"W.y = 0.2\", \"W.z = 5\"]", all).unwrap_or_else(|e| panic!("{e}"));
    assert!((angular_velocity(&scene)[2] - 5.0).abs() < 1e-14);
}

#[test]
fn what_is_wrong_in_the_text_is_said_all_at_once() {
    let error = ball("equations = [\"W = 5\", \"x = 1\", \"u' = 1\", \"W.z == 1\", 3]", "").expect_err("faults");
    let kinds: Vec<String> = error.each().map(|fault| fault.to_string()).collect();
    let words =
        ["3 components, the right side 1", "start equation 2 contains no velocity", "u'", "", "an equation in quotes"];
    assert!(kinds.len() == 5 && kinds.iter().zip(words).all(|(kind, words)| kind.contains(words)), "{kinds:#?}");
    let error = ball("equations = \"W.z = 1\"", "").expect_err("no list").to_string();
    assert!(error.contains("expected an array of equations"), "{error}");
}
