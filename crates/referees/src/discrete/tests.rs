//! Closed forms and orders.

use std::fmt::Display;

use mechanics::Removal;
use scene::Scene;

use super::*;
use crate::closed_forms::{Heisenberg, Sledge};

/// Errors under this are round-off.
const PLATEAU: f64 = 1e-11;

fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/scenes");
    Scene::load(&std::path::Path::new(folder).join(name).with_extension("toml")).unwrap()
}

/// Halves the step of `discrete`: its orders, `± 0.1` where errors are above round-off, then `reference`.
///
/// `least`: so many orders are measured, without extrapolation and extrapolated once.
fn tends_to<E: Display>(
    what: &str,
    mut discrete: Discrete,
    (steps, levels): (usize, usize),
    least: [usize; 2],
    reference: impl FnMut(f64) -> Result<Vec<f64>, E>,
) {
    let found = convergence(&mut discrete, steps, levels, reference).unwrap();
    for (column, least) in least.into_iter().enumerate() {
        let order = 2.0 * (column as f64 + 1.0);
        let orders = found.orders(column, PLATEAU);
        assert!(orders.len() >= least, "{what}: {:?}", found.errors);
        assert!(orders.iter().all(|o| (o - order).abs() < 0.1), "{what}: {orders:?} {:?}", found.errors);
    }
    assert!(found.difference < 1e-11, "{what}: {:?}", found.errors);
}

fn known(q: Vec<f64>) -> Result<Vec<f64>, DiscreteError> {
    Ok(q)
}

#[test]
fn chetaev_sledge_has_its_closed_form() {
    let scene = scene("sledge");
    let discrete = Discrete::chetaev(&scene.system, &scene.start, 1.5).unwrap();
    let start = Sledge { gravity_along: 9.81 * 0.4_f64.sin(), x: 0.0, y: 0.0, phi: 0.3, speed: 0.5, omega: 1.1 };
    tends_to("sledge", discrete, (20, 4), [3, 1], |t| {
        let at = start.at(t);
        known(vec![at.x, at.y, at.phi])
    });
}

#[test]
fn vakonomic_heisenberg_runs_on_circles() {
    let scene = scene("heisenberg");
    let start = Heisenberg { multiplier: 0.8, position: [0.5, 0.0, 0.0], velocity: [0.6, 0.8] };
    let discrete = Discrete::vakonomic(&scene.system, &scene.start, &[start.multiplier], 4.0).unwrap();
    tends_to("heisenberg", discrete, (30, 4), [3, 2], |t| known(start.at(t).to_vec()));
}

/// Two oscillators without a constraint.
const OSCILLATORS: &str = r#"
title = "Two oscillators"
[coordinates]
x = { start = 1 }
y = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 - x^2 - 4*y^2)/2"
constraints = []
[start]
time = 0.2
[start.velocities]
"x'" = 0.5
"y'" = 2
[run]
duration = 2
"#;

#[test]
fn oscillators_keep_time_by_all_three() {
    let Scene { system, start, .. } = Scene::parse("oscillators", OSCILLATORS).unwrap();
    let removal = Removal::by_coordinates(&system, &start).unwrap();
    let at = RemovedStart::at(&system, &removal, &start, &[]).unwrap();
    for (what, discrete) in [
        ("free, Chetaev", Discrete::chetaev(&system, &start, 2.2)),
        ("free, vakonomic", Discrete::vakonomic(&system, &start, &[], 2.2)),
        ("free, removed", Discrete::removed(&system, &removal, &at, 2.2, Ends::GivenStart)),
        ("free, backwards", Discrete::chetaev(&system, &start, -1.8)),
    ] {
        tends_to(what, discrete.unwrap(), (20, 4), [3, 2], |t| {
            let t = t - 0.2;
            known(vec![t.cos() + 0.5 * t.sin(), (2.0 * t).sin()])
        });
    }
}

#[test]
fn a_nonlinear_constraint_has_its_order_too() {
    // z'² = a²(x'² + y'²) in the potential −x y, so that the run bends.
    let mut scene = scene("appell-hamel");
    let bend = scene.system.expression("x*y").unwrap();
    scene.system.lagrangian = scene.system.graph.add(scene.system.lagrangian, bend);
    let (system, start) = (scene.system, scene.start);
    let discrete = Discrete::chetaev(&system, &start, 0.5).unwrap();
    let mut maggi = crate::maggi::Maggi::new(&system).unwrap();
    let mut motion = maggi.solve(&start, 0.5, 1e-13, crate::maggi::Form::Accelerations).unwrap();
    tends_to("nonlinear", discrete, (10, 5), [4, 2], |t| motion.state(t).map(|s| s.q));
}

#[test]
fn every_error_is_said() {
    let sledge = scene("sledge");
    let mut discrete = Discrete::chetaev(&sledge.system, &sledge.start, 1.0).unwrap();
    let e = convergence(&mut discrete, 4, 1, |_| known(vec![0.0; 3])).unwrap_err();
    assert!(matches!(e, DiscreteError::TooFew { found: 1, limit: 2, .. }), "{e}");
    let e = convergence(&mut discrete, 4, 2, |_| Err::<Vec<f64>, _>("no")).unwrap_err();
    assert!(matches!(e, DiscreteError::Reference { t: 0.0, .. }), "{e}");
}
