//! The general second-order statement: a parametrization that puts `ü` into `L`.
//!
//! `x = u + ε u̇` in `L = ẋ²/2 − x²/2`, without a constraint. With `E = ẍ + x` the equation for `u` is
//!
//! ```text
//! d²/dt² G_ü − d/dt G_u̇ + G_u = ε Ė − E = 0      so   E = E₀ e^{(t − t₀)/ε} ,
//! p = G_u̇ − d/dt G_ü = ẋ − ε E                   so   E₀ = (ẋ₀ − p₀)/ε :
//! ```
//!
//! Newton's motion only where the free constant `p₀` is `ẋ₀`.

use equations::{DerivationError, Role};
use motion::{Motion, REMOVED_CONSTRAINT};
use scene::Scene;

use super::support::{at, complete, derived, equations, must, must_exceed, removed, scene};

const OSCILLATOR: &str = include_str!("../scenes/oscillator.toml");

const EPSILON: f64 = 0.5;
const POSITION: f64 = 0.8;
const SPEED: f64 = -0.3;

fn oscillator() -> Scene {
    Scene::parse("oscillator", OSCILLATOR).unwrap_or_else(|e| panic!("{e}"))
}

fn motion(momentum: f64) -> Motion {
    let scene = oscillator();
    complete(&scene, removed(&scene, &scene.removals[0], &[momentum]))
}

/// `x(t)` and `ẋ(t)` of `ẍ + x = E₀ e^{t/ε}`.
fn exact(t: f64, momentum: f64) -> (f64, f64) {
    let e0 = (SPEED - momentum) / EPSILON;
    // particular solution k e^{t/ε}
    let k = e0 / (1.0 + 1.0 / (EPSILON * EPSILON));
    let (a, b) = (POSITION - k, SPEED - k / EPSILON);
    let growing = k * (t / EPSILON).exp();
    (a * t.cos() + b * t.sin() + growing, -a * t.sin() + b * t.cos() + growing / EPSILON)
}

#[test]
fn the_one_free_constant_is_the_momentum() {
    let scene = oscillator();
    let equations = equations(&scene.system, REMOVED_CONSTRAINT, Some(&scene.removals[0]));
    let names = motion::constant_names(&equations);
    assert_eq!(names, ["p0_u"]);
    let roles: Vec<Role> = equations.states.iter().map(|y| y.role).collect();
    for role in [Role::DisplacementParameter, Role::ParameterRate, Role::ParameterSecondRate, Role::ParameterMomentum] {
        assert!(roles.contains(&role), "{role:?} is not among {roles:?}");
    }
    assert_eq!(roles.len(), 4);
}

#[test]
fn momentum_equal_to_the_velocity_gives_newtons_motion() {
    let mut motion = motion(SPEED);
    let mut worst = 0.0_f64;
    for t in motion.grid(100) {
        let now = at(&mut motion, t);
        worst = worst.max((now.coordinates[0] - (POSITION * t.cos() + SPEED * t.sin())).abs());
        worst = worst.max((now.velocities[0] - (SPEED * t.cos() - POSITION * t.sin())).abs());
    }
    must("oscillator of second order, p = x', against Newton, to 3 s", worst, 1e-9);
}

#[test]
fn another_momentum_gives_a_growing_motion() {
    for momentum in [0.0, SPEED + 1e-3, 1.0, -2.0] {
        let mut motion = motion(momentum);
        let (mut worst, mut departure) = (0.0_f64, 0.0_f64);
        for t in motion.grid(100) {
            let now = at(&mut motion, t);
            let (x, v) = exact(t, momentum);
            worst = worst.max((now.coordinates[0] - x).abs() / x.abs().max(1.0));
            worst = worst.max((now.velocities[0] - v).abs() / v.abs().max(1.0));
            departure = departure.max((now.coordinates[0] - (POSITION * t.cos() + SPEED * t.sin())).abs());
        }
        must(&format!("oscillator of second order, p = {momentum}, against the closed form"), worst, 1e-8);
        must_exceed(&format!("oscillator of second order, p = {momentum}, from Newton"), departure, 1e-2);
    }
}

#[test]
fn energy_of_second_order_is_constant() {
    for momentum in [SPEED, 1.0] {
        let mut motion = motion(momentum);
        let names: Vec<&str> = motion.equations.invariants.iter().map(|i| i.name.as_str()).collect();
        assert_eq!(names, ["energy"]);
        let start = at(&mut motion, 0.0);
        // u̇ p + ü G_ü − G, with G_ü = ε ẋ and u̇ + ε ü = ẋ: for p = ẋ it is ẋ² − L
        let start_energy = start.invariants[0];
        let (mut worst, mut size) = (0.0_f64, 0.0_f64);
        for t in motion.grid(100) {
            let now = at(&mut motion, t);
            worst = worst.max((now.invariants[0] - start_energy).abs());
            size = size.max(now.velocities[0].powi(2) + now.coordinates[0].powi(2));
        }
        must(&format!("oscillator of second order, p = {momentum}, energy"), worst / size, 1e-10);
        if momentum == SPEED {
            let plain = 0.5 * (SPEED * SPEED + POSITION * POSITION);
            must("oscillator of second order, p = x', energy against Newton's", (start_energy - plain).abs(), 1e-12);
        }
    }
}

#[test]
fn a_singular_highest_hessian_is_refused_with_its_rank() {
    let scene = scene("three-cylinders", &[]);
    let paper = super::support::removal(&scene, "paper");
    match derived(&scene, REMOVED_CONSTRAINT, Some(paper), None) {
        Err(DerivationError::SingularHighestHessian { formulation, removal, second_rates, rank, size }) => {
            assert_eq!((formulation, removal.as_str()), (REMOVED_CONSTRAINT.name, "paper"));
            assert_eq!((rank, size), (1, 2));
            assert!(second_rates.contains("u''"), "{second_rates}");
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("not refused"),
    }
}

const HALF_BLIND: &str = include_str!("../scenes/half-blind.toml");

/// One parameter has its second rate in `L`, the other not: the Hessian in `(ü, ẇ)` has rank 1.
#[test]
fn a_singular_highest_hessian_is_refused_where_only_some_parameters_are_of_second_order() {
    let scene = Scene::parse("half-blind", HALF_BLIND).unwrap_or_else(|e| panic!("{e}"));
    match derived(&scene, REMOVED_CONSTRAINT, scene.removals.first(), None) {
        Err(DerivationError::SingularHighestHessian { rank, size, .. }) => assert_eq!((rank, size), (1, 2)),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("not refused"),
    }
}

#[test]
fn a_lagrangian_without_the_rate_of_the_parameter_is_refused() {
    let scene = scene("appell-hamel", &[]);
    let by_heading = |choice: &motion::Choice| choice.removal.as_ref().is_some_and(|r| r.name == "by-heading");
    let choice = motion::choices(&scene).into_iter().find(by_heading).expect("a removal of the scene");
    let error = motion::solve_choice(&scene, &choice, &Default::default()).err().map(|e| e.to_string());
    assert!(error.as_ref().is_some_and(|e| e.contains("singular")), "{error:?}");
}
