//! Chaplygin's multiplier of systems that were built with one.

use decision::ExactStart;
use integrals::{Multiplier, reversible};
use scene::catalogue::read;
use symbolic::Fraction;

/// `g = (1 + x²) 1` on the constraints, whose lifts have `[X_x, X_y] = ∂_u`, `[X_x, X_z] = ∂_w`. With `f =
/// 1/(1 + x²)`, `c_abd = φ_b g_ad − φ_a g_bd` is `N_yᵀ M ∂_u = 2x = N_zᵀ M ∂_w`.
fn built(more: &str) -> String {
    format!(
        "title = \"built\"\n[coordinates]\nu = {{ start = 0 }}\nw = {{ start = 0 }}\nx = {{ start = 0.5 }}\ny = {{ start = 0 }}\nz = \
         {{ start = 0 }}\n[system]\nlagrangian = \"((1 + x^2)*x'^2 + (1 - x^2)*(y'^2 + z'^2) + 2*(u'^2 + w'^2){more})/2\"\n\
         constraints = [\"u' - x*y'\", \"w' - x*z'\"]\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 1\n\"z'\" = 1\n[run]\nduration = 1\n"
    )
}

/// Over (x, y, z): `None` where this is no motion of its own.
fn asked(more: &str) -> Option<Multiplier> {
    let scene = read("built", &built(more), &[]).unwrap_or_else(|error| panic!("{error}"));
    let start = ExactStart::new(&scene.system, &scene.start, &scene.completion, None).expect("a start");
    let found = reversible(&scene.system, &start, 0).reductions.expect("an answer");
    found.into_iter().find(|found| found.over == [2, 3, 4]).map(|found| found.multiplier)
}

/// `f = 1/(1 + x²) = (det g)^{−1/3}`, over three coordinates.
#[test]
fn one_over_three_coordinates_is_found() {
    let Some(Multiplier::Local(Some(factor))) = asked("") else { panic!("{:?}", asked("")) };
    assert_eq!((factor.of_metric, factor.of_angles.len()), (Fraction::new(-1, 3).expect("a fraction"), 0));
    assert_eq!(factor.free, [2, 3, 4]);
}

#[test]
fn another_energy_has_none() {
    for more in [" + y'^2/10", " + x*y'^2/10", " + x'*y'/10", " + y^2*z'^2/10"] {
        assert_eq!(asked(more), Some(Multiplier::None), "{more}");
    }
}

/// With a potential of `r` the same; with one of `z` it is no motion over `r`.
#[test]
fn potentials_of_the_reduced_coordinates_alone_are_taken() {
    assert!(matches!(asked(" - sin(y)*z"), Some(Multiplier::Local(Some(_)))));
    assert_eq!(asked(" - sin(u)*y"), None);
}
