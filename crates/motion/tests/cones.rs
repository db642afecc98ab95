//! Constraints not linear in the velocities: where `∂f/∂v` vanishes, several motions go on; none is given.

use motion::{CHETAEV, Choice, KAPPA, VAKONOMIC};
use scene::Scene;

use crate::ends::{self, alone};
use crate::support::{choice, read};

/// A particle with weight, which the constraint slows down, and a force to the side.
fn scene(constraint: &str, velocities: [f64; 3], sideways: f64, duration: f64) -> Scene {
    let [x, y, z] = velocities;
    let text = format!(
        "title = \"cone\"\n[parameters]\nkappa = 0.5\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n\
         z = {{ start = 0 }}\n[system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 - z + {sideways:?}*y\"\n\
         constraints = [\"{constraint}\"]\n[start]\n\
         velocities = {{ \"x'\" = {x:?}, \"y'\" = {y:?}, \"z'\" = {z:?} }}\n[run]\nduration = {duration:?}\n"
    );
    read("cone", &text)
}

/// Where x, y, z are at the end with the largest of their estimates, or why they are not.
type End = Result<([f64; 3], f64), String>;

fn ends(scene: &Scene, choice: &Choice) -> Vec<(&'static str, End)> {
    let short = |(q, errors): (Vec<f64>, Vec<f64>)| ([q[0], q[1], q[2]], errors.into_iter().fold(0.0, f64::max));
    ends::ends(scene, choice).into_iter().map(|(by, end)| (by, end.map(short))).collect()
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
        let chetaev = choice(&past, CHETAEV);
        for (by, end) in ends(&before, &chetaev) {
            let ([x, _, z], error) = end.unwrap_or_else(|cause| panic!("{constraint}, {by}: {cause}"));
            // from v to a tenth of it, evenly
            let gone = 0.9 * tip * 0.55;
            let off = (x - gone * velocities[0]).hypot(z - gone * velocities[2]);
            assert!(off <= 10.0 * error + 1e-12, "{constraint}, {by}: off by {off:e}, estimate {error:e}");
        }
        for (by, end) in ends(&past, &chetaev) {
            let Err(cause) = end else { panic!("{constraint}, {by}: goes on to {end:?}") };
            assert!(
                cause.contains("constraint 1 says nothing of the velocities at x ="),
                "{constraint}, {by}: {cause}"
            );
            let t = cause.strip_prefix("stopped at t = ").and_then(|rest| rest.split(':').next());
            let t: f64 = t.and_then(|t| t.parse().ok()).unwrap_or_else(|| panic!("{cause}"));
            assert!((t - tip).abs() < 1e-6 * tip, "{constraint}, {by}: {cause}");
        }
        for other in [VAKONOMIC, KAPPA] {
            alone(&past, &choice(&past, other), None).expect_err(other.name);
        }
    }
}

/// A force to the side turns the velocity round near the tip, up to 2e-8 of what it was, and all ways agree.
#[test]
fn a_motion_goes_on_that_only_comes_near_the_tip() {
    for x in [0.3_f64, 0.03, 0.003, 0.0003] {
        let scene = scene("z'^2 - (x'^2 + y'^2)/4", [x, -1.0, 0.5 * x.hypot(1.0)], 1.0, 6.0);
        let ends = ends(&scene, &choice(&scene, CHETAEV)).into_iter();
        let ends: Vec<_> = ends.map(|(by, end)| end.unwrap_or_else(|cause| panic!("{x}, {by}: {cause}"))).collect();
        for (end, error) in &ends {
            let off = (0..3).map(|i| (end[i] - ends[0].0[i]).abs()).fold(0.0, f64::max);
            assert!(off <= 10.0 * (error + ends[0].1) + 1e-12, "{x}: {ends:?}");
        }
    }
}
