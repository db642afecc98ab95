//! The family against the Euler–Lagrange expressions of `L + μ f`, with derivatives by differences.

#[path = "../../chetaev/tests/differences.rs"]
mod differences;

use differences::{Q, T, constraint, drift, euler_lagrange, forces, jacobian, lagrangian, rates, system, velocities};
use mechanics::Parameter;

#[test]
fn what_is_left_of_the_balance_is_force_and_friction() {
    let (kappa, mu) = (0.7, 0.6);
    let mut system = system();
    let symbol = system.graph.symbol("kappa");
    system.parameters.push(Parameter { symbol, value: kappa, formula: None });
    let equations = kappa::derive(&system, &Default::default()).expect("derived");
    let v = velocities();
    let rates = rates(&equations, &[&Q[..], &v, &[mu]].concat());
    let (a, mu_rate) = (&rates[3..6], rates[6]);
    assert!(drift(&v, a).abs() < 1e-8, "the constraint is kept: {:e}", drift(&v, a));
    let augmented =
        |q: &[f64], v: &[f64], s: f64| lagrangian(q, v, T + s) + (mu + mu_rate * s) * constraint(q, v, T + s);
    let balance = euler_lagrange(augmented, &v, a);
    let pull = jacobian(Q[2].sin(), Q[2].cos()).map(|a| kappa * a * mu);
    for (i, (left, force)) in balance.into_iter().zip(forces(&v)).enumerate() {
        let off = left - force + pull[i];
        assert!(off.abs() < 1e-7, "coordinate {i}: {off:e}");
    }
}
