//! What a motion says of its own errors, coordinate by coordinate.

use deltaq::{ErrorEstimate, Settings, choices, error_estimates, setting, solve_choice};
use integrate::Method;
use scene::Scene;

/// The estimates at `times` and of the whole motion, with z at these times; z is a swing of frequency 40 with
/// hardly any inertia.
fn swing(settings: &Settings, times: &[f64]) -> (Vec<ErrorEstimate>, ErrorEstimate, Vec<f64>) {
    let text = r#"
title = "A light swing beside a free body at rest in y"
[coordinates]
x = { start = 0 }
y = { start = 0 }
z = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2)/2 + 1e-18*(z'^2 - 1600*z^2)/2"
[start.velocities]
"x'" = 1
"y'" = 0
"z'" = 1
[run]
duration = 2
"#;
    let scene = Scene::parse("swing", text).unwrap_or_else(|e| panic!("{e}"));
    let mut motion = solve_choice(&scene, &choices(&scene)[0], settings).expect("a motion");
    let (so_far, whole) = error_estimates(&mut motion, setting(&scene), times).expect("in range");
    let z = times.iter().map(|&t| motion.at(t).expect("in range").coordinates[2]).collect();
    (so_far, whole, z)
}

#[test]
fn one_wrong_coordinate_makes_a_motion_untrusted() {
    let settings = Settings { tolerance: 1e-3, method: Some(Method::Dop853), ..Settings::default() };
    let times = [2.0, 0.5, 1.3];
    let (so_far, whole, z) = swing(&settings, &times);
    for ((t, estimate), z) in times.iter().zip(&so_far).zip(&z) {
        let error = (z - (40.0 * t).sin() / 40.0).abs();
        assert!(error <= estimate.coordinates[2], "at {t}: {error:.1e}, {estimate:?}");
    }
    assert!(
        so_far[1].coordinates[2] <= so_far[2].coordinates[2] && so_far[2].coordinates[2] <= so_far[0].coordinates[2]
    );
    // in the kinetic metric there is nothing to be seen of it
    assert!(whole.relative < 1e-9, "{whole:?}");
    assert!(whole.coordinates[2] > 1e-3 / 40.0, "{whole:?}");
    let complaint = whole.complaint().expect("not to be trusted");
    assert!(complaint.contains("relative error estimate of z"), "{complaint}");
}

#[test]
fn a_coordinate_at_rest_in_zero_has_no_error() {
    let (_, whole, _) = swing(&Settings::default(), &[]);
    assert_eq!((whole.coordinates[1], whole.complaint()), (0.0, None), "{whole:?}");
}

/// The estimate of an oscillator of 1 rad/s whose force on `y`, which a constraint holds, is this: the
/// multiplier is minus the force.
fn held(force: &str, settings: &Settings) -> ErrorEstimate {
    let text = format!(
        "title = \"Held\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2)/2 - x^2/2\"\nconstraints = [\"y'\"]\nforces = {{ y = \"{force}\" }}\n\
         [start]\nvelocities = {{ \"x'\" = 1 }}\n[run]\nduration = 3\n"
    );
    let scene = Scene::parse("held", &text).unwrap_or_else(|e| panic!("{e}"));
    let chetaev = choices(&scene).into_iter().find(|c| c.formulation == "chetaev").expect("linear constraints");
    let mut motion = solve_choice(&scene, &chetaev, settings).expect("a motion");
    let estimate = error_estimates(&mut motion, setting(&scene), &[]).expect("in range").1;
    assert!(motion.is_complete(), "{:?}", motion.ending);
    estimate
}

#[test]
fn a_multiplier_that_is_not_known_makes_a_motion_untrusted() {
    let loose = Settings { tolerance: 1e-6, method: Some(Method::Dop853), ..Settings::default() };
    let estimate = held("cos(1e6*x)", &loose);
    assert!(estimate.relative < 1e-4 && estimate.multipliers[0] > 1e-2, "{estimate:?}");
    let complaint = estimate.complaint().expect("not to be trusted");
    assert!(complaint.contains("relative error estimate of lambda"), "{complaint}");
    // ∞ − ∞ from x = 0.71 on
    let estimate = held("exp(1000*x) - exp(999*x)", &loose);
    let complaint = estimate.complaint().expect("not to be trusted");
    assert!(complaint.contains("relative error estimate of lambda") && complaint.contains("NaN"), "{complaint}");
    // round-off of what cancels is no error: (x + 1)² − x² − 2x − 1
    for force in ["0", "x", "1e6*((x + 1)^2 - x^2 - 2*x - 1)", "1e6*(sin(x)^2 + cos(x)^2 - 1)"] {
        assert_eq!(held(force, &Settings::default()).complaint(), None, "{force}");
    }
}
