//! Closed forms and orders.

use mechanics::{Removal, State, System};
use scene::Scene;
use symbolic::Graph;

use super::*;

/// Errors under this are round-off.
const PLATEAU: f64 = 1e-11;

fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/scenes");
    Scene::load(&std::path::Path::new(folder).join(name).with_extension("toml")).unwrap()
}

/// Every measured order above round-off is `order ± 0.1`, and at least `least` of them are measured.
fn assert_orders(what: &str, found: &Convergence, column: usize, least: usize) {
    let order = 2.0 * (column as f64 + 1.0);
    let orders = found.orders(column, PLATEAU);
    println!(
        "{what}, extrapolated {column} times: orders {orders:.3?}, then {:.1e} ± {:.1e}",
        found.difference, found.estimate
    );
    assert!(orders.len() >= least, "{what}: {:?}", found.errors);
    assert!(orders.iter().all(|o| (o - order).abs() < 0.1), "{what}: {orders:?} {:?}", found.errors);
}

fn known(q: Vec<f64>) -> Result<Vec<f64>, DiscreteError> {
    Ok(q)
}

#[test]
fn chetaev_sledge_has_its_closed_form() {
    let scene = scene("sledge");
    let mut discrete = Discrete::chetaev(&scene.system, &scene.start, 1.5).unwrap();
    // mathematics: φ = φ₀ + ωt, v = v₀ + k (sin φ − sin φ₀), x and y by elementary integrals, k = g sin α/ω
    let (phi0, omega, speed) = (0.3_f64, 1.1, 0.5);
    let k = 9.81 * 0.4_f64.sin() / omega;
    let c = speed - k * phi0.sin();
    let x = |phi: f64| (c * phi.sin() + k * phi.sin().powi(2) / 2.0) / omega;
    let y = |phi: f64| (-c * phi.cos() + k * (phi / 2.0 - (2.0 * phi).sin() / 4.0)) / omega;
    let exact = |t: f64| known(vec![x(phi0 + omega * t) - x(phi0), y(phi0 + omega * t) - y(phi0), phi0 + omega * t]);
    let found = convergence(&mut discrete, 20, 4, exact).unwrap();
    assert_orders("sledge", &found, 0, 3);
    assert_orders("sledge", &found, 1, 1);
    assert!(found.difference < 1e-12, "{:?}", found.errors);
}

#[test]
fn vakonomic_heisenberg_runs_on_circles() {
    let scene = scene("heisenberg");
    let mu = 0.8;
    let mut discrete = Discrete::vakonomic(&scene.system, &scene.start, &[mu], 4.0).unwrap();
    // the velocity (0.6, 0.8) turns at the rate μ; z' = (x y' − y x')/2
    let exact = |t: f64| {
        let (s, c) = ((mu * t).sin() / mu, (1.0 - (mu * t).cos()) / mu);
        let (dx, dy) = (0.6 * s - 0.8 * c, 0.6 * c + 0.8 * s);
        // the segment of the circle over its chord, and the triangle that the chord makes with the origin
        let z = (t - (mu * t).sin() / mu) / (2.0 * mu) + 0.5 * 0.5 * dy;
        known(vec![0.5 + dx, dy, z])
    };
    let found = convergence(&mut discrete, 30, 4, exact).unwrap();
    assert_orders("heisenberg", &found, 0, 3);
    assert_orders("heisenberg", &found, 1, 2);
    assert!(found.difference < 1e-11, "{:?}", found.errors);
}

/// `L = (x'² − x²)/2`, without constraints, as a removal of its own.
fn oscillator() -> (System, State) {
    let mut system = System::new(Graph::new(), &[("x", "m"), ("y", "m")]);
    let g = &system.graph;
    let square = |name: &str| g.powi(g.variable(g.symbol(name)), 2);
    let both = g.sum(&[square("x'"), square("y'"), g.neg(square("x")), g.mul(g.integer(-4), square("y"))]);
    let lagrangian = g.div(both, g.integer(2));
    system.lagrangian = lagrangian;
    (system, State { t: 0.2, q: vec![1.0, 0.0], v: vec![0.5, 2.0] })
}

#[test]
fn oscillators_keep_time_by_all_three() {
    let (system, start) = oscillator();
    let removal = Removal::by_coordinates(&system, &start).unwrap();
    let at = RemovedStart::at(&system, &removal, &start, &[]).unwrap();
    for (what, discrete) in [
        ("free, Chetaev", Discrete::chetaev(&system, &start, 2.2)),
        ("free, vakonomic", Discrete::vakonomic(&system, &start, &[], 2.2)),
        ("free, removed", Discrete::removed(&system, &removal, &at, 2.2, Ends::GivenStart)),
        ("free, backwards", Discrete::chetaev(&system, &start, -1.8)),
    ] {
        let exact = |t: f64| {
            let t = t - 0.2;
            known(vec![t.cos() + 0.5 * t.sin(), (2.0 * t).sin()])
        };
        let found = convergence(&mut discrete.unwrap(), 20, 4, exact).unwrap();
        assert_orders(what, &found, 0, 3);
        assert_orders(what, &found, 1, 2);
        assert!(found.difference < 1e-11, "{what}: {:?}", found.errors);
    }
}

#[test]
fn a_nonlinear_constraint_has_its_order_too() {
    // z'² = a²(x'² + y'²) in the potential −x y, so that the run bends.
    let mut scene = scene("appell-hamel");
    let g = &scene.system.graph;
    let bend = g.mul(g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    let lagrangian = g.add(scene.system.lagrangian, bend);
    scene.system.lagrangian = lagrangian;
    let (system, start) = (scene.system, scene.start);
    let mut discrete = Discrete::chetaev(&system, &start, 0.5).unwrap();
    let mut maggi = crate::maggi::Maggi::new(&system).unwrap();
    let mut motion = maggi.solve(&start, 0.5, 1e-13, crate::maggi::Form::Accelerations).unwrap();
    let found = convergence(&mut discrete, 10, 5, |t| motion.state(t).map(|s| s.q)).unwrap();
    assert_orders("nonlinear", &found, 0, 4);
    assert_orders("nonlinear", &found, 1, 2);
    assert!(found.difference < 1e-11, "{:?}", found.errors);
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
