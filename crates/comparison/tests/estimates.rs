//! What a motion says of its own errors, coordinate by coordinate.

use comparison::{Verdict, compare_motions};
use integrate::Method;
use motion::{
    CHETAEV, ErrorEstimate, Metric, Motion, Setting, Settings, choices, error_estimates, setting, solve_choice,
    solve_from,
};
use scene::Scene;

/// A swing z of frequency 40 about a place, with hardly any inertia.
fn swinging(place: f64) -> Scene {
    let text = r#"
title = "A light swing beside a free body at rest in y"
[parameters]
place = 0
[coordinates]
x = { start = 0 }
y = { start = 0 }
z = { start = "place" }
[system]
lagrangian = "(x'^2 + y'^2)/2 + 1e-18*(z'^2 - 1600*(z - place)^2)/2"
[start.velocities]
"x'" = 1
"y'" = 0
"z'" = 1
[run]
duration = 2
"#;
    Scene::parse_with("swing", text, &[("place".to_string(), place)]).unwrap_or_else(|e| panic!("{e}"))
}

/// The estimates at `times` and of the whole motion, with z at these times.
fn swing(settings: &Settings, times: &[f64]) -> (Vec<ErrorEstimate>, ErrorEstimate, Vec<f64>) {
    let scene = swinging(0.0);
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
    let chetaev = choices(&scene).into_iter().find(|c| c.formulation == CHETAEV).expect("linear constraints");
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

const LOOSE: fn() -> Settings = || Settings { tolerance: 1e-3, method: Some(Method::Dop853), ..Settings::default() };

#[test]
fn motions_are_the_same_only_where_every_coordinate_is_known() {
    let scene = swinging(0.0);
    let mut motion = solve_choice(&scene, &choices(&scene)[0], &LOOSE()).expect("a motion");
    let mut metric = Metric::new(&scene.system).expect("a metric");
    let gap = compare_motions(&mut motion.clone(), &mut motion, &mut metric).expect("a gap");
    let Verdict::Undecided { because } = gap.verdict else { panic!("{:?}", gap.verdict) };
    assert!(because.starts_with("relative error estimate of z "), "{because}");
}

#[test]
fn estimates_of_a_motion_back_in_time_are_those_up_to_each_time() {
    let scene = swinging(0.0);
    let back = Setting { end: -2.0, ..setting(&scene) };
    let mut motion: Motion = solve_from(back, &choices(&scene)[0], &LOOSE()).expect("a motion");
    let (so_far, whole) = error_estimates(&mut motion, back, &[-2.0, -0.2, -1.0]).expect("in range");
    let [last, first, middle] = [0, 1, 2].map(|i| so_far[i].coordinates[2]);
    assert!(0.0 < first && first < middle && middle < last && last == whole.coordinates[2], "{so_far:?}");
}

#[test]
fn a_difference_is_a_part_of_where_a_coordinate_is_or_how_far_it_came() {
    for (place, size) in [(0.0, 0.025), (3.0, 3.025)] {
        let scene = swinging(place);
        let mut motion = solve_choice(&scene, &choices(&scene)[0], &LOOSE()).expect("a motion");
        let whole = error_estimates(&mut motion, setting(&scene), &[]).expect("in range").1;
        let (name, part) = whole.worst.expect("not round-off alone");
        let known = whole.coordinates[2] / size;
        assert!(name == "z" && (part / known - 1.0).abs() < 0.05, "{place}: {name} {part:e}, known {known:e}");
    }
}

#[test]
fn a_multiplier_of_a_motion_at_rest_is_off_by_its_round_off() {
    // both runs stay where they are, and the multiplier should be zero
    let text = "title = \"At rest\"\n[coordinates]\nx = { start = 0.3 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\n\
                forces = { y = \"1e6*((x + 1)^3 - x^3 - 3*x^2 - 3*x - 1)\" }\n\
                [start]\nvelocities = { \"x'\" = 0 }\n[run]\nduration = 3\n";
    let scene = Scene::parse("rest", text).unwrap_or_else(|e| panic!("{e}"));
    let chetaev = choices(&scene).into_iter().find(|c| c.formulation == CHETAEV).expect("linear constraints");
    let mut motion = solve_choice(&scene, &chetaev, &Settings::default()).expect("a motion");
    let estimate = error_estimates(&mut motion, setting(&scene), &[]).expect("in range").1.multipliers[0];
    let error = motion.at(3.0).expect("in range").multipliers[0].abs();
    assert!(error > 0.0 && estimate >= error && estimate < 1e-7, "{estimate:e}, wrong by {error:e}");
}
