//! A million steps.

use discrete::{Composition, Discrete, Drift, Ends, RemovedStart};
use scene::Scene;

const MILLION: usize = 1_000_000;

/// Parts of a run whose drifts are compared.
const PARTS: usize = 10;

fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/scenes");
    Scene::load(&std::path::Path::new(folder).join(name).with_extension("toml")).unwrap()
}

/// Runs to the end, keeps its constraints, and its energy error at the end is the one at the beginning.
fn must_not_drift(what: &str, drift: &Drift, energy: f64, trend: f64, constraint: f64) {
    assert_eq!((drift.steps, &drift.stop), (MILLION, &None), "{what}");
    assert!(drift.relative_energy() < energy, "{what}: {:e}", drift.relative_energy());
    assert!(drift.relative_trend() < trend, "{what}: {:e}, {:?}", drift.relative_trend(), drift.energy);
    assert!(drift.largest_constraint() < constraint, "{what}: {:e}", drift.largest_constraint());
    assert!(drift.discrete_constraint < constraint, "{what}: {:e}", drift.discrete_constraint);
}

#[test]
fn chetaev_sledge_swings_for_ever() {
    // its energy error is 4e-5 of a swing in every part of 20,000 s
    let scene = scene("sledge");
    let discrete = Discrete::chetaev(&scene.system, &scene.start, 0.02 * MILLION as f64).unwrap();
    let drift = discrete.drift(MILLION, PARTS).unwrap();
    must_not_drift("Chetaev, sledge, order 2", &drift, 1.2e-4, 1e-7, 1e-14);
}

#[test]
fn chetaev_keeps_its_energy_at_order_four() {
    // an integrable constraint: the particle swings in a bowl
    let scene = scene("bowl");
    let discrete = Discrete::chetaev(&scene.system, &scene.start, 0.02 * MILLION as f64).unwrap();
    let drift = discrete.composed(Composition::Fourth).drift(MILLION, PARTS).unwrap();
    must_not_drift("Chetaev, bowl, order 4", &drift, 5e-8, 1e-11, 1e-14);
}

#[test]
fn vakonomic_steps_neither_gain_nor_lose_energy() {
    let scene = scene("disc");
    let multipliers = vec![0.1; scene.system.constraints.len()];
    let discrete = Discrete::vakonomic(&scene.system, &scene.start, &multipliers, 0.01 * MILLION as f64).unwrap();
    let drift = discrete.drift(MILLION, PARTS).unwrap();
    must_not_drift("vakonomic, disc, order 2", &drift, 1e-3, 1e-5, 1e-11);
}

#[test]
fn round_off_of_a_million_steps_is_a_random_walk_of_increments() {
    // order 8 leaves nothing else: vakonomic circles, 2.5 turns in 1000 steps, and a removal's motion
    let scene = scene("heisenberg");
    let end = 0.02 * MILLION as f64;
    let circles = Discrete::vakonomic(&scene.system, &scene.start, &[0.8], end).unwrap();
    let removal = &scene.removals[0];
    let start = RemovedStart::at(&scene.system, removal, &scene.start, &[-0.8]).unwrap();
    let removed = Discrete::removed(&scene.system, removal, &start, end, Ends::GivenStart).unwrap();
    for (what, discrete) in [("vakonomic", circles), ("removed", removed)] {
        let drift = discrete.composed(Composition::Sixth).drift(MILLION, PARTS).unwrap();
        must_not_drift(&format!("{what}, heisenberg, order 6"), &drift, 1e-13, 1e-13, 1e-12);
    }
}

#[test]
fn a_motion_that_does_not_return_lets_the_energy_of_order_two_go() {
    // energy is kept on integrable reversible motions or by a symplectic form; here is neither, as measured
    let scene = scene("trailer");
    let discrete = Discrete::chetaev(&scene.system, &scene.start, 0.01 * 100_000.0).unwrap();
    let drift = discrete.drift(100_000, PARTS).unwrap();
    let trend = drift.relative_trend();
    assert!(trend > 1e-4 && trend < 1e-3, "{trend:e}");
    assert!(drift.largest_constraint() < 1e-14);
    let fourth = discrete.composed(Composition::Fourth).drift(100_000, PARTS).unwrap();
    assert!(fourth.relative_trend() < 1e-9);
}
