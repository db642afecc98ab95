//! Walls that are in no term of a series until they are near: divisors that vanish.

use motion::choices;
use scene::Scene;

use crate::{ends, support};

fn scene(lagrangian: &str, forces: &str) -> Scene {
    let text = format!(
        "title = \"wall\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2)/2 {lagrangian}\"\nforces = {{ x = \"{forces}\" }}\n[start]\n\
         velocities = {{ \"x'\" = -1, \"y'\" = 0 }}\n[run]\nduration = 3\n"
    );
    support::read("wall", &text)
}

/// x at the end with its estimate, or why it is not trusted.
type End = Result<(f64, f64), String>;

fn ends(scene: &Scene) -> Vec<(&'static str, End)> {
    let found = ends::ends(scene, &choices(scene)[0]).into_iter();
    found.map(|(by, end)| (by, end.map(|(q, errors)| (q[0], errors[0])))).collect()
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
