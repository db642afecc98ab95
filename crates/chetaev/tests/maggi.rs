//! Chetaev's equations against Maggi's, with derivatives by differences.

mod differences;

use differences::{Q, T, drift, euler_lagrange, forces, jacobian, lagrangian, rates, system, velocities};

#[test]
fn what_is_left_of_the_balance_does_no_work_on_virtual_displacements() {
    let equations = chetaev::derive(&system(), &Default::default()).expect("derived");
    let v = velocities();
    let a = rates(&equations, &[Q, v].concat())[3..].to_vec();
    assert!(drift(&v, &a).abs() < 1e-8, "the constraint is kept: {:e}", drift(&v, &a));
    let balance = euler_lagrange(|q, v, s| lagrangian(q, v, T + s), &v, &a);
    let left: Vec<f64> = balance.iter().zip(forces(&v)).map(|(e, force)| e - force).collect();
    let [across, along, _] = jacobian(Q[2].sin(), Q[2].cos());
    // a basis of the displacements with A δq = 0
    for displacement in [[along, -across, 0.0], [0.0, 0.0, 1.0]] {
        let work: f64 = left.iter().zip(displacement).map(|(e, d)| e * d).sum();
        assert!(work.abs() < 1e-7, "{displacement:?}: {work:e}");
    }
    let reaction = left[0] * across + left[1] * along;
    assert!(reaction.abs() > 0.1, "a reaction: {reaction}");
}
