//! Quasi-velocities in a frame against Maggi and costate form: bodies turn, roll, slide to the frame's end.

use motion::{CHETAEV, REDUCED_CHETAEV, REDUCED_VAKONOMIC, VAKONOMIC};
use std::cell::Cell;

use equations::Role;
use integrate::Method;
use proptest::prelude::*;
use reduction::Frame;
use scene::{Scene, SceneError};

use super::support::{derived, equations, known_gap, motion_of, must, scene, some_multipliers, tight};
use super::{reduced_form, reduced_vakonomic};

/// Bodies of revolution in Euler angles, and a plane in polar coordinates, with their given velocities.
const SCENES: [(&str, &[&str]); 5] = [
    (include_str!("../scenes/frame-0.toml"), &["psi'", "theta'", "phi'"]),
    (include_str!("../scenes/frame-1.toml"), &["psi'", "theta'", "phi'"]),
    (include_str!("../scenes/frame-2.toml"), &["psi'", "theta'", "phi'", "gamma'"]),
    (include_str!("../scenes/frame-3.toml"), &["r'", "gamma'"]),
    (include_str!("../scenes/frame-4.toml"), &["r'", "gamma'"]),
];

/// One of them with numbers `x` from −1 to 1.
fn framed(kind: usize, x: &[f64]) -> Result<Scene, SceneError> {
    let (text, velocities) = SCENES[kind];
    let parameters =
        [("m", 1.5 + x[10]), ("a", 0.7 + 0.5 * x[11]), ("A", 1.2 + x[12]), ("C", 1.2 + x[13]), ("k", x[14])];
    let places = [
        ("psi", 2.0 * x[0]),
        ("theta", 1.5 + x[1]),
        ("phi", x[2]),
        ("r", 1.5 + 0.5 * x[3]),
        ("gamma", x[4]),
        ("x", x[5]),
    ];
    let places = places.into_iter().filter(|(name, _)| text.contains(&format!("\n{name} = {{")));
    let velocities = velocities.iter().zip(&x[6..]).map(|(&name, x)| (name, 2.0 * x));
    let numbers = parameters.into_iter().chain(places).chain(velocities);
    Scene::parse_with("frame", text, &numbers.map(|(name, x)| (name.to_string(), x)).collect::<Vec<_>>())
}

#[test]
fn rates_in_a_frame_are_those_by_maggi_and_those_of_the_costate_form() {
    let (frames, worst) = (Cell::new([0_usize; 2]), Cell::new(0.0_f64));
    let config = ProptestConfig {
        cases: 200,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1904),
        ..ProptestConfig::default()
    };
    let strategy = (0_usize..5, proptest::collection::vec(-1.0_f64..1.0, 15));
    let outcome = proptest::test_runner::TestRunner::new(config).run(&strategy, |(kind, x)| {
        let scene = framed(kind, &x).map_err(|e| TestCaseError::fail(format!("{e}, kind {kind}, {x:?}")))?;
        let reduced = derived(&scene, REDUCED_CHETAEV, None, Some(&scene.start));
        let reduced = reduced.map_err(|e| TestCaseError::fail(e.to_string()))?;
        let (rates, velocities) = reduced_form::differences(&scene, &reduced, &scene.start);
        let others = reduced_vakonomic::differences(&scene, &some_multipliers(&scene));
        let [mut chetaev, mut any] = frames.get();
        chetaev += usize::from(reduced.chosen.iter().any(|words| words.contains("frame")));
        any += usize::from(Frame::new(&scene.system.clone(), Some(&scene.start)).is_some());
        frames.set([chetaev, any]);
        let found = [rates, velocities, others[0], others[1], others[2]].into_iter().fold(0.0, f64::max);
        worst.set(worst.get().max(found));
        prop_assert!(found < 1e-9, "{rates:e}, {velocities:e}, {others:?}\n{}", scene.to_toml());
        Ok(())
    });
    if let Err(error) = outcome {
        panic!("{error}");
    }
    let [chetaev, any] = frames.get();
    println!("largest difference {:.1e}; {any} frames, {chetaev} of them taken by Chetaev's equations", worst.get());
    assert!(any > 150 && chetaev > 60 && worst.get() > 0.0, "{any} frames, {chetaev} taken");
}

#[test]
fn balls_are_written_in_a_frame() {
    for name in ["ball-in-cone", "turntable"] {
        let scene = scene(name, &[]);
        for form in [REDUCED_CHETAEV, REDUCED_VAKONOMIC] {
            let equations = equations(&scene.system, form, None);
            assert!(
                equations.chosen.iter().any(|words| words.contains("sin(theta)")),
                "{name}: {:?}",
                equations.chosen
            );
            assert!(equations.states.iter().any(|y| matches!(y.role, Role::QuasiVelocity | Role::Costate)));
        }
    }
    // the constraint as printed contains 1/rho in the frame: at rho = 0 only the frame would end
    let printed = equations(&scene("ball-in-cone-as-printed", &[]).system, REDUCED_CHETAEV, None);
    assert!(printed.chosen.is_empty(), "{:?}", printed.chosen);
}

/// Near Euler's pole and the apex, where frame and mass matrix end, frames agree with multiplier forms.
#[test]
fn motions_near_the_ends_of_the_frame_are_those_of_the_multiplier_form() {
    let near: [(&str, &[(&str, f64)]); 5] = [
        ("ball-in-cone", &[("theta", 0.05)]),
        ("ball-in-cone", &[("theta", 3.1)]),
        ("ball-in-cone", &[("r", 0.2), ("gamma'", 0.5), ("r'", -0.8)]),
        ("turntable", &[("theta", 0.02)]),
        ("turntable", &[("theta", 3.13)]),
    ];
    for (name, overrides) in near {
        let scene = scene(name, overrides);
        for (form, reduced) in [(CHETAEV, REDUCED_CHETAEV), (VAKONOMIC, REDUCED_VAKONOMIC)] {
            let mu = if form == VAKONOMIC { some_multipliers(&scene) } else { Vec::new() };
            let whole = equations(&scene.system, form, None);
            let mut multiplier = motion_of(&scene, whole, &mu, &tight());
            for method in [Method::Dop853, Method::Taylor] {
                let settings = motion::Settings { method: Some(method), ..tight() };
                let reduced = equations(&scene.system, reduced, None);
                let mut framed = motion_of(&scene, reduced, &mu, &settings);
                let (gap, end) = known_gap(&mut multiplier, &mut framed);
                println!(
                    "{name} {overrides:?} {form:?} {method:?}: {gap:.1e} to {end:.2}; {:?}, {:?}",
                    framed.ending, multiplier.ending
                );
                must(&format!("{name} {overrides:?}: {form:?} in a frame by {method:?}, to {end:.2} s"), gap, 1e-7);
                assert!(end > 0.0);
            }
        }
    }
}
