//! Small linear systems.

use mechanics::linear::Factors;

#[test]
fn solves_a_saddle_point_system_in_any_units() {
    // [ 2 0 −1; 0 1 −1; 1 1 0 ] z = (1, 2, 3), z = (0.6667.., 2.3333.., 0.3333..)
    for unit in [1e-12, 1.0, 1e12] {
        let mut f = Factors::new(3);
        f.factorize(&[2.0, 0.0, -unit, 0.0, 1.0, -unit, unit, unit, 0.0]).unwrap();
        let mut b = [1.0, 2.0, 3.0 * unit];
        f.solve(&mut b);
        assert!((b[0] - 2.0 / 3.0).abs() < 1e-14 && (b[1] - 7.0 / 3.0).abs() < 1e-14);
        assert!((b[2] * unit - 1.0 / 3.0).abs() < 1e-14);
    }
}

#[test]
fn inertia_may_be_any_part_of_the_constraints() {
    // [ m 0 1; 0 m 1; 1 1 0 ] z = (m, 2m, 3): z = (1, 2, 0)
    for m in [1e-18, 1e18] {
        let mut f = Factors::new(3);
        f.factorize(&[m, 0.0, 1.0, 0.0, m, 1.0, 1.0, 1.0, 0.0]).unwrap();
        let mut b = [m, 2.0 * m, 3.0];
        f.solve(&mut b);
        assert!((b[0] - 1.0).abs() < 1e-14 && (b[1] - 2.0).abs() < 1e-14 && b[2].abs() < 1e-14 * m, "{b:?}");
    }
}

#[test]
fn what_elimination_adds_up_bounds_what_it_loses() {
    // [ 27 a; a 0 ] z = (1, 0): z = (0, 1/a), where 1/27 is added and taken away
    let a = 0.3;
    let mut f = Factors::new(2);
    f.factorize(&[27.0, a, a, 0.0]).unwrap();
    let sums = f.eliminated(&[0.0, 1.0 / a]);
    assert!((sums[0] - 1.0).abs() < 1e-14 && (sums[1] - 2.0 * a / 27.0).abs() < 1e-14, "{sums:?}");
}

#[test]
fn refuses_dependent_rows() {
    let mut f = Factors::new(2);
    assert!(f.factorize(&[1.0, 2.0, 2.0, 4.0]).is_err());
    assert!(f.factorize(&[0.0, 0.0, 2.0, 4.0]).is_err());
    assert!(f.factorize(&[f64::NAN, 1.0, 2.0, 4.0]).is_err());
}
