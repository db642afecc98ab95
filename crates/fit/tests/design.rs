//! The best film is found: against closed forms, and without a hint.

use fit::{Aim, Design, Deviations, EXCLUDED, Film, FitError, Question, Range, Sampling, Unknown};
use motion::{CHETAEV, Settings, VAKONOMIC};
use scene::Scene;

use crate::bounds::{closed, laboratory};
use crate::films::built_in;

fn unknowns(list: &[&str]) -> Vec<Unknown> {
    list.iter().map(|text| text.parse().unwrap()).collect()
}

fn ranges(list: &[&str]) -> Vec<Range> {
    list.iter().map(|text| text.parse().unwrap()).collect()
}

fn film(scene: &Scene, columns: &[&str], times: &str) -> Film {
    let columns: Vec<String> = columns.iter().map(|name| name.to_string()).collect();
    Film::planned(scene, &columns, times.parse().unwrap(), &Deviations::default()).unwrap()
}

fn question(unknowns: &[Unknown], starts: usize) -> Question<'_> {
    Question {
        unknowns,
        law: &[],
        starts,
        robust: None,
        settings: Settings { tolerance: 1e-9, ..Settings::default() },
        threads: 0,
    }
}

/// With an unknown drag two balls without spin show almost nothing of ε: one without spin beside one with
/// twice the rate of the table show it some fifty times as well.
#[test]
fn the_second_ball_is_spun_without_a_hint() {
    let scene = laboratory();
    let films = vec![film(&scene, &["x", "y"], "60Hz,0.5mm,10s"); 2];
    let free = unknowns(&["x", "y", "x'", "y'", "Omega", "tilt_x", "tilt_y", "epsilon", "drag~0±0.005"]);
    let aim = Aim::Estimate("epsilon".into());
    let design = Design::new(&scene, &films, &question(&free, 1), &ranges(&["psi'=0:6"]), &aim).unwrap();
    let best = design.best(4, 0).unwrap();
    let own = best.own.unwrap();
    assert_eq!(own.at, [0.0, 0.0]);
    let mut spins = best.best.at.clone();
    spins.sort_by(f64::total_cmp);
    assert_eq!(spins, [0.0, 6.0]);
    for (point, spins) in [(&own, [0.0, 0.0]), (&best.best, [0.0, 6.0])] {
        let known = closed(&spins, Some(0.005));
        assert!((point.value / known - 1.0).abs() < 1e-3, "{spins:?}: {} for {known}", point.value);
    }
    assert!(own.value > 40.0 * best.best.value, "{} and {}", own.value, best.best.value);
    assert_eq!(best.without_motion, 0);
}

/// χ² of the straight line closest to an arc of rate μ and unit speed, start and velocity free: it misses
/// `μ t²/2` across, and the square of the part of `t²/2` orthogonal to 1 and t has the integral `T⁵/720`.
fn arc(mu: f64, samples: f64, length: f64, sigma: f64) -> f64 {
    samples * (mu * length * length / sigma).powi(2) / 720.0
}

#[test]
fn the_shortest_film_is_that_of_the_closed_form() {
    let scene = built_in("heisenberg");
    let scene = Scene { multipliers: vec![1e-3], ..scene };
    let films = [film(&scene, &["x", "y"], "60Hz,1mm,6s")];
    let free = unknowns(&["x", "y", "x'", "y'"]);
    let aim = Aim::Tell(VAKONOMIC, CHETAEV);
    let design = Design::new(&scene, &films, &question(&free, 2), &ranges(&["mu0_1=1e-3:2e-3"]), &aim).unwrap();
    let best = design.best(4, 0).unwrap();
    assert_eq!((best.own.unwrap().at, best.best.at.clone()), (vec![1e-3], vec![2e-3]));
    // μ₀ is the rate of the circle by T9; its sign does not matter here
    for point in [design.point(&[1e-3]).unwrap(), best.best] {
        // Chetaev's equations have no number that a start could move
        assert!(point.by_starts.iter().all(|(_, value)| *value == point.value), "{point:?}");
        let known = arc(point.at[0], 360.0, 6.0, 1e-3);
        assert!((point.value / known - 1.0).abs() < 0.02, "{point:?} for {known}");
    }
    let (length, point) = design.shortest(&[2e-3]).unwrap();
    assert!(point.value >= EXCLUDED && point.by_starts.len() == 3, "{point:?}");
    let known = arc(2e-3, 60.0 * length, length, 1e-3);
    assert!((known / EXCLUDED - 1.0).abs() < 0.1, "{length} s has {known}");
    // a straight line is vakonomic, too: no film tells Chetaev's motion from it
    let aim = Aim::Tell(CHETAEV, VAKONOMIC);
    let design = Design::new(&scene, &films, &question(&free, 2), &[], &aim).unwrap();
    let best = design.best(4, 0).unwrap();
    assert!(best.best.value < 1e-6 && best.tried == 1, "{:?}", best.best);
    assert_eq!(design.shortest(&[]), None);
}

/// Each of Chetaev's motions of the disc and of the velocity pendulum is vakonomic for some μ₀: no film tells
/// them apart, from half of the starts, from all and from twice as many.
#[test]
fn a_rival_that_contains_the_motion_is_no_distance_away() {
    for name in ["disc", "velocity-pendulum"] {
        let scene = built_in(name);
        let films = [film(&scene, &[], "4Hz,1mm,10s")];
        let (free, aim) = (unknowns(&["start"]), Aim::Tell(CHETAEV, VAKONOMIC));
        let design = Design::new(&scene, &films, &question(&free, 4), &[], &aim).unwrap();
        let point = design.point_again(&[]).unwrap();
        assert_eq!(point.by_starts.iter().map(|(starts, _)| *starts).collect::<Vec<_>>(), [2, 4, 8]);
        assert!(point.by_starts.iter().all(|(_, value)| *value < 1e-3), "{name}: {point:?}");
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let scene = built_in("heisenberg");
    let times = |text: &str| text.parse::<Sampling>().unwrap_err().to_string();
    assert!(times("60Hz,1mm").contains("there is no length"));
    assert!(times("60Hz,1s,2s").contains("the length is there twice"));
    assert!(times("-1Hz,1s").contains("the rate is -1; it must be above 0"));
    assert!(times("1e6Hz,1s").contains("it has 1000000 samples"));
    assert!("x=1:1".parse::<Range>().unwrap_err().to_string().contains("below the second"));
    assert!("x".parse::<Range>().unwrap_err().to_string().contains("NAME=LOW:HIGH"));
    let none = Film::planned(&scene, &[], "60Hz,1s".parse().unwrap(), &Deviations::default());
    assert_eq!(none, Err(FitError::NoDeviation("x".into())));
    let films = [film(&scene, &["x", "y"], "60Hz,1mm,1s")];
    let free = unknowns(&["x"]);
    let refused = |over: &[&str], name: &str| {
        let aim = Aim::Estimate(name.into());
        Design::new(&scene, &films, &question(&free, 1), &ranges(over), &aim).err().unwrap().to_string()
    };
    assert!(refused(&["mu0_1=0:1"], "x").contains("`mu0_1` cannot be chosen"));
    assert!(refused(&["y=0:1"], "y").contains("it is not free"));
}
