//! Constraints not linear in the velocities: where `∂f/∂v` vanishes, several motions go on; none is given.

use deltaq::{Choice, Ensemble, EnsembleOptions, Settings, choices, error_estimate, setting, solve_choice};
use integrate::Method;
use scene::Scene;

/// A particle with weight, which the constraint slows down, and a force to the side.
fn scene(constraint: &str, velocities: [f64; 3], sideways: f64, duration: f64) -> Scene {
    let [x, y, z] = velocities;
    let text = format!(
        "title = \"cone\"\n[parameters]\nkappa = 0.5\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n\
         z = {{ start = 0 }}\n[system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 - z + {sideways:?}*y\"\n\
         constraints = [\"{constraint}\"]\n[start]\n\
         velocities = {{ \"x'\" = {x:?}, \"y'\" = {y:?}, \"z'\" = {z:?} }}\n[run]\nduration = {duration:?}\n"
    );
    Scene::parse("cone", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn choice(scene: &Scene, formulation: &str) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation.name == formulation).expect("it is there")
}

/// Where x, y, z are at the end with the largest of their estimates, or why they are not.
type End = Result<([f64; 3], f64), String>;

fn alone(scene: &Scene, choice: &Choice, method: Option<Method>) -> End {
    let mut motion = solve_choice(scene, choice, &Settings { method, ..Settings::default() }).expect("a motion");
    let estimate = error_estimate(&mut motion, setting(scene)).expect("in range");
    match estimate.status(&motion) {
        ("completed", _) => {
            let end = motion.at(motion.end()).expect("the end").coordinates;
            Ok(([end[0], end[1], end[2]], estimate.coordinates.iter().copied().fold(0.0, f64::max)))
        }
        (_, cause) => Err(cause.unwrap_or_default()),
    }
}

/// Two members, which are to be the same.
fn in_lanes(scene: &Scene, choice: &Choice) -> End {
    let mut ensemble = Ensemble::new(scene, choice, &[], &Settings::default()).expect("an ensemble");
    let members = vec![ensemble.member(&[]).expect("a member"); 2];
    let end = scene.duration;
    let ends = ensemble.motions(&members, &[end], &EnsembleOptions::default()).into_iter().map(|motion| {
        let motion = motion.expect("a motion");
        match motion.status() {
            ("completed", _) => {
                let estimate = motion.estimate.as_ref().expect("an estimate");
                let q = &motion.outputs[0].coordinates;
                Ok(([q[0], q[1], q[2]], estimate.coordinates.iter().copied().fold(0.0, f64::max)))
            }
            (_, cause) => Err(cause.unwrap_or_default()),
        }
    });
    let ends: Vec<End> = ends.collect();
    assert_eq!(ends[0], ends[1]);
    ends[0].clone()
}

/// By each method and in an ensemble.
fn ends(scene: &Scene, choice: &Choice) -> Vec<(&'static str, End)> {
    let methods = [None, Some(Method::Taylor), Some(Method::Dop853), Some(Method::Radau5)];
    let by = |method: Option<Method>| (method.map_or("default", Method::name), alone(scene, choice, method));
    methods.into_iter().map(by).chain([("in lanes", in_lanes(scene, choice))]).collect()
}

/// The part of the weight along the velocity `v`, which keeps its direction, brings it to rest at `v²/v_z`.
/// The reaction grows without limit there, while the accelerations stay what they were.
#[test]
fn chetaevs_motion_ends_at_the_tip_of_a_cone() {
    let cases = [
        ("x'^2 - z'^2/4", [0.5, 0.0, 1.0], 1.25),
        ("z'^2 - (x'^2 + y'^2)/4", [0.6, 0.8, 0.5], 2.5),
        ("1e9*(z'^2 - (x'^2 + y'^2)/4)", [0.6, 0.8, 0.5], 2.5),
        ("z'^4 - (x'^2 + y'^2)^2/16", [0.6, 0.8, 0.5], 2.5),
        // y' stays
        ("z'^3 - x'^3", [0.6, 0.8, 0.6], 1.2),
    ];
    for (constraint, velocities, tip) in cases {
        let before = scene(constraint, velocities, 0.0, 0.9 * tip);
        let past = scene(constraint, velocities, 0.0, 1.3 * tip);
        let chetaev = choice(&past, "chetaev");
        for (by, end) in ends(&before, &chetaev) {
            let ([x, _, z], error) = end.unwrap_or_else(|cause| panic!("{constraint}, {by}: {cause}"));
            // from v to a tenth of it, evenly
            let gone = 0.9 * tip * 0.55;
            let off = (x - gone * velocities[0]).hypot(z - gone * velocities[2]);
            assert!(off <= 10.0 * error + 1e-12, "{constraint}, {by}: off by {off:e}, estimate {error:e}");
        }
        for (by, end) in ends(&past, &chetaev) {
            let Err(cause) = end else { panic!("{constraint}, {by}: goes on to {end:?}") };
            assert!(cause.ends_with("vanishes, by which the equations divide"), "{constraint}, {by}: {cause}");
            let t = cause.strip_prefix("stopped at t = ").and_then(|rest| rest.split(':').next());
            let t: f64 = t.and_then(|t| t.parse().ok()).unwrap_or_else(|| panic!("{cause}"));
            assert!((t - tip).abs() < 1e-6 * tip, "{constraint}, {by}: {cause}");
        }
        for other in ["vakonomic", "kappa"] {
            alone(&past, &choice(&past, other), None).expect_err(other);
        }
    }
}

/// A force to the side turns the velocity round near the tip, up to 2e-8 of what it was, and all ways agree.
#[test]
fn a_motion_goes_on_that_only_comes_near_the_tip() {
    for x in [0.3_f64, 0.03, 0.003, 0.0003] {
        let scene = scene("z'^2 - (x'^2 + y'^2)/4", [x, -1.0, 0.5 * x.hypot(1.0)], 1.0, 6.0);
        let ends = ends(&scene, &choice(&scene, "chetaev")).into_iter();
        let ends: Vec<_> = ends.map(|(by, end)| end.unwrap_or_else(|cause| panic!("{x}, {by}: {cause}"))).collect();
        for (end, error) in &ends {
            let off = (0..3).map(|i| (end[i] - ends[0].0[i]).abs()).fold(0.0, f64::max);
            assert!(off <= 10.0 * (error + ends[0].1) + 1e-12, "{x}: {ends:?}");
        }
    }
}
