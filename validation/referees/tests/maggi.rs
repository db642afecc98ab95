//! Checks of the referee itself: closed solutions, Gauss's principle, momenta by differences, errors.

use integrate::Status;
use mechanics::{State, System};
use referees::closed_forms::{Sledge, SledgeState};
use referees::maggi::{Maggi, MaggiError, Residual};
use scene::Scene;

const SLEDGE: &str = include_str!("../../../crates/scene/scenes/sledge.toml");
const APPELL_HAMEL: &str = include_str!("../../../crates/scene/scenes/appell-hamel.toml");

/// Everything at once: a mass matrix that depends on the configuration, a gyroscopic term, time in L and in
/// f, a force, two affine constraints.
const GENERAL: &str = r#"
title = "Four coordinates"
[coordinates]
a = { start = 0.3 }
b = { start = -0.4 }
c = { start = 0.7 }
d = { start = 0.2 }
[system]
lagrangian = """
    (1 + b^2)*a'^2/2 + b'^2 + (2 + sin(a))*c'^2/2 + 3*d'^2/2 + 3*cos(c)*a'*d'/10
    + a*b' + t*sin(b)*c' - (a^2 + 2*b^2 + c*d + d^4)/2"""
constraints = ["2*a' + cos(t)*b' + c*d' - sin(2*t)", "c' - (2 + a*b)*d' + t*b/2"]
[system.forces]
b = "-b'/5"
d = "cos(3*t) + a"
[start.velocities]
"a'" = 0.5
"d'" = -0.3
[run]
duration = 3
"#;

type Four = [f64; 4];

fn scene(text: &str, overrides: &[(&str, f64)]) -> Scene {
    let overrides: Vec<(String, f64)> = overrides.iter().map(|&(name, value)| (name.into(), value)).collect();
    Scene::parse_with("test", text, &overrides).unwrap()
}

fn general_lagrangian(t: f64, [a, b, c, d]: Four, [va, vb, vc, vd]: Four) -> f64 {
    let kinetic = (1.0 + b * b) * va * va / 2.0
        + vb * vb
        + (2.0 + a.sin()) * vc * vc / 2.0
        + 1.5 * vd * vd
        + 0.3 * c.cos() * va * vd;
    kinetic + a * vb + t * b.sin() * vc - (a * a + 2.0 * b * b + c * d + d.powi(4)) / 2.0
}

fn general_constraints(t: f64, [a, b, c, _]: Four, [va, vb, vc, vd]: Four) -> [f64; 2] {
    [2.0 * va + t.cos() * vb + c * vd - (2.0 * t).sin(), vc - (2.0 + a * b) * vd + t * b / 2.0]
}

/// Two displacements that the constraints allow, from a choice of (δb, δd).
fn general_displacements(t: f64, [a, b, c, _]: Four) -> [Four; 2] {
    [(1.0, 0.0), (0.0, 1.0)].map(|(db, dd)| [-(t.cos() * db + c * dd) / 2.0, db, (2.0 + a * b) * dd, dd])
}

/// M and F of the general system, by hand.
fn general_by_hand(t: f64, [a, b, c, d]: Four, [va, vb, vc, vd]: Four) -> ([Four; 4], Four) {
    let e = 0.3 * c.cos();
    let mass = [[1.0 + b * b, 0.0, 0.0, e], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 2.0 + a.sin(), 0.0], [e, 0.0, 0.0, 3.0]];
    let slope = -0.3 * c.sin() * vc;
    let force = [
        a.cos() * vc * vc / 2.0 + vb - a - 2.0 * b * vb * va - slope * vd,
        b * va * va + t * b.cos() * vc - 2.0 * b - va - vb / 5.0,
        -0.3 * c.sin() * va * vd - d / 2.0 - a.cos() * va * vc - t * b.cos() * vb - b.sin(),
        -c / 2.0 - 2.0 * d.powi(3) - slope * va + (3.0 * t).cos() + a,
    ];
    (mass, force)
}

fn four(values: &[f64]) -> Four {
    values.try_into().unwrap()
}

/// Central difference with one step of extrapolation, order 4.
fn slope(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    let central = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    (4.0 * central(h / 2.0) - central(h)) / 3.0
}

fn shifted(mut x: Four, i: usize, by: f64) -> Four {
    x[i] += by;
    x
}

/// `x`, `y`, `φ` and their rates of the sledge.
fn sledge(t: f64, omega: f64) -> [f64; 6] {
    let start = Sledge { gravity_along: 9.81 * 0.4_f64.sin(), x: 0.0, y: 0.0, phi: 0.3, speed: 0.5, omega };
    let SledgeState { x, y, phi, speed, .. } = start.at(t);
    [x, y, phi, speed * phi.cos(), speed * phi.sin(), omega]
}

#[test]
fn sledge_follows_its_closed_solution() {
    for omega in [1.1, 0.2] {
        let scene = scene(SLEDGE, &[("phi'", omega)]);
        let mut motion = Maggi::new(&scene.system).unwrap().solve(&scene.start, 5.0, 1e-13).unwrap();
        assert_eq!(motion.ending(), &Status::Completed);
        let state = motion.state(5.0).unwrap();
        for (found, expected) in state.q.iter().chain(&state.v).zip(sledge(5.0, omega)) {
            let error = (found - expected).abs() / (1.0 + expected.abs());
            assert!(error < 1e-11, "{omega} rad/s: {found}, expected {expected}");
        }
    }
}

#[test]
fn general_accelerations_are_least_constrained() {
    let scene = scene(GENERAL, &[]);
    let mut maggi = Maggi::new(&scene.system).unwrap();
    for k in 0..20 {
        let value = |i: usize| (1.7 * (k * 8 + i) as f64 + 0.3).sin();
        let (q, v): (Four, Four) = (std::array::from_fn(value), std::array::from_fn(|i| 2.0 * value(i + 4)));
        let t = 0.37 * k as f64;
        let a = four(&maggi.accelerations(t, &q, &v).unwrap());
        let (mass, force) = general_by_hand(t, q, v);
        // ½ (a − M⁻¹F)ᵀ M (a − M⁻¹F) without the constant term.
        let constraint_measure = |a: Four| (0..4).map(|i| a[i] * (dot(&mass[i], &a) / 2.0 - force[i])).sum::<f64>();
        for displacement in general_displacements(t, q) {
            let moved = |s: f64| constraint_measure(std::array::from_fn(|i| a[i] + s * displacement[i]));
            assert!(moved(0.1) > moved(0.0) && moved(-0.1) > moved(0.0), "point {k}: not the least");
            let lopsided = (moved(0.1) - moved(-0.1)).abs() / (1.0 + length_of(&force));
            assert!(lopsided < 1e-13, "point {k}: {lopsided}");
        }
        let along = |s: f64| {
            let q = std::array::from_fn(|i| q[i] + s * (v[i] + s * a[i] / 2.0));
            general_constraints(t + s, q, std::array::from_fn(|i| v[i] + s * a[i]))
        };
        for i in 0..2 {
            let rate = slope(|s| along(s)[i], 1e-2);
            assert!(rate.abs() < 1e-6 * (1.0 + length_of(&a)), "point {k}, constraint {i}: {rate}");
        }
        let Residual { dynamics, constraint } = maggi.residual(t, &q, &v, &a).unwrap();
        assert!(dynamics < 1e-15 && constraint < 1e-15, "point {k}: {dynamics}, {constraint}");
        // 1e-3 along an allowed displacement is seen by the dynamics only, and is of that order.
        let d = general_displacements(t, q)[0];
        let wrong: Four = std::array::from_fn(|i| a[i] + 1e-3 * d[i]);
        let seen = maggi.residual(t, &q, &v, &wrong).unwrap();
        assert!(seen.constraint < 1e-15 && seen.dynamics > 1e-6, "point {k}: {seen:?}");
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length_of(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[test]
fn general_motion_balances_momenta_and_keeps_its_constraints() {
    let scene = scene(GENERAL, &[]);
    let mut maggi = Maggi::new(&scene.system).unwrap();
    let [mut looser, mut motion] = maggi.solve_twice(&scene.start, 3.0, [1e-11, 1e-13]).unwrap();
    assert_eq!((looser.ending(), motion.ending()), (&Status::Completed, &Status::Completed));
    for t in [0.5, 1.0, 1.7, 2.3, 3.0] {
        let (one, other) = (looser.state(t).unwrap(), motion.state(t).unwrap());
        for (x, y) in one.q.iter().chain(&one.v).zip(other.q.iter().chain(&other.v)) {
            assert!((x - y).abs() < 1e-9, "t = {t}: {x} and {y}");
        }
        assert!(maggi.constraint_residual(t, &other.q, &other.v).unwrap() < 1e-11);
    }
    // d/dt ∂L/∂v − ∂L/∂q − Q vanishes on allowed displacements; L by hand, all derivatives by differences.
    for t in [0.4, 1.1, 2.0, 2.6] {
        let at = |t: f64| {
            let state = motion.clone().state(t).unwrap();
            (four(&state.q), four(&state.v))
        };
        let (q, v) = at(t);
        let unbalanced: Four = std::array::from_fn(|i| {
            let momentum = |s: f64| {
                let (q, v) = at(t + s);
                // L is quadratic in v, so that the difference is exact.
                slope(|e| general_lagrangian(t + s, q, shifted(v, i, e)), 0.5)
            };
            let applied = [0.0, -v[1] / 5.0, 0.0, (3.0 * t).cos() + q[0]][i];
            slope(momentum, 4e-3) - slope(|e| general_lagrangian(t, shifted(q, i, e), v), 4e-3) - applied
        });
        for displacement in general_displacements(t, q) {
            let power = dot(&unbalanced, &displacement);
            assert!(power.abs() < 1e-8, "t = {t}: {power}");
        }
        assert!(length_of(&unbalanced) > 1e-2, "the constraint forces are not nothing");
    }
}

#[test]
fn appell_hamel_runs_straight_and_slows() {
    let scene = scene(APPELL_HAMEL, &[]);
    let mut maggi = Maggi::new(&scene.system).unwrap();
    let mut motion = maggi.solve(&scene.start, 1.0, 1e-13).unwrap();
    let (a, slowing) = (0.5, 9.81 * 0.5 / 1.25);
    let (run, speed) = (5.0 - slowing / 2.0, 5.0 - slowing);
    let state = motion.state(1.0).unwrap();
    let expected = [0.6 * run, 0.8 * run, a * run, 0.6 * speed, 0.8 * speed, a * speed];
    for (found, expected) in state.q.iter().chain(&state.v).zip(expected) {
        assert!((found - expected).abs() < 1e-11, "{found}, expected {expected}");
    }
    // At rest A = 0.
    let rest = maggi.accelerations(0.0, &[0.0; 3], &[0.0; 3]);
    assert!(matches!(rest, Err(MaggiError::DependentConstraints { found: 0.0, .. })), "{rest:?}");
}

#[test]
fn without_constraints_it_is_lagrange() {
    let text = SLEDGE
        .split("[removal")
        .next()
        .unwrap()
        .replace("[contact.blade]          # (5)\nof = \"sledge\"\non = \"slope\"\nlaw = \"blade\"\n", "")
        + "[run]\nduration = 1";
    let scene = scene(&text.replace("\"x'\"   =", "\"y'\" = 0.2\n\"x'\" ="), &[]);
    let state = Maggi::new(&scene.system).unwrap().solve(&scene.start, 1.0, 1e-12).unwrap().state(1.0).unwrap();
    let expected = 0.5 * 0.3_f64.cos() + 9.81 * 0.4_f64.sin();
    assert!((state.v[0] - expected).abs() < 1e-12 && (state.v[1] - 0.2).abs() < 1e-12, "{state:?}");
}

#[test]
fn a_singular_mass_matrix_is_no_obstacle_where_the_constraint_supplies_the_velocity() {
    let mut scene = scene(SLEDGE, &[]);
    // L = (ẋ² + φ̇²)/2, ẏ cos φ = ẋ sin φ. The reaction λ (−sin φ, cos φ, 0) has to vanish: ẏ has no inertia
    scene.system.lagrangian = scene.system.expression("(x'^2 + phi'^2)/2").unwrap();
    let mut maggi = Maggi::new(&scene.system).unwrap();
    let a = maggi.accelerations(0.0, &[0.0, 0.0, 0.3], &[1.0, 0.3_f64.tan(), 1.1]).unwrap();
    // ẍ = φ̈ = 0 and ÿ = ẋ φ̇ / cos² φ.
    let expected = [0.0, 1.1 / 0.3_f64.cos().powi(2), 0.0];
    assert!(a.iter().zip(expected).all(|(a, e)| (a - e).abs() < 1e-14), "{a:?}");
}

#[test]
fn every_error_is_said() {
    let scene = scene(SLEDGE, &[]);
    let State { t, q, v } = scene.start.clone();
    let with = |change: &dyn Fn(&mut System)| {
        let mut system = scene.system.clone();
        change(&mut system);
        Maggi::new(&system)
    };

    let mut twice = with(&|s| s.constraints.push(s.graph.mul(s.graph.integer(2), s.constraints[0]))).unwrap();
    let error = twice.accelerations(t, &q, &v).unwrap_err();
    let MaggiError::DependentConstraints { found, limit, .. } = error else { panic!("{error}") };
    assert!(found < 1e-15 && limit == 1e-13, "{error}");
    assert!(error.to_string().starts_with("the constraints are dependent at t = 0: "), "{error}");
    assert_eq!(twice.residual(t, &q, &v, &v).unwrap_err(), error);
    assert_eq!(twice.solve(&scene.start, 1.0, 1e-9).unwrap_err(), error);

    let mut massless = with(&|s| s.lagrangian = s.expression("(x'^2 + y'^2)/2").unwrap()).unwrap();
    assert!(matches!(massless.accelerations(t, &q, &v), Err(MaggiError::Singular { found, .. }) if found < 1e-15));
    let mut nothing = with(&|s| s.lagrangian = s.graph.zero()).unwrap();
    assert!(matches!(nothing.accelerations(t, &q, &v), Err(MaggiError::Singular { found: 0.0, .. })));

    let unknown = with(&|s| s.forces[0] = s.graph.variable(s.graph.symbol("w"))).unwrap_err();
    assert!(matches!(unknown, MaggiError::Compile(_)), "{unknown}");
    let full = with(&|s| s.constraints = vec![s.constraints[0]; 3]).unwrap_err();
    assert_eq!(full, MaggiError::NoFreedom { found: 3, limit: 3 });

    let mut maggi = Maggi::new(&scene.system).unwrap();
    let short = maggi.accelerations(t, &q[..2], &v).unwrap_err();
    assert_eq!(short, MaggiError::Length { what: "positions", found: 2, expected: 3 });
    let endless = maggi.accelerations(t, &[0.0, 0.0, f64::INFINITY], &v).unwrap_err();
    assert!(matches!(endless, MaggiError::NotFinite { .. }), "{endless}");

    let aside = State { v: vec![0.0, 1.0, 0.0], ..scene.start.clone() };
    let off = maggi.solve(&aside, 1.0, 1e-9).unwrap_err();
    assert!(matches!(off, MaggiError::OffConstraint { found, limit: 1e-9 } if found > 0.4), "{off}");
    let empty = maggi.solve(&scene.start, 0.0, 1e-9).unwrap_err();
    assert!(matches!(empty, MaggiError::Call(_)), "{empty}");
    let mut motion = maggi.solve(&scene.start, 1.0, 1e-9).unwrap();
    assert!(matches!(motion.state(2.0), Err(MaggiError::Dense(_))));
}
