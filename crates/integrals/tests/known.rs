//! What is known from the literature, of measures and of integrals without an ansatz.

use std::time::Instant;

use integrals::{Cyclic, Measure, Open, Reversed, reversible};

use crate::questions::{built_in, start};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Volume {
    None,
    Written,
    Some,
}

fn asked(name: &str, overrides: &[(&str, &str)], degree: usize) -> Reversed {
    let scene = built_in(name, overrides);
    reversible(&scene.system, &start(&scene), degree)
}

fn volume(measure: &Measure) -> Option<Volume> {
    Some(match measure {
        Measure::None { proved: true } => Volume::None,
        Measure::Local { density: Some(_), .. } => Volume::Written,
        Measure::Local { density: None, .. } => Volume::Some,
        Measure::None { proved: false } | Measure::Open(_) => return None,
    })
}

/// Measures: Kozlov 1988 (Suslov), Chaplygin 1903 and 1911, Fedorov, García-Naranjo & Marrero 2015.
///
/// Integrals are counted near a point, with coefficients that may depend on every coordinate: the angular
/// momentum of a ball about its point of contact has three components that are constant in space; only `K·γ`
/// remains if attitude is ignored. A rubber ball has the two horizontal ones. Suslov's body about a principal
/// axis turns uniformly: two parts of `ω` stay in the body, three in space. A homogeneous ball has three
/// parts of `ω` in space, three in the ball, and the moment of its velocity. Where the energy is kinetic and
/// the momenta obey linear equations over an angle (sleigh, roller racer) the solutions of these are
/// integrals, without a period: two for two momenta.
#[test]
fn measures_and_linear_integrals() {
    for (name, overrides, measure, linear) in [
        ("sleigh", &[][..], Volume::None, 2),
        ("suslov", &[], Volume::None, 0),
        ("suslov", &[("K", "0")], Volume::Written, 5),
        ("veselova", &[], Volume::Written, 2),
        ("chaplygin-sphere", &[], Volume::Written, 3),
        ("chaplygin-sphere", &[("I2", "0.1"), ("I3", "0.1")], Volume::Written, 7),
        ("rubber-chaplygin-sphere", &[], Volume::Written, 2),
        ("routh-sphere", &[], Volume::Some, 2),
        ("roller-racer", &[], Volume::None, 2),
        ("heisenberg", &[], Volume::Written, 5),
        ("disc", &[], Volume::Written, 6),
    ] {
        let begun = Instant::now();
        let found = asked(name, overrides, 1);
        println!("{name} {overrides:?}: {found:?} {:.2} s", begun.elapsed().as_secs_f64());
        assert_eq!(volume(&found.measure), Some(measure), "{name} {overrides:?}");
        let integrals = found.integrals[0].clone().unwrap_or_else(|open| panic!("{name}: {open}"));
        assert_eq!((integrals.count, integrals.trivial, integrals.settled), (linear, 0, true), "{name} {overrides:?}");
    }
}

/// The carriage with its mass centre ahead of the axle turns about, as the sleigh does: divergence of the
/// reduced equations is `−k v`, with `v = R (ψ₁' + ψ₂')/2`. On the angles of the wheels `e^{k (ψ₁ + ψ₂)}` is
/// a density, though not a periodic one.
#[test]
fn a_measure_may_be_that_of_turned_wheels_alone() {
    let cyclic = |overrides: &[(&str, &str)]| match asked("two-wheeled-carriage", overrides, 0).measure {
        Measure::Local { density, cyclic } => (density.is_some(), cyclic),
        other => panic!("{other:?}"),
    };
    assert_eq!(cyclic(&[]), (false, Some(Cyclic { places: vec![0, 1, 3, 4], proved: true })));
    assert_eq!(cyclic(&[("l", "0")]), (true, None));
}

#[test]
fn what_has_no_answer_says_why() {
    for (name, open) in
        [("turntable", Open::NotHomogeneous), ("pursuit", Open::Time), ("sledge-with-friction", Open::Forces)]
    {
        let found = asked(name, &[], 1);
        assert_eq!(found.measure, Measure::Open(open.clone()));
        assert_eq!(found.integrals, [Err(open)]);
    }
}

/// One of its three constraints is integrable: brackets stay on its leaves, and a minor of their size is a
/// proof.
#[test]
fn the_rattleback_has_no_measure() {
    assert_eq!(volume(&asked("rattleback", &[], 0).measure), Some(Volume::None));
}
