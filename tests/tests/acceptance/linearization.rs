//! Steady motions of the literature: eigenvalues and critical speeds that are known otherwise.

use linear::{Eigenvalue, LinearError, find_steady, linearize, linearize_at, sweep};
use mechanics::ConstantsRule;
use motion::{KAPPA, Settings, choices, setting};
use scene::Scene;
use serde_json::json;

use super::support::{must, scene};

fn eigenvalues(scene: &Scene, free: &[&str]) -> Vec<Eigenvalue> {
    let found = linearize(setting(scene), &choices(scene)[0]).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    found.part(free).unwrap_or_else(|error| panic!("{}: {error}", scene.name)).eigenvalues
}

/// 44 eigenvalues and two speeds within 1e-12 of those in 50 digits. The committed verdicts are those of a
/// fresh run: `cargo xtask reports` compares them.
#[test]
fn the_bicycle_is_that_of_the_paper() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../reports/verdicts.json"));
    let verdicts: serde_json::Value = serde_json::from_str(&text.expect("verdicts")).expect("verdicts");
    assert_eq!(verdicts["bicycle"], json!({ "eigenvalues": "agree", "speeds": "agree" }));
}

#[test]
fn a_bicycle_that_is_pushed_is_not_steady() {
    let pushed = scene("bicycle", &[("lean'", 0.5)]);
    let error = linearize(setting(&pushed), &choices(&pushed)[0]).expect_err("it falls");
    assert!(matches!(error, LinearError::NotSteady { .. }), "{error}");
    let frozen = linearize_at(setting(&pushed), &choices(&pushed)[0], 0.2, &Settings::default()).expect("runs");
    assert!(!frozen.is_steady && frozen.spectrum.blocks.iter().any(|block| block.eigenvalues.len() >= 4));
}

/// With lean θ and heading φ: J φ'' = I ψ' θ', (J + m R²) θ'' = m g R θ − (I + m R²) ψ' φ'. So beside zero
/// λ² = (m g R − I (I + m R²) ψ'²/J)/(J + m R²), and the disc is stable for v² > g R/3.
#[test]
fn a_disc_rolls_upright_where_it_is_fast_enough() {
    let upright = [("theta", 0.0), ("theta'", 0.0), ("phi'", 0.0)];
    let (m, g, r, axle, across) = (1.0, 9.81, 0.5, 0.125, 0.0625);
    for spin in [0.0, 1.0, 2.0, 3.0, 8.0] {
        let disc = scene("falling-disc", &[&upright[..], &[("psi'", spin)]].concat());
        let found = eigenvalues(&disc, &["theta"]);
        let square: f64 = (m * g * r - axle * (axle + m * r * r) * spin * spin / across) / (across + m * r * r);
        assert_eq!(found.len(), 2, "{found:?}");
        for e in &found {
            must(&format!("λ² at {spin} rad/s"), ((e.value * e.value).re - square).abs() / square.abs(), 1e-12);
            must("imaginary part of λ²", (e.value * e.value).im.abs(), 1e-12);
        }
    }
    let disc = scene("falling-disc", &upright);
    let found = sweep(&disc, &choices(&disc)[0], &["theta"], ("psi'", &[1.0, 6.0]), false).expect("steady");
    let [change] = &found.changes[..] else { panic!("{:?}", found.changes) };
    must("critical speed of the disc", (change.value * r - (g * r / 3.0).sqrt()).abs(), 1e-9);
}

/// A steady turn that is found: the disc rolls on a circle, leaning inwards.
#[test]
fn a_disc_finds_its_circle() {
    let leaning = scene("falling-disc", &[]);
    let state = find_steady(setting(&leaning)).expect("a steady turn");
    let turning = Scene { start: state, ..leaning };
    let found = linearize(setting(&turning), &choices(&turning)[0]).expect("steady");
    let rates: Vec<&str> = found.carried.iter().map(|c| &c.name[..]).collect();
    assert_eq!(rates, ["x", "y", "phi", "psi"]);
    // lean and both turns go on after a while as they began
    let mut motion = motion::solve_choice(&turning, &choices(&turning)[0], &Settings::default()).expect("runs");
    let (start, end) = (turning.start.clone(), motion.at(1.0).expect("complete"));
    must("lean after 1 s", (end.coordinates[3] - start.q[3]).abs(), 1e-9);
    must("turn after 1 s", (end.velocities[2] - start.v[2]).abs(), 1e-9);
}

/// Turned the other way, time runs backwards: what grew decays. One mode grows one way, the other mode the
/// other way, and not as fast: so it has a way.
#[test]
fn a_rattleback_has_its_way() {
    let [one, other] = [3.0, -3.0].map(|spin| {
        let rest = [("psi'", spin), ("alpha'", 0.0), ("beta'", 0.0)];
        eigenvalues(&scene("rattleback", &rest), &["alpha", "beta"])
    });
    let growth = |list: &[Eigenvalue]| list.iter().map(|e| e.value.re).fold(0.0, f64::max);
    assert_eq!(one.len(), 4);
    assert!(growth(&one) > 5.0 * growth(&other) && growth(&other) > 0.1, "{one:?}, {other:?}");
    for e in &one {
        let away = other.iter().map(|o| (o.value + e.value).norm()).fold(f64::INFINITY, f64::min);
        must("λ against −λ of the other spin", away, 1e-12);
    }
}

/// Where the constraint can be integrated, every eigenvalue of Chetaev's equations is one of the vakonomic.
#[test]
fn an_equilibrium_in_a_bowl_is_the_same_for_all() {
    let rest = scene("bowl", &[("x", 0.0), ("y", 0.0), ("x'", 0.0), ("y'", 0.0)]);
    let known = [0.8, 1.3].map(|k: f64| (9.81 * k).sqrt());
    for mut choice in choices(&rest).into_iter().filter(|c| c.formulation != KAPPA) {
        choice.constants =
            if choice.formulation.starts_multipliers { ConstantsRule::Given(vec![0.0]) } else { ConstantsRule::Zero };
        let found = linearize(setting(&rest), &choice).unwrap_or_else(|error| panic!("{}: {error}", choice.label));
        let found = found.part(&[]).expect("all").eigenvalues;
        for k in known {
            let nearest = found.iter().map(|e| (e.value.im.abs() - k).abs()).fold(f64::INFINITY, f64::min);
            must(&format!("{}: {k} rad/s", choice.label), nearest, 1e-7);
        }
    }
}
