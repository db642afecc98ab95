//! Integration methods against a closed form, exact Jacobians against differences, an implicit form's branch.

use std::f64::consts::FRAC_PI_2;

use diffsol_methods::{BDF, ESDIRK34, EVERY, TR_BDF2, TSIT45};
use integrate::Method;
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Choice, Ending, Motion, REDUCED_CHETAEV, REDUCED_VAKONOMIC, Settings, VAKONOMIC_COSTATE, choices,
    solve_choice,
};
use scene::Scene;
use scene::catalogue::trailer::{self, Coordinates};

use super::closed_forms::sledge;
use super::support::{
    TIGHT, all_equations, at, complete, equations, gap, jacobian_error, largest_difference, linear_scenes, motion_of,
    must, scene, scenes, some_multipliers, tight, vakonomic,
};

#[test]
fn every_method_reaches_the_closed_form_of_the_sledge() {
    let scene = scene("sledge", &[]);
    let exact = sledge(&scene);
    let end = exact.at(10.0);
    let size = end.x.hypot(end.y);
    // tolerance of the looser run; most error of the tighter one, at a hundredth of it, in its own tolerances
    for (method, tolerance, factor) in [
        (Method::Taylor, 1e-9, 100.0),
        (Method::Dop853, 1e-9, 100.0),
        (TSIT45, 1e-7, 100.0),
        (BDF, 1e-6, 1000.0),
        (TR_BDF2, 1e-5, 100.0),
        (ESDIRK34, 1e-6, 100.0),
        (Method::Radau5, 1e-6, 100.0),
    ] {
        let settings = Settings { method: Some(method), tolerance, ..Settings::default() };
        let mut motion = motion_of(&scene, equations(&scene.system, CHETAEV, None), &[], &settings);
        assert!(motion.is_complete(), "{method:?}: {:?}", motion.ending);
        let now = at(&mut motion, 10.0).coordinates;
        let error = super::support::largest_difference(&now, &[end.x, end.y, end.phi]) / size;
        let kept = tolerance * motion::TIGHTER;
        println!("{method:?}: {} steps, {} evaluations", motion.work.steps, motion.work.evaluations);
        must(&format!("sledge, {method:?} at tolerance {kept:.0e}: relative error at t = 10"), error, factor * kept);
    }
}

#[test]
fn jacobians_are_exact_for_every_formulation_on_every_scene() {
    let mut count = 0;
    for scene in scenes() {
        for (name, equations, constants) in all_equations(&scene) {
            let (error, size) = jacobian_error(&scene, &equations, &constants);
            must(&format!("{}, {name}: Jacobian", scene.name), error / size, 1e-8);
            count += 1;
        }
    }
    assert!(count >= 3 * scenes().len() + 2 * linear_scenes().len(), "{count}");
}

/// Through the definitions, and through those that wait for the unknowns.
#[test]
fn jacobians_of_reduced_forms_are_exact() {
    for scene in [scene("disc", &[]), trailer::scene(4, Coordinates::Maximal).expect("parses")] {
        for (form, constants) in [(REDUCED_CHETAEV, vec![]), (REDUCED_VAKONOMIC, some_multipliers(&scene))] {
            let (error, size) = jacobian_error(&scene, &equations(&scene.system, form, None), &constants);
            must(&format!("{}, {form:?}: Jacobian", scene.name), error / size, 1e-7);
        }
    }
}

#[test]
fn implicit_methods_use_those_jacobians() {
    let scene = scene("ball-in-cone", &[("duration", 1.0)]);
    let run = |method| {
        let settings = Settings { method: Some(method), tolerance: 1e-7, ..Settings::default() };
        motion_of(&scene, equations(&scene.system, CHETAEV, None), &[], &settings)
    };
    let mut reference: Motion = run(Method::Dop853);
    for method in [BDF, ESDIRK34] {
        let mut motion = run(method);
        assert!(motion.work.jacobians > 0, "{method:?} asked for no Jacobian");
        let error =
            super::support::largest_difference(&at(&mut motion, 1.0).coordinates, &at(&mut reference, 1.0).coordinates);
        must(&format!("ball-in-cone, {method:?} at 1e-9 against Dop853"), error, 1e-6);
    }
}

/// Random system (seed 2, index 8808): `∂²𝓛/∂v²` nearly singular in `q4'`, another root of `(v, μ)` close by.
const NEAR_A_FOLD: &str = include_str!("../scenes/near-a-fold.toml");

#[test]
fn costate_form_keeps_to_its_branch_near_a_fold() {
    let scene = Scene::parse("fold", NEAR_A_FOLD).unwrap_or_else(|e| panic!("{e}"));
    let mut multiplier = vakonomic(&scene, &scene.multipliers);
    let costate = motion_of(&scene, equations(&scene.system, VAKONOMIC_COSTATE, None), &scene.multipliers, &tight());
    let mut costate = complete(&scene, costate);
    must("near a fold: multiplier form and costate form", gap(&mut multiplier, &mut costate).0, 1e-9);
    // read off backwards, far from where it was read last: the start velocities come out again
    let start = at(&mut costate, 0.0);
    must("near a fold: velocities read at the start", largest_difference(&start.velocities, &scene.start.v), 1e-11);
}

/// The motion of a choice that stops, with the time and the cause.
fn stopped(scene: &Scene, choice: &Choice, method: Option<Method>, tolerance: f64) -> (Motion, f64, String) {
    let settings = Settings { method, tolerance, ..tight() };
    let motion = solve_choice(scene, choice, &settings).unwrap_or_else(|e| panic!("{method:?}: {e}"));
    let Ending::Stopped { t, cause } = motion.ending.clone() else { panic!("{method:?}: {:?}", motion.ending) };
    (motion, t, cause)
}

/// `q₂` stays by symmetry, and its equation `(11/8 − 2μ) a₂ = 0` says so until μ = 11/16, whatever steps do.
#[test]
fn no_step_passes_over_an_equation_that_loses_its_unknown() {
    let text = r#"
title = "One of several motions"
[coordinates]
q1 = { unit = "1", start = -1.0 }
q2 = { unit = "1", start = -0.75 }
q3 = { unit = "1", start = -0.625 }
[system]
lagrangian = "7*q1/4 + 11*q1'^2/16 + 11*q2'^2/16 + 9*q3/16 + 3*q3'^2/4"
constraints = ["q1'^2 - q2'^2 - q3'^2"]
[start.velocities]
"q1'" = 0.625
"q2'" = 0.0
"q3'" = -0.625
[run]
duration = 1.5
"#;
    let scene = Scene::parse("symmetric", text).expect("a scene");
    // (11/8 + 2μ) s = 55/64 + 7t/4 and (3/2 − 2μ) s = 15/16 − 9t/16 with s = q1' = −q3'
    let (sum, slope) = (55.0 / 64.0 + 15.0 / 16.0, 7.0 / 4.0 - 9.0 / 16.0);
    let of_s = 2.75 / (11.0 / 8.0 + 3.0 / 2.0);
    let t = (of_s * sum - 55.0 / 64.0) / (7.0 / 4.0 - of_s * slope);
    for method in [Method::Dop853, Method::Taylor] {
        let (_, end, cause) = stopped(&scene, &choices(&scene)[1], Some(method), TIGHT);
        assert!((end - t).abs() < 1e-9 && cause.contains("mu_1"), "{end}, {t}: {cause}");
    }
}

/// `v_y/sin φ − v_x/cos φ` is the sledge's constraint divided by `sin φ cos φ`: μ is that times the sledge's.
#[test]
fn no_step_passes_over_a_pole_of_the_constraint() {
    let text = r#"
title = "A sledge, divided"
[coordinates]
x = { unit = "m", start = 0.0 }
y = { unit = "m", start = 0.0 }
phi = { unit = "rad", start = 0.3 }
[system]
lagrangian = "(x'^2 + y'^2 + phi'^2)/2 - y"
constraints = ["y'/sin(phi) - x'/cos(phi)"]
[start.velocities]
"x'" = 0.3
"phi'" = 1.0
[vakonomic]
multipliers = [0.3]
[run]
duration = 5.0
"#;
    let divided = Scene::parse("divided", text).expect("a scene");
    let product = "y'*cos(phi) - x'*sin(phi)";
    let whole = Scene::parse("whole", &text.replace("y'/sin(phi) - x'/cos(phi)", product)).expect("a scene");
    let factor = 0.3_f64.sin() * 0.3_f64.cos();
    let mut sledge = vakonomic(&whole, &[0.3 / factor]);
    for method in [Method::Dop853, Method::Taylor] {
        let (mut motion, end, cause) = stopped(&divided, &choices(&divided)[1], Some(method), TIGHT);
        let quarters = at(&mut sledge, end).coordinates[2] / FRAC_PI_2;
        must("quarter turns from a zero of sin 2φ", (quarters - quarters.round()).abs(), 1e-9);
        assert!(cause.contains("(phi)"), "{cause}");
        let (one, two) = (at(&mut motion, 0.9 * end), at(&mut sledge, 0.9 * end));
        must("divided and whole sledge", largest_difference(&one.coordinates, &two.coordinates), 1e-9);
    }
}

/// Down the force, `(1 + k²) s' = −|F|`: the speed is zero at t = 1 + k², at the tip of the cone `z' = k s`,
/// where `p = (1 + k²) s + k P` asks for less than `k P` from then on, which no velocity gives.
#[test]
fn a_motion_ends_at_the_tip_of_its_cone() {
    let text = r#"
title = "Cone of velocities"
[coordinates]
x = { unit = "m", start = 0 }
y = { unit = "m", start = 0 }
z = { unit = "m", start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2 - x - 0.3*y"
constraints = ["z' - 0.5*sqrt(x'^2 + y'^2)"]
[start.velocities]
"x'" = 1
"y'" = 0.3
[removal.plane]
parameters = ["x", "y"]
rates = { z = "0.5*sqrt(x'^2 + y'^2)" }
[run]
duration = 3
"#;
    let scene = Scene::parse("cone", text).expect("a scene");
    let removed = choices(&scene).into_iter().find(|c| c.removal.is_some()).expect("a removal");
    let choice = Choice { constants: ConstantsRule::Given(vec![0.4]), ..removed };
    for method in [None].into_iter().chain(EVERY.map(Some)) {
        let (_, t, cause) = stopped(&scene, &choice, method, 1e-8);
        assert!((t - 1.25).abs() < 1e-5, "{method:?}: {t}: {cause}");
    }
}
