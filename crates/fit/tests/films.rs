//! Films of motions in closed form, with noise, are fitted: numbers, intervals, verdicts.

use std::fmt::Write;

use fit::{Deviations, Film, Question, Row, Unknown, Verdict, fit_formulations};
use mechanics::ConstantsRule;
use motion::{CHETAEV, Choice, Settings, VAKONOMIC, choices, solve_choice};
use scene::Scene;

use crate::noise::Noise;

pub fn built_in(name: &str) -> Scene {
    scene::catalogue::find(name, &[]).unwrap_or_else(|error| panic!("{error}"))
}

pub fn film(scene: &Scene, header: &str, sigma: f64, seed: u64, times: &[f64], at: impl Fn(f64) -> Vec<f64>) -> Film {
    let mut noise = Noise(seed);
    let mut table = format!("t,{header}\n");
    for t in times {
        let _ = write!(table, "{t}");
        at(*t).iter().for_each(|x| write!(table, ",{}", x + sigma * noise.normal()).unwrap());
        table.push('\n');
    }
    let deviations = Deviations { others: Some(sigma), ..Deviations::default() };
    Film::read(scene, "film", &table, &deviations).unwrap_or_else(|error| panic!("{error}"))
}

/// By Chetaev's and the vakonomic equations, and by a law if it has numbers.
pub fn fitted(scene: &Scene, films: &[Film], free: &[&str], law: &[&str]) -> Vec<Row> {
    fitted_by(&[CHETAEV, VAKONOMIC], scene, films, free, law)
}

pub fn question(unknowns: &[Unknown]) -> Question<'_> {
    let settings = Settings { tolerance: 1e-9, max_steps: 20_000, ..Settings::default() };
    Question { unknowns, law: &[], starts: 16, robust: None, settings, threads: 0 }
}

pub fn fitted_by(
    wanted: &[&'static equations::Formulation],
    scene: &Scene,
    films: &[Film],
    free: &[&str],
    law: &[&str],
) -> Vec<Row> {
    let parsed = |list: &[&str]| list.iter().map(|text| text.parse().unwrap()).collect::<Vec<Unknown>>();
    let (unknowns, law) = (parsed(free), parsed(law));
    let question = Question { law: &law, ..question(&unknowns) };
    let rows = fit_formulations(scene, &mut films.to_vec(), &question, wanted);
    rows.unwrap_or_else(|error| panic!("{error}"))
}

/// The estimates of a row cover these numbers within their intervals widened by half.
fn covers(row: &Row, truth: &[(&str, f64)]) {
    let fit = row.fit.as_ref().unwrap_or_else(|error| panic!("{}: {error}", row.choice.label));
    for (name, truth) in truth {
        let estimate = fit.estimates.iter().find(|e| e.name == *name).unwrap_or_else(|| panic!("no {name}"));
        let [low, high] = estimate.interval;
        let wider = 0.25 * (high - low);
        assert!(low - wider <= *truth && *truth <= high + wider, "{truth} in {estimate:?}");
        assert!(estimate.error > 0.0 && high - low < 6.0 * estimate.error, "{estimate:?}");
    }
}

pub fn times(end: f64) -> Vec<f64> {
    (1..=(end * 60.0).round() as usize).map(|k| k as f64 / 60.0).collect()
}

/// A circle of rate μ: `(x', y')` turns at it from (0.6, 0.8). So runs a vakonomic particle on the contact
/// plane field, and Chetaev's runs straight; with μ small a short film cannot tell them apart.
#[test]
fn circles_are_vakonomic_and_straight_lines_are_both() {
    let scene = built_in("heisenberg");
    let free = ["x", "y", "x'", "y'"];
    let circle = |mu: f64| {
        move |t: f64| {
            let (s, c) = ((mu * t).sin() / mu, (1.0 - (mu * t).cos()) / mu);
            vec![0.5 + 0.6 * s - 0.8 * c, 0.6 * c + 0.8 * s]
        }
    };
    let films = [film(&scene, "x,y", 1e-3, 1, &times(3.0), circle(0.7))];
    let [chetaev, vakonomic] = &fitted(&scene, &films, &free, &[])[..] else { panic!("two rows") };
    assert!(matches!(chetaev.verdict, Verdict::Excluded { sigmas } if sigmas > 100.0), "{:?}", chetaev.verdict);
    assert_eq!(vakonomic.verdict, Verdict::Supported);
    let fit = vakonomic.fit.as_ref().unwrap();
    let mu = fit.estimates.iter().find(|e| e.name == "mu0_1").unwrap();
    assert!((mu.value.abs() - 0.7).abs() < 3.0 * mu.error && mu.error < 1e-3, "{mu:?}");
    covers(vakonomic, &[("x", 0.5), ("y", 0.0), ("x'", 0.6), ("y'", 0.8)]);

    let films = [film(&scene, "x,y", 1e-3, 2, &times(2.0), circle(1e-4))];
    let rows = fitted(&scene, &films, &free, &[]);
    let fit = rows[1].fit.as_ref().unwrap();
    let mu = fit.estimates.iter().find(|e| e.name == "mu0_1").unwrap();
    // χ² of the straight line that is closest to an arc: (μ/error)², and as the fifth power of the length
    let chi_squared = |longer: f64| (mu.value / mu.error).powi(2) * longer.powi(5);
    let longer = [1.5, 2.0, 3.0, 4.0, 6.0, 8.0].into_iter().find(|longer| chi_squared(*longer) >= 15.0);
    assert!(longer.is_some() && chi_squared(1.0) < 10.0, "{mu:?}");
    let [chetaev, vakonomic] = ["Chetaev", "vakonomic"].map(|label| vec![label.to_string()]);
    assert_eq!(rows[0].verdict, Verdict::CannotTell { from: vakonomic, needs: vec![longer] });
    // a straight line is vakonomic, too, however long
    assert_eq!(rows[1].verdict, Verdict::CannotTell { from: chetaev, needs: vec![None] });
}

/// x, y, φ of Chetaev's sledge: mathematics of the paper's first example.
pub fn sledge(t: f64) -> Vec<f64> {
    sledge_from(0.3, t)
}

/// The same from another heading.
pub fn sledge_from(phi0: f64, t: f64) -> Vec<f64> {
    let (g, alpha, speed, omega) = (9.81_f64, 0.4_f64, 0.5_f64, 1.1_f64);
    let (slope, turn) = (g * alpha.sin(), omega * t);
    let ((s0, c0), (s1, c1)) = (phi0.sin_cos(), (phi0 + turn).sin_cos());
    let (c, s) = ((s1 - s0) / omega, (c0 - c1) / omega);
    let x = speed * c + 0.5 * slope * c * c;
    let y = speed * s + 0.5 * slope * (c * s + (turn - turn.sin()) / (omega * omega));
    vec![x, y, phi0 + turn]
}

pub const SLEDGE: [&str; 6] = ["x", "y", "phi", "x'", "phi'", "g~9"];

#[test]
fn a_sledge_is_chetaevs_and_its_epsilon_is_at_the_bound() {
    let scene = built_in("sledge");
    let films = [film(&scene, "x,y,phi", 1e-3, 1, &times(2.0), sledge)];
    let [chetaev, vakonomic, first] = &fitted(&scene, &films, &SLEDGE, &["epsilon>=0"])[..] else { panic!("three") };
    assert_eq!((&chetaev.verdict, &first.verdict), (&Verdict::Supported, &Verdict::Supported));
    assert!(matches!(vakonomic.verdict, Verdict::Excluded { .. }), "{:?}", vakonomic.verdict);
    covers(chetaev, &[("x", 0.0), ("y", 0.0), ("phi", 0.3), ("x'", 0.5 * 0.3_f64.cos()), ("phi'", 1.1), ("g", 9.81)]);
    let fit = first.fit.as_ref().unwrap();
    let epsilon = fit.estimates.iter().find(|e| e.name == "epsilon").unwrap();
    // this noise wants ε < 0, and is not given it
    assert_eq!((epsilon.value, epsilon.interval[0], epsilon.at_bound), (0.0, 0.0, Some(1.0)));
    assert!(epsilon.interval[1] > 0.0 && epsilon.interval[1] < 1e-4, "{epsilon:?}");
    assert!(fit.chi_squared >= chetaev.fit.as_ref().unwrap().chi_squared - 1e-6);
}

/// The profile of the only unknown, on which the motion depends linearly, is a parabola.
#[test]
fn a_profile_needs_no_others() {
    let scene = built_in("sledge");
    let films = [film(&scene, "x,y,phi", 1e-3, 1, &times(1.0), sledge)];
    let row = fitted_by(&[CHETAEV], &scene, &films, &["g~9"], &[]).remove(0);
    let (problem, fit) = (row.problem.unwrap(), row.fit.unwrap());
    let (value, error) = (fit.estimates[0].value, fit.estimates[0].error);
    let rises = fit::profile(&problem, &fit, "g", &[value, value - error, value + 3.0 * error]).unwrap();
    assert!(rises.iter().zip([0.0, 1.0, 9.0]).all(|(rise, square)| (rise - square).abs() < 1e-3), "{rises:?}");
}

/// What is known before is a measurement: of two normal ones the weighed mean, with the error of both.
#[test]
fn what_is_known_before_counts() {
    let scene = built_in("sledge");
    let films = [film(&scene, "x,y,phi", 1e-3, 1, &times(2.0), sledge)];
    let g = |known: &str| {
        let free = [&SLEDGE[..5], &[known]].concat();
        let rows = fitted(&scene, &films, &free, &[]);
        rows[0].fit.as_ref().unwrap().estimates[5].clone()
    };
    let (alone, both) = (g("g~9"), g("g~9.83±0.004"));
    let (a, b) = (alone.error.powi(-2), 0.004_f64.powi(-2));
    assert!((both.value - (a * alone.value + b * 9.83) / (a + b)).abs() < 0.02 * both.error, "{alone:?} {both:?}");
    assert!((both.error * (a + b).sqrt() - 1.0).abs() < 1e-2, "{alone:?} {both:?}");
    let [low, high] = both.interval;
    assert!(((high - low) / (2.0 * 1.96 * both.error) - 1.0).abs() < 0.03, "{both:?}");
}

/// A sledge whose film is wrong: a clock that runs at another rate, an outlier, a column of another motion.
#[test]
fn residuals_object_to_what_is_wrong_before_a_verdict_is_given() {
    let scene = built_in("sledge");
    let good = film(&scene, "x,y,phi", 1e-3, 3, &times(2.0), sledge);
    let spring = |t: f64| {
        let q = sledge(t);
        vec![q[0] + 4e-3 * (5.0 * t).sin(), q[1], q[2]]
    };
    let mut outlier = good.clone();
    outlier.rows[40][1] = Some(sledge(outlier.t[40])[1] + 0.02);
    let mut swapped = good.clone();
    swapped.rows[60..80].iter_mut().for_each(|row| row.swap(0, 1));
    let shaken = film(&scene, "x,y,phi", 1e-3, 4, &times(2.0), spring);
    for (what, film) in [("outlier", outlier.clone()), ("swapped", swapped), ("shaken", shaken)] {
        let rows = fitted(&scene, &[film], &SLEDGE, &[]);
        let objections: Vec<_> = rows[0].fit.as_ref().unwrap().objections().map(|t| t.name.clone()).collect();
        assert!(!objections.is_empty(), "{what}");
        assert!(rows.iter().all(|row| row.verdict == Verdict::None), "{what}: {:?}", rows[0].verdict);
    }
    // an outlier counts little where it is asked to
    let unknowns: Vec<Unknown> = SLEDGE.iter().map(|text| text.parse().unwrap()).collect();
    let settings = Settings { tolerance: 1e-9, ..Settings::default() };
    let question = Question { unknowns: &unknowns, law: &[], starts: 1, robust: Some(1.345), settings, threads: 0 };
    let rows = fit_formulations(&scene, &mut [outlier], &question, &[CHETAEV]).unwrap();
    assert_eq!(rows[0].verdict, Verdict::Supported);
    covers(&rows[0], &[("y", 0.0), ("g", 9.81)]);
}

/// Vakonomic motions of the ball on the turning table go far and fast: the least minimum is found.
#[test]
fn violent_motions_are_found() {
    let scene = built_in("turntable");
    let mut found = 0;
    for seed in 0..5 {
        let mut noise = Noise(seed + 77);
        let vakonomic = choices(&scene).into_iter().find(|c| c.formulation == VAKONOMIC).unwrap();
        let constants = ConstantsRule::Given(vec![0.3 * noise.normal(), 0.3 * noise.normal()]);
        let mut motion = solve_choice(&scene, &Choice { constants, ..vakonomic }, &Settings::default()).unwrap();
        let (times, mut path) = (times(motion.end().min(5.0)), Vec::new());
        times.iter().for_each(|t| path.push(motion.at(*t).unwrap().coordinates[..2].to_vec()));
        let at = |t: f64| path[(t * 60.0).round() as usize - 1].clone();
        let film = film(&scene, "x,y", 1e-3, seed, &times, at);
        let rows = fitted(&scene, &[film], &["x", "y", "x'", "y'", "psi'"], &[]);
        found += usize::from(rows[1].verdict == Verdict::Supported);
        let fit = rows[0].fit.as_ref().unwrap();
        // Chetaev's circle has the same size whatever the spin
        assert_eq!(fit.hidden, ["psi'"]);
    }
    assert!(found >= 4, "{found} of 5");
}
