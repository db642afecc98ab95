//! Energies and momenta that must stay constant, and those that must not (T6, T7).

use deltaq::{Metric, Motion};
use scene::Scene;
use symbolic::Expr;

use super::support::{
    chetaev, common_times, equations, motion_of, must, must_exceed, number, numbers, regular_removals, removed, scene,
    scenes, some_multipliers, state_at, tight, values,
};

/// How long the motions are followed, s. Appell and Hamel's comes to rest before.
fn ten_seconds(scene: &mut Scene) {
    scene.duration = if scene.name == "appell-hamel" { 1.2 } else { 10.0 };
}

/// Prints each invariant's drift over kinetic energy or the largest momentum on the way; fails over 1e-10.
fn must_keep(what: &str, scene: &Scene, motion: &mut Motion, needed: &[&str]) {
    let names: Vec<String> = motion.equations.invariants.iter().map(|i| i.name.clone()).collect();
    for name in needed {
        assert!(names.iter().any(|n| n == name), "{what}: {name} is not among the invariants {names:?}");
    }
    let times = common_times(&[motion]);
    let system = scene.system.clone();
    let momenta = system.graph.gradient(system.lagrangian, &system.velocities());
    let mut metric = Metric::new(&system).expect("compiles");
    let (mut kinetic, mut momentum) = (0.0_f64, 0.0_f64);
    for &t in &times {
        let state = state_at(motion, t);
        kinetic = kinetic.max(0.5 * metric.length(t, &state.q, &state.v, &state.v).powi(2));
        let values = values(&system, &state);
        momentum = numbers(&system.graph, &momenta, &values).iter().fold(momentum, |a, p| a.max(p.abs()));
    }
    let end = times[times.len() - 1];
    for (name, start, drift) in motion.invariant_drift(&times).expect("readable") {
        let scale = start.abs().max(if name == "energy" { kinetic } else { momentum });
        must(&format!("{what}, {name}, to {end:.2} s"), drift / scale, 1e-10);
    }
}

/// By start data: whether each constraint has one degree in the velocities, and whether time appears.
fn homogeneous(scene: &Scene) -> bool {
    let system = &scene.system;
    let state = &scene.start;
    let factor = 1.7;
    let stretched = mechanics::State {
        v: state.v.iter().enumerate().map(|(i, v)| factor * (v + 0.1 * i as f64)).collect(),
        ..state.clone()
    };
    let plain =
        mechanics::State { v: state.v.iter().enumerate().map(|(i, v)| v + 0.1 * i as f64).collect(), ..state.clone() };
    system.constraints.iter().all(|&f| {
        let value = |s| number(&system.graph, f, &values(system, s));
        let (one, two) = (value(&plain), value(&stretched));
        (1..=3).any(|degree| (two - factor.powi(degree) * one).abs() < 1e-12 * (1.0 + two.abs()))
    })
}

/// Coordinates that `L` contains neither itself nor, where `with_constraints`, `f`.
fn cyclic(scene: &Scene) -> Vec<String> {
    let system = &scene.system;
    let absent = |e: &Expr, i: usize| !system.graph.depends_on(*e, system.coordinates[i].position);
    let free = |i: &usize| std::iter::once(&system.lagrangian).chain(&system.constraints).all(|e| absent(e, *i));
    (0..system.dimension()).filter(free).map(|i| format!("momentum {}", system.coordinates[i].name)).collect()
}

#[test]
fn chetaev_keeps_energy_where_constraints_are_homogeneous() {
    for mut scene in scenes() {
        ten_seconds(&mut scene);
        let what = format!("{}, Chetaev", scene.name);
        let mut motion = motion_of(&scene, equations(&scene.system, "chetaev", None), &[], &tight());
        let named = motion.equations.invariants.iter().any(|i| i.name == "energy");
        assert_eq!(named, homogeneous(&scene), "{what}: energy named as an invariant");
        must_keep(&what, &scene, &mut motion, &[]);
    }
}

#[test]
fn vakonomic_keeps_energy_and_cyclic_momenta() {
    for mut scene in scenes() {
        ten_seconds(&mut scene);
        let cyclic = cyclic(&scene);
        let needed: Vec<&str> = cyclic.iter().map(String::as_str).chain(["energy"]).collect();
        for mu0 in [vec![0.0; scene.system.constraints.len()], some_multipliers(&scene)] {
            for name in ["vakonomic", "vakonomic-costate"] {
                let mut motion = motion_of(&scene, equations(&scene.system, name, None), &mu0, &tight());
                let zero = if mu0.iter().all(|&mu| mu == 0.0) { "μ₀ = 0" } else { "μ₀ ≠ 0" };
                must_keep(&format!("{}, {name}, {zero}", scene.name), &scene, &mut motion, &needed);
            }
        }
    }
}

#[test]
fn removed_constraint_keeps_its_energy() {
    for mut scene in scenes() {
        ten_seconds(&mut scene);
        for removal in regular_removals(&scene) {
            let count = equations(&scene.system, "removed-constraint", Some(&removal)).free_constants.len();
            let mut motion = removed(&scene, &removal, &vec![0.1; count]);
            must_keep(&format!("{}, removal {}", scene.name, removal.name), &scene, &mut motion, &["energy"]);
        }
    }
}

#[test]
fn removals_without_regular_equations_are_refused() {
    let choice = |scene: &Scene, name: &str| {
        let choices = deltaq::choices(scene);
        let wanted = choices.into_iter().find(|c| c.removal.as_ref().is_some_and(|r| r.name == name));
        deltaq::solve_choice(scene, &wanted.expect(name), &tight()).err().map(|e| e.to_string())
    };
    for (name, removal, words) in [("three-cylinders", "paper", "Hessian"), ("appell-hamel", "by-heading", "singular")]
    {
        let error = choice(&scene(name, &[]), removal);
        println!("{name}, removal {removal}: {error:?}");
        assert!(error.is_some_and(|e| e.contains(words)), "{name}, removal {removal}");
    }
}

/// Largest change of an expression in `(q, v)` along a motion.
fn change(scene: &Scene, motion: &mut Motion, e: Expr) -> f64 {
    let times = common_times(&[motion]);
    let mut value = |t: f64| number(&scene.system.graph, e, &values(&scene.system, &state_at(motion, t)));
    let start = value(times[0]);
    times.iter().map(|&t| (value(t) - start).abs()).fold(0.0, f64::max)
}

fn energy(scene: &Scene) -> Expr {
    let (system, g) = (&scene.system, &scene.system.graph);
    let v = system.velocities();
    g.sub(g.dot(&g.variables(&v), &g.gradient(system.lagrangian, &v)), system.lagrangian)
}

#[test]
fn energy_written_out_here_is_kept_or_not() {
    for mut scene in scenes() {
        ten_seconds(&mut scene);
        let e = energy(&scene);
        let mut motion = chetaev(&scene);
        let start = number(&scene.system.graph, e, &values(&scene.system, &scene.start)).abs().max(1.0);
        let drift = change(&scene, &mut motion, e) / start;
        let what = format!("{}, Chetaev: change of v·L_v − L, 10 s, over its start", scene.name);
        if scene.name == "turntable" {
            must_exceed(&what, drift, 1e-4);
        } else {
            must(&what, drift, 1e-10);
        }
    }
}

#[test]
fn momentum_of_a_cyclic_coordinate_is_not_kept_by_chetaev() {
    let scene = scene("sledge", &[]);
    assert_eq!(cyclic(&scene), ["momentum y"]);
    let (system, g) = (&scene.system, &scene.system.graph);
    let along_y = g.derivative(system.lagrangian, system.velocities()[1]);
    must_exceed("sledge, Chetaev: change of ∂L/∂v_y, 10 s", change(&scene, &mut chetaev(&scene), along_y), 1e-1);
}
