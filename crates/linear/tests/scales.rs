//! Steady motions in any unit: traps of a micrometre, motions of a billion seconds.

use linear::{Growth, LinearError, find_steady, linearize};

use deltaq::{CHETAEV, setting};

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
