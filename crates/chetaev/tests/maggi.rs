//! Chetaev's equations, and those with reactions along prescribed rows, against Maggi's, with derivatives by
//! differences.

mod differences;

use differences::{Q, T, drift, euler_lagrange, forces, jacobian, lagrangian, rates, system, velocities};
use equations::DerivationError;

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

#[test]
fn what_is_left_of_the_balance_does_no_work_on_prescribed_displacements() {
    let mut system = system();
    system.virtual_conditions = vec![system.expression("t*y' - x'/2 + y*x'/5 + phi'^2*x/2").expect("w")];
    let equations = (chetaev::PRESCRIBED.derive)(&system, &Default::default()).expect("derived");
    let v = velocities();
    let a = rates(&equations, &[Q, v].concat())[3..].to_vec();
    assert!(drift(&v, &a).abs() < 1e-8, "the constraint is kept: {:e}", drift(&v, &a));
    let balance = euler_lagrange(|q, v, s| lagrangian(q, v, T + s), &v, &a);
    let left: Vec<f64> = balance.iter().zip(forces(&v)).map(|(e, force)| e - force).collect();
    let w = [Q[1] / 5.0 - 0.5, T, v[2] * Q[0]];
    for displacement in [[w[1], -w[0], 0.0], [0.0, w[2], -w[1]]] {
        let work: f64 = left.iter().zip(displacement).map(|(e, d)| e * d).sum();
        assert!(work.abs() < 1e-7, "{displacement:?}: {work:e}");
    }
    let reaction: f64 = left.iter().zip(w).map(|(e, w)| e * w).sum();
    assert!(reaction.abs() > 0.1, "a reaction: {reaction}");
}

#[test]
fn the_constraints_own_rows_are_chetaev_to_the_last_bit() {
    let mut system = system();
    system.virtual_conditions = system.constraints.clone();
    let prescribed = (chetaev::PRESCRIBED.derive)(&system, &Default::default()).expect("derived");
    let own = chetaev::derive(&system, &Default::default()).expect("derived");
    let y = [Q, velocities()].concat();
    assert_eq!(rates(&prescribed, &y), rates(&own, &y));
    // a multiple has the same motion, and its own multiplier
    system.virtual_conditions = vec![system.expression("3*(y'*cos(phi) - x'*sin(phi))").expect("w")];
    let multiple = (chetaev::PRESCRIBED.derive)(&system, &Default::default()).expect("derived");
    for (a, b) in rates(&multiple, &y).iter().zip(rates(&own, &y)) {
        assert!((a - b).abs() < 1e-13, "{a}, {b}");
    }
}

#[test]
fn as_many_conditions_as_constraints_are_needed() {
    let mut system = system();
    let derive = |system: &_| (chetaev::PRESCRIBED.derive)(system, &Default::default()).err();
    let formulation = "prescribed";
    assert_eq!(derive(&system), Some(DerivationError::VirtualConditionsMissing { formulation }));
    system.virtual_conditions = ["x'", "y'"].map(|text| system.expression(text).expect("w")).to_vec();
    let wrong = DerivationError::VirtualConditions { formulation, found: 2, expected: 1 };
    assert_eq!(derive(&system), Some(wrong));
}
