//! Closed forms, orders, and every error.

use mechanics::{Removal, Scene, State, System};
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
fn removed_sledge_has_its_costates() {
    // P_x' = −G_x = −g sin α and P_y' = 0, so that P_x = P_x(0) − g sin α t even on the grid; x alone is memory of weight here
    let scene = scene("sledge");
    let removal = scene.removals.iter().find(|r| r.name == "arc-length").unwrap();
    let at = RemovedStart::at(&scene.system, removal, &scene.start, &[2.0, -0.5]).unwrap();
    let mut discrete = Discrete::removed(&scene.system, removal, &at, 1.0, Ends::GivenStart).unwrap();
    let (steps, momenta) = (10, discrete.momenta(10).unwrap());
    for (k, p) in momenta.iter().enumerate() {
        let expected = 2.0 - 9.81 * 0.4_f64.sin() * k as f64 / steps as f64;
        assert!((p[2] + expected).abs() < 1e-12 && (p[3] - 0.5).abs() < 1e-12, "{p:?}");
    }
    // the natural end P(1) = 0 is P_x(0) = g sin α, P_y = 0, from whatever guess
    let momenta = Discrete::removed(&scene.system, removal, &at, 1.0, Ends::Natural).unwrap().momenta(10).unwrap();
    assert!((momenta[0][2] + 9.81 * 0.4_f64.sin()).abs() < 1e-12 && momenta[0][3].abs() < 1e-12, "{momenta:?}");
    assert!(momenta[10][2].abs() < 1e-13 && momenta[10][3].abs() < 1e-13, "{momenta:?}");
}

#[test]
fn a_nonlinear_constraint_needs_the_node_before_the_start() {
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
    let (system, start) = (&sledge.system, &sledge.start);
    let mut full = system.clone();
    full.constraints = vec![full.constraints[0]; 3];
    let refused = |error: Result<Discrete, DiscreteError>| error.unwrap_err();
    let e = refused(Discrete::chetaev(&full, start, 1.0));
    assert!(matches!(e, DiscreteError::NoFreedom { found: 3, limit: 3 }), "{e}");
    let e = refused(Discrete::vakonomic(system, start, &[], 1.0));
    assert!(matches!(e, DiscreteError::Length { what: "multipliers", found: 0, expected: 1 }), "{e}");
    let e = refused(Discrete::chetaev(system, &State { v: vec![0.0, 1.0, 0.0], ..start.clone() }, 1.0));
    assert!(matches!(e, DiscreteError::OffConstraint { found, limit: START_LIMIT } if found > 0.4), "{e}");
    let e = refused(Discrete::chetaev(system, start, f64::NAN));
    assert!(matches!(e, DiscreteError::NotFinite { what: "a time", .. }), "{e}");
    let mut unknown = system.clone();
    unknown.forces[0] = unknown.graph.variable(unknown.graph.symbol("nobody"));
    assert!(matches!(refused(Discrete::chetaev(&unknown, start, 1.0)), DiscreteError::Compile(_)));
    let mut pushed = system.clone();
    pushed.forces[1] = pushed.graph.one();
    let e = refused(Discrete::vakonomic(&pushed, start, &[0.0], 1.0));
    assert!(matches!(e, DiscreteError::Force { number: 2 }), "{e}");
    let cylinders = scene("three-cylinders");
    let paper = cylinders.removals.iter().find(|r| r.name == "paper").unwrap();
    let (m, k) = (paper.parameters.len(), paper.memory.len());
    let at = RemovedStart {
        t: 0.0,
        parameters: vec![1.0; m],
        rates: vec![1.0; m],
        memory: vec![0.0; k],
        costates: vec![0.0; k],
    };
    let e = refused(Discrete::removed(&cylinders.system, paper, &at, 1.0, Ends::GivenStart));
    assert!(matches!(&e, DiscreteError::HighRate { symbol, .. } if symbol == "u'"), "{e}");
    let off = State { v: vec![0.0, 1.0, 0.0], ..start.clone() };
    let e = RemovedStart::at(system, &sledge.removals[0], &off, &[0.0; 2]).unwrap_err();
    assert!(matches!(e, DiscreteError::Removal(_)), "{e}");

    let mut discrete = Discrete::chetaev(system, start, 1.0).unwrap();
    let e = discrete.positions(0).unwrap_err();
    assert!(matches!(e, DiscreteError::TooFew { found: 0, limit: 1, .. }), "{e}");
    let e = convergence(&mut discrete, 4, 1, |_| known(vec![0.0; 3])).unwrap_err();
    assert!(matches!(e, DiscreteError::TooFew { found: 1, limit: 2, .. }), "{e}");
    let e = convergence(&mut discrete, 4, 2, |_| Err::<Vec<f64>, _>("no")).unwrap_err();
    assert!(matches!(e, DiscreteError::Reference { t: 0.0, .. }), "{e}");
    let mut twice = system.clone();
    twice.constraints.push(twice.constraints[0]);
    let e = Discrete::chetaev(&twice, start, 1.0).unwrap().positions(3).unwrap_err();
    assert!(matches!(e, DiscreteError::Singular { t: 0.0 }), "{e}");
    // z'² = a²(x'² + y'²) at rest has no direction
    let hamel = scene("appell-hamel");
    let rest = State { v: vec![0.0; 3], ..hamel.start.clone() };
    let e = refused(Discrete::chetaev(&hamel.system, &rest, 1.0));
    assert!(matches!(e, DiscreteError::OffConstraint { found, .. } if found.is_nan()), "{e}");
    // with + 100 x⁷ in L the motion runs away in finite time, and no step of 1 follows it
    let (mut system, start) = oscillator();
    let g = &system.graph;
    let steep = g.mul(g.integer(100), g.powi(g.variable(g.symbol("x")), 7));
    let lagrangian = g.add(system.lagrangian, steep);
    system.lagrangian = lagrangian;
    let e = Discrete::chetaev(&system, &start, 3.0).unwrap().positions(3).unwrap_err();
    assert!(matches!(e, DiscreteError::NotConverged { .. } | DiscreteError::NotFinite { .. }), "{e}");
}
