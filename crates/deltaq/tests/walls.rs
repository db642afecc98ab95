//! Walls that are in no term of a series until they are near: divisors that vanish.

use deltaq::{Ensemble, EnsembleOptions, Settings, choices, error_estimate, setting, solve_choice};
use integrate::Method;
use scene::Scene;

fn scene(lagrangian: &str, forces: &str) -> Scene {
    let text = format!(
        "title = \"wall\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2)/2 {lagrangian}\"\nforces = {{ x = \"{forces}\" }}\n[start]\n\
         velocities = {{ \"x'\" = -1, \"y'\" = 0 }}\n[run]\nduration = 3\n"
    );
    Scene::parse("wall", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// Where a motion ends and its estimate, or why it stops; with the road that it was made by.
type End = (String, Result<(f64, f64), String>);

/// x at the end with its estimate by each method and in an ensemble of two members, or why it is not trusted.
fn ends(scene: &Scene) -> Vec<End> {
    let chetaev = &choices(scene)[0];
    let methods = [None, Some(Method::Taylor), Some(Method::Dop853), Some(Method::Radau5)];
    let mut ends: Vec<_> = methods
        .into_iter()
        .map(|method| {
            let settings = Settings { method, ..Settings::default() };
            let mut motion = solve_choice(scene, chetaev, &settings).expect("a motion");
            let estimate = error_estimate(&mut motion, setting(scene)).expect("in range");
            let found = match estimate.status(&motion) {
                ("completed", _) => Ok((motion.at(3.0).expect("the end").coordinates[0], estimate.coordinates[0])),
                (_, cause) => Err(cause.unwrap_or_default()),
            };
            (method.map_or("default", Method::name).to_string(), found)
        })
        .collect();
    let mut ensemble = Ensemble::new(scene, chetaev, &[], &Settings::default()).expect("an ensemble");
    let members = vec![ensemble.member(&[]).expect("a member"); 2];
    for motion in ensemble.motions(&members, &[3.0], &EnsembleOptions::default()) {
        let motion = motion.expect("a motion");
        let found = match motion.status() {
            ("completed", _) => {
                let estimate = motion.estimate.as_ref().expect("an estimate").coordinates[0];
                Ok((motion.outputs[0].coordinates[0], estimate))
            }
            (_, cause) => Err(cause.unwrap_or_default()),
        };
        ends.push(("in an ensemble".into(), found));
    }
    ends
}

/// A particle that comes to a wall is turned back: it is at +2, less what the wall is thick, and never at −2,
/// where it came to in silence.
#[test]
fn a_wall_is_not_run_through_however_thin_it_is() {
    let (mut right, mut told) = (0, 0);
    for exponent in [-15, -18, -22, -30, -60, -150] {
        for wall in ["x", "x^2", "x^4", "sin(x)^2", "tan(x)^2", "(x^2 + y^2)"] {
            for (by, found) in ends(&scene(&format!("- 1e{exponent}/{wall}"), "0")) {
                let reach = 10.0_f64.powf(f64::from(exponent) / 4.0);
                match found {
                    Err(_) => told += 1,
                    Ok((x, estimate)) if (x - 2.0).abs() <= 10.0 * estimate + 10.0 * reach + 1e-9 => right += 1,
                    Ok((x, estimate)) => panic!("1e{exponent}/{wall}, {by}: {x}, estimate {estimate:.1e}"),
                }
            }
        }
    }
    println!("{right} turned back, {told} told");
    assert!(right > 20, "{right} turned back, {told} told");
}

/// What is finite where its divisor vanishes is passed as before.
#[test]
fn zeros_of_divisors_that_do_nothing_stop_nothing() {
    for (lagrangian, force) in [
        ("+ 1e-3*sin(x)/x", "0.1*sin(x)/x"),
        ("", "0.1*(1 - cos(x))/x^2"),
        ("+ 0.1*(exp(x) - 1)/x", "0.1*tanh(x)/x"),
        ("", "0.1*(x^2 - 0.09)/(x - 0.3)"),
    ] {
        let found = ends(&scene(lagrangian, force));
        let (first, _) = found[0].1.clone().unwrap_or_else(|cause| panic!("{lagrangian}, {force}: {cause}"));
        for (by, end) in &found {
            let (x, estimate) = end.clone().unwrap_or_else(|cause| panic!("{lagrangian}, {force}, {by}: {cause}"));
            assert!(
                x < -1.0 && (x - first).abs() <= 100.0 * estimate + 1e-8,
                "{lagrangian}, {force}, {by}: {x}, {first}"
            );
        }
    }
}
