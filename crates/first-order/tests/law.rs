//! The law of first order against Euler–Lagrange expressions and the curvature `C`, both by differences.

#[path = "../../chetaev/tests/differences.rs"]
mod differences;

use differences::{
    Q, T, constraint, derivative, drift, euler_lagrange, forces, jacobian, lagrangian, rates, system, velocities,
};
use equations::{Compiled, DerivationError, Equations};
use mechanics::{Parameter, System};

fn with(numbers: &[(&str, f64)]) -> System {
    let mut system = system();
    for &(name, value) in numbers {
        let symbol = system.graph.symbol(name);
        system.parameters.push(Parameter { symbol, value, formula: None });
    }
    system
}

/// `C`, by differences of `f` and of `A` along the motion.
fn curvature(v: &[f64]) -> [f64; 3] {
    let by_place = |i: usize| {
        derivative(|e| {
            let mut q = Q;
            q[i] += e;
            constraint(&q, v, T)
        })
    };
    let turned = |s: f64| jacobian((Q[2] + v[2] * s).sin(), (Q[2] + v[2] * s).cos());
    std::array::from_fn(|i| by_place(i) - derivative(|s| turned(s)[i]))
}

fn multiplier(equations: &Equations, y: &[f64]) -> f64 {
    let mut compiled = Compiled::new(equations).expect("compiled");
    compiled.outputs(T, y).expect("regular").multipliers[0]
}

fn balance_is_met(numbers: &[(&str, f64)], v: [f64; 3], lambda: Option<f64>) -> f64 {
    let system = with(numbers);
    let equations = first_order::derive(&system, &Default::default()).expect("derived");
    let y = [Q, v].concat();
    let a = rates(&equations, &y)[3..].to_vec();
    let found = multiplier(&equations, &y);
    if let Some(lambda) = lambda {
        assert!((found - lambda).abs() < 1e-12, "{found}, {lambda}");
    }
    let epsilon = numbers.iter().find(|(name, _)| *name == "epsilon").map_or(0.0, |n| n.1);
    let (balance, normal) =
        (euler_lagrange(|q, v, s| lagrangian(q, v, T + s), &v, &a), jacobian(Q[2].sin(), Q[2].cos()));
    let curved = curvature(&v);
    for i in 0..3 {
        let off = balance[i] - forces(&v)[i] - (normal[i] - epsilon * curved[i]) * found;
        assert!(off.abs() < 1e-7, "{numbers:?}, coordinate {i}: {off:e}");
    }
    assert!(found.abs() > 0.1 && curved.iter().any(|c| c.abs() > 0.1), "something acts: {found}, {curved:?}");
    drift(&v, &a)
}

#[test]
fn what_is_left_of_the_balance_is_the_reaction_and_its_trace() {
    for epsilon in [0.03, -0.2] {
        let drift = balance_is_met(&[("epsilon", epsilon)], velocities(), None);
        assert!(drift.abs() < 1e-8, "the constraint is kept: {drift:e}");
    }
    // slip that is zero is none
    let drift = balance_is_met(&[("epsilon", 0.03), ("slip", 0.0)], velocities(), None);
    assert!(drift.abs() < 1e-8, "the constraint is kept: {drift:e}");
}

#[test]
fn a_slip_is_minus_the_reaction_over_the_viscosity() {
    let mut v = velocities();
    v[0] += 0.3;
    let slip = 0.4;
    let lambda = -constraint(&Q, &v, T) / slip;
    balance_is_met(&[("slip", slip)], v, Some(lambda));
    balance_is_met(&[("epsilon", 0.03), ("slip", slip)], v, Some(lambda));
}

#[test]
fn without_both_numbers_it_is_chetaev_and_one_of_them_is_needed() {
    let y = [Q, velocities()].concat();
    let law = first_order::derive(&with(&[("epsilon", 0.0)]), &Default::default()).expect("derived");
    let chetaev = rates(&law, &y);
    let balance = euler_lagrange(|q, v, s| lagrangian(q, v, T + s), &velocities(), &chetaev[3..]);
    // no torque about the vertical but the force
    assert!((balance[2] - forces(&velocities())[2]).abs() < 1e-7);
    let missing = DerivationError::ParameterMissing { formulation: "first-order", parameter: "epsilon" };
    assert_eq!(first_order::derive(&with(&[]), &Default::default()).err(), Some(missing.clone()));
    // a number of the system itself is no number of the law
    let mut system = with(&[("epsilon", 0.1)]);
    system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + epsilon*x").expect("L");
    assert_eq!(first_order::derive(&system, &Default::default()).err(), Some(missing));
}
