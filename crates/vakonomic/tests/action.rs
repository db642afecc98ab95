//! Vakonomic equations against the Euler–Lagrange expressions of `L + μ f`, with derivatives by differences.

#[path = "../../chetaev/tests/differences.rs"]
#[allow(dead_code, reason = "shared with tests of other formulations")]
mod differences;

use differences::{Q, T, constraint, drift, euler_lagrange, forces, lagrangian, rates, system, velocities};

#[test]
fn the_action_with_multipliers_varies_by_the_work_of_forces() {
    let equations = vakonomic::derive(&system(), &Default::default()).expect("derived");
    let (v, mu) = (velocities(), 0.6);
    let rates = rates(&equations, &[&Q[..], &v, &[mu]].concat());
    let (a, mu_rate) = (&rates[3..6], rates[6]);
    assert!(drift(&v, a).abs() < 1e-8, "the constraint is kept: {:e}", drift(&v, a));
    let augmented =
        |q: &[f64], v: &[f64], s: f64| lagrangian(q, v, T + s) + (mu + mu_rate * s) * constraint(q, v, T + s);
    for (i, (left, force)) in euler_lagrange(augmented, &v, a).into_iter().zip(forces(&v)).enumerate() {
        assert!((left - force).abs() < 1e-7, "coordinate {i}: {left:e}, force {force:e}");
    }
}
