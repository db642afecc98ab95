//! Steady motions in any unit: traps of a micrometre, motions of a billion seconds.

use linear::{Growth, LinearError, find_steady, linearize, sweep};

use motion::{CHETAEV, setting};

use super::{choice, scene};

/// A particle of mass 1 in `V = ∓ω² w²/2 exp(−(x/w)²)`, a trap of width `w` (upside down: a hill), at `x`.
fn trap(sign: &str, omega: f64, width: f64, x: f64) -> scene::Scene {
    let lagrangian = format!("x'^2/2 {sign} {omega:e}^2*{width:e}^2/2*exp(-(x/{width:e})^2)");
    scene(&[("x", x)], &lagrangian, &[], "\"x'\" = 0")
}

#[test]
fn traps_of_any_width_hold_and_hills_repel() {
    for width in [1e9, 1.0, 1e-6, 1e-9, 1e-15] {
        for omega in [1e-12, 2.0, 10.0, 1e9] {
            for (sign, expected) in [("+", (0.0, omega)), ("-", (omega, 0.0))] {
                let scene = trap(sign, omega, width, 0.0);
                let part = linearize(setting(&scene), &choice(&scene, CHETAEV)).and_then(|found| found.part(&[]));
                let part = part.unwrap_or_else(|error| panic!("{sign} {omega} {width}: {error}"));
                let first = part.eigenvalues.first().unwrap_or_else(|| panic!("{sign} {omega} {width}: none"));
                let (re, im) = (first.value.re, first.value.im.abs());
                let off = (re - expected.0).abs().max((im - expected.1).abs());
                assert!(part.eigenvalues.len() == 2 && off < 1e-12 * omega, "{sign} {omega} {width}: {part:?}");
                let growth = if sign == "+" { Growth::None } else { Growth::Exponential(1) };
                assert_eq!(part.growth(), growth, "{sign} {omega} {width}");
            }
        }
    }
}

#[test]
fn what_is_slow_or_small_is_no_steady_motion() {
    for width in [1e3, 1.0, 1e-6, 1e-9] {
        for omega in [1e-12, 1.0, 1e9] {
            let scene = trap("+", omega, width, 0.3 * width);
            let found = linearize(setting(&scene), &choice(&scene, CHETAEV));
            assert!(matches!(found, Err(LinearError::NotSteady { .. })), "{omega} {width}: {found:?}");
            let found = find_steady(setting(&scene)).unwrap_or_else(|error| panic!("{omega} {width}: {error}"));
            assert!(found.q[0].abs() < 1e-9 * width, "{omega} {width}: {found:?}");
        }
    }
}

/// A wheel of radius `r` that turns in a trap beside another one: what it rolls along is carried.
#[test]
fn wheels_of_any_radius_come_to_rest_in_their_traps() {
    for radius in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
        let lagrangian = "psi'^2/2 + z'^2/2 + exp(-psi^2) + exp(-z^2)";
        let place = [("psi", 0.3), ("z", -0.2), ("x", 0.0)];
        let scene = scene(&place, lagrangian, &[&format!("x' - {radius:e}*psi'")], "\"psi'\" = 0, \"z'\" = 0");
        let found = find_steady(setting(&scene)).unwrap_or_else(|error| panic!("{radius:e}: {error}"));
        assert!(found.q[0].abs() < 1e-9 && found.q[1].abs() < 1e-9, "{radius:e}: {found:?}");
    }
}

/// `y'' = −4 y + (k − 1) y'` beside a swing at 10⁵ rad/s, whose size is in the errors: stability changes
/// somewhere about k = 1, in an interval that is as wide in any unit of k.
#[test]
fn where_stability_changes_is_as_certain_in_any_unit() {
    let widths = [1.0, 1e-6, 1e6].map(|unit| {
        let text = format!(
            "title = \"fed\"\n[parameters]\nk = {unit:e}\n[coordinates]\ny = {{ start = 0 }}\nz = {{ start = 0 }}\n\
             [system]\nlagrangian = \"(y'^2 - 4*y^2 + z'^2 - 1e10*z^2)/2 - y*z\"\n\
             forces = {{ y = \"(k/{unit:e} - 1)*y'\" }}\n[start.velocities]\n\"y'\" = 0\n\"z'\" = 0\n\
             [run]\nduration = 1\n"
        );
        let scene = scene::Scene::parse("fed", &text).unwrap_or_else(|error| panic!("{error}"));
        let values = [-1.0, 3.0].map(|k| k * unit);
        let found = sweep(&scene, &choice(&scene, CHETAEV), &[], ("k", &values), false).expect("a sweep");
        let [change] = &found.changes[..] else { panic!("{:?}", found.changes) };
        assert!((change.value / unit - 1.0).abs() <= change.width / unit, "{change:?}");
        println!("{unit:e}: {change:?}");
        change.width / unit
    });
    assert!(widths.iter().all(|width| (0.5..2.0).contains(&(width / widths[0]))), "{widths:?}");
}
