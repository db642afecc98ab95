//! Rows that are searched from elsewhere: slip at its bound, laws far from Chetaev's numbers, parameters with
//! which formulations agree.

use fit::{Row, Verdict};
use motion::{CHETAEV, Choice, FIRST_ORDER, Settings, choices, solve_choice};
use num_complex::Complex;

use crate::films::{SLEDGE, built_in, film, fitted, fitted_by, sledge, times};

fn estimate<'a>(row: &'a Row, name: &str) -> &'a fit::Estimate {
    let fit = row.fit.as_ref().unwrap_or_else(|error| panic!("{}: {error}", row.choice.label));
    fit.estimates.iter().find(|e| e.name == name).unwrap()
}

/// Motions that creep take the more steps the less they do; 1/N = 0 is Chetaev's motion all the same.
#[test]
fn a_slip_of_zero_is_within_its_interval() {
    let scene = built_in("sledge");
    // a second has half the steps of two; its interval is wider
    let films = [film(&scene, "x,y,phi", 1e-3, 1, &times(1.0), sledge)];
    let rows = fitted_by(&[CHETAEV], &scene, &films, &SLEDGE, &["slip~0.01>=0"]);
    let [chetaev, first] = &rows[..] else { panic!("two") };
    assert_eq!((&chetaev.verdict, &first.verdict), (&Verdict::Supported, &Verdict::Supported));
    let slip = estimate(first, "slip");
    assert!(slip.interval[0] == 0.0 && slip.interval[1] > 0.0 && slip.interval[1] < 2e-3, "{slip:?}");
    let [own, other] = [chetaev, first].map(|row| row.fit.as_ref().unwrap().chi_squared);
    assert!(other <= own + 1e-6, "{other} beside {own}");
}

/// Where Chetaev's numbers are far from those of a law, it is searched from those of the scene, too.
#[test]
fn a_law_far_from_chetaevs_numbers_is_found() {
    let numbers = [("slip", 0.015), ("Omega", 0.61)].map(|(name, x)| (name.to_string(), x.into()));
    let truth = scene::catalogue::find("turning-knife-edge", &numbers).unwrap_or_else(|error| panic!("{error}"));
    let law = choices(&truth).into_iter().find(|c| c.formulation == FIRST_ORDER).unwrap();
    let mut motion = solve_choice(&truth, &Choice { ..law }, &Settings::default()).unwrap();
    let times = times(3.0);
    let path: Vec<Vec<f64>> = times.iter().map(|t| motion.at(*t).unwrap().coordinates.to_vec()).collect();
    let scene = built_in("turning-knife-edge");
    let at = |t: f64| path[(t * 60.0).round() as usize - 1].clone();
    let films = [film(&scene, "x,y,phi", 1e-4, 7, &times, at)];
    let free = ["x", "y", "phi", "phi'", "x'", "Omega"];
    let rows = fitted_by(&[CHETAEV], &scene, &films, &free, &["slip~0.01>=0"]);
    let [low, high] = estimate(&rows[1], "slip").interval;
    assert!(rows[1].verdict == Verdict::Supported && low < 0.015 && 0.015 < high, "{low} to {high}");
}

/// Where Ω is not known, every motion of Chetaev's ball on the turning table is a vakonomic one: with Ω = 0
/// and `μ₀ = −m (x', y')` it runs on the same circle. No film tells them apart, however it is turned.
#[test]
fn formulations_that_agree_for_other_parameters_are_not_told_apart() {
    let scene = built_in("turntable");
    let free = ["x", "y", "x'", "y'", "psi'", "Omega"];
    for turn in [0.0, 0.1] {
        let circle = |t: f64| {
            let i = Complex::new(0.0, 1.0);
            let rate = 2.0 / 7.0 * 0.65;
            let place = Complex::new(0.65, 0.02) + Complex::new(0.02, 0.12) * ((i * rate * t).exp() - 1.0) / (i * rate);
            let turned = place * (i * turn).exp();
            vec![turned.re, turned.im]
        };
        let rows = fitted(&scene, &[film(&scene, "x,y", 1e-4, 3, &times(6.0), circle)], &free, &[]);
        let [chetaev, vakonomic] = &rows[..] else { panic!("two rows") };
        for row in [chetaev, vakonomic] {
            assert!(matches!(row.verdict, Verdict::CannotTell { .. }), "{turn}: {:?}", row.verdict);
        }
        let [a, b] = [chetaev, vakonomic].map(|row| row.fit.as_ref().unwrap().chi_squared);
        assert!(b < a + 1.0, "{turn}: {b} beside {a}");
    }
}
