//! What films can show at all: against closed forms, and derivatives of motions.

use equations::Formulation;
use fit::{Deviations, Film, Identifiability, Problem, Unknown, standard_errors};
use motion::{CHETAEV, Settings, VAKONOMIC, choices};
use scene::Scene;

use crate::films::{built_in, film, fitted, times};

/// Two seconds of a scene at 60 Hz, and these numbers of it unknown, in one formulation.
fn asked(scene: &Scene, formulation: &Formulation, columns: &[&str], free: &[&str]) -> (Problem, Identifiability) {
    let columns: Vec<String> = columns.iter().map(|name| name.to_string()).collect();
    let deviations = Deviations { others: Some(1e-6), ..Deviations::default() };
    let film = Film::planned(scene, &columns, "60Hz,2s".parse().unwrap(), &deviations).unwrap();
    let unknowns: Vec<Unknown> = free.iter().map(|text| text.parse().unwrap()).collect();
    let choice = choices(scene).into_iter().find(|choice| *choice.formulation == *formulation).unwrap();
    let settings = Settings { tolerance: 1e-10, ..Settings::default() };
    let problem = Problem::new(scene, &choice, &[film], &unknowns, &settings).unwrap();
    let shown = problem.identifiability(scene, &choice);
    (problem, shown)
}

fn hidden(scene: &Scene, formulation: &Formulation, columns: &[&str], free: &[&str]) -> Vec<Vec<String>> {
    match asked(scene, formulation, columns, free).1 {
        Identifiability::Hidden { combinations, .. } => combinations,
        Identifiability::Proved { .. } => Vec::new(),
        Identifiability::Open(reason) => panic!("{reason}"),
    }
}

/// Only `g sin α` pulls the sledge; its own radius of gyration is not seen where it turns freely.
#[test]
fn combinations_of_closed_forms_are_named() {
    let sledge = built_in("sledge");
    let start = ["x", "y", "phi", "x'", "phi'"];
    let of = |more: &[&str]| hidden(&sledge, CHETAEV, &["x", "y"], &[&start, more].concat());
    assert_eq!(of(&["g", "alpha"]), [["g", "alpha"]]);
    assert_eq!(of(&["g", "k"]), [["k"]]);
    assert!(of(&["g", "clock~0±0.01"]).is_empty());
    // with another unit of time all else is the same, but gravity and speeds
    let scaled = of(&["g", "clock"]);
    assert_eq!(scaled.len(), 1, "{scaled:?}");
    ["g", "clock", "x'", "phi'"].iter().for_each(|name| assert!(scaled[0].contains(&name.to_string()), "{scaled:?}"));
    // gravity that is known is a clock
    assert!(of(&["clock"]).is_empty());
    let words = |more: &[&str]| asked(&sledge, CHETAEV, &["x", "y"], &[&start, more].concat()).1.words();
    assert!(
        !words(&["g"]).contains("known before")
            && words(&["g~9.81±0.1", "alpha"]).contains("with what is known before")
    );
    // which of its pieces a root is on is not asked
    let root = asked(&sledge, CHETAEV, &["sqrt(x^2)", "y"], &start).1;
    assert!(matches!(&root, Identifiability::Open(reason) if reason.contains("root")), "{root:?}");
    // an angle alone does not say where
    assert_eq!(hidden(&sledge, CHETAEV, &["phi"], &["x", "phi", "phi'"]), [["x"]]);
}

/// Ranks over a finite field are those of derivatives that are carried with motions.
#[test]
fn ranks_are_those_of_motions() {
    let mut found = [0, 0];
    let cases: [(&str, &[&str], &[&str]); 6] = [
        ("sledge", &["x", "y"], &["x", "y", "phi", "x'", "phi'", "g", "alpha", "k"]),
        ("heisenberg", &["x", "y"], &["x", "y", "z", "x'", "y'"]),
        ("turntable", &["x", "y"], &["x", "y", "x'", "y'", "psi'", "Omega", "m", "a"]),
        ("sleigh", &["x", "y", "phi"], &["x", "y", "phi", "x'", "phi'", "m", "J"]),
        ("rudder-skate", &["x", "y"], &["x", "y", "phi", "phi'"]),
        ("disc", &["x", "y"], &["x", "y", "phi", "theta", "theta'"]),
    ];
    for (name, columns, free) in cases {
        let scene = built_in(name);
        let names: Vec<String> = scene.system.coordinates.iter().map(|c| c.name.clone()).collect();
        let parameters = scene.system.parameters.iter().map(|p| scene.system.graph.name(p.symbol));
        let known: Vec<String> = names.into_iter().chain(scene.completion.given.clone()).chain(parameters).collect();
        let free: Vec<&str> = free.iter().copied().filter(|name| known.iter().any(|own| own == name)).collect();
        for formulation in [CHETAEV, VAKONOMIC] {
            let (mut problem, shown) = asked(&scene, formulation, columns, &free);
            // not at numbers that are special, as zero is
            let near = |(i, x): (usize, &f64)| x + 0.1 * (1.0 + i as f64).sqrt();
            let theta: Vec<f64> = problem.start().iter().enumerate().map(near).collect();
            problem.begin_at(&theta);
            let numbers = standard_errors(&problem, &theta).unwrap();
            let infinite = |i: &usize| numbers.errors[*i].is_infinite();
            let mut seen: Vec<&str> = (0..free.len()).filter(infinite).map(|i| free[i]).collect();
            let mut by_ranks: Vec<String> = match shown {
                Identifiability::Proved { .. } => Vec::new(),
                Identifiability::Hidden { combinations, .. } => combinations.concat(),
                Identifiability::Open(reason) => panic!("{name}: {reason}"),
            };
            seen.sort_unstable();
            by_ranks.sort_unstable();
            by_ranks.dedup();
            assert_eq!(by_ranks, seen, "{name} {}", formulation.name);
            found[usize::from(seen.is_empty())] += 1;
        }
    }
    assert!(found[0] >= 3 && found[1] >= 3, "{found:?}");
}

/// A straight run down a slope, `x = g sin α t²/2`, filmed by a clock that is 2 % slow: with gravity known,
/// it is the clock that is found.
#[test]
fn a_slow_clock_is_found() {
    let mut scene = built_in("sledge");
    (scene.start.q[2], scene.start.v) = (0.0, vec![0.0; 3]);
    scene.completion = Default::default();
    let down = 9.81 * 0.4_f64.sin();
    let film = film(&scene, "x,y", 1e-3, 5, &times(2.0), |t| vec![0.5 * down * (1.02 * t).powi(2), 0.0]);
    let rows = fitted(&scene, &[film], &["x", "clock"], &[]);
    let fit = rows[0].fit.as_ref().unwrap();
    let clock = fit.estimates.iter().find(|e| e.name == "clock").unwrap();
    assert!((clock.value - 0.02).abs() < 3.0 * clock.error && clock.error < 1e-4, "{clock:?}");
    // x(T) = 8 m is known to 1 mm or so: half that part of time, by the closed form of a parabola through 120
    // points
    let squares: f64 = times(2.0).iter().map(|t| (down * t * t * 1.02 / 1e-3).powi(2)).sum();
    let mean: f64 = times(2.0).iter().map(|t| down * t * t * 1.02 / 1e-3).sum();
    let known = (squares - mean * mean / 120.0).powf(-0.5);
    assert!((clock.error / known - 1.0).abs() < 1e-3, "{} for {known}", clock.error);
}
