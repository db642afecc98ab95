//! Newton's method, with any number of equations and unknowns.

use mechanics::newton::{Evaluation, NewtonError, NewtonOptions, solve};
use nalgebra::{DMatrix, DVector};

fn linear(a: DMatrix<f64>, b: DVector<f64>) -> impl Fn(&DVector<f64>) -> Evaluation {
    move |x| Evaluation { residual: &a * x - &b, jacobian: a.clone(), magnitude: a.abs() * x.abs() + b.abs() }
}

#[test]
fn underdetermined_linear_equations_give_the_shortest_solution() {
    let f = linear(DMatrix::from_row_slice(1, 3, &[1.0, 2.0, 2.0]), DVector::from_row_slice(&[9.0]));
    let root = solve(f, DVector::zeros(3), &NewtonOptions::default()).unwrap();
    assert!((root.x - DVector::from_row_slice(&[1.0, 2.0, 2.0])).amax() < 1e-15);
    assert_eq!((root.rank, root.null_space.ncols()), (1, 2));
    assert!(root.iterations <= 2);
}

#[test]
fn consistent_overdetermined_equations_with_bad_units_are_solved() {
    let a = DMatrix::from_row_slice(3, 2, &[1e9, 0.0, 1.0, 1.0, 0.0, 1e-9]);
    let root = solve(
        linear(a.clone(), &a * DVector::from_row_slice(&[3.0, -2.0])),
        DVector::zeros(2),
        &NewtonOptions::default(),
    );
    assert!((root.unwrap().x - DVector::from_row_slice(&[3.0, -2.0])).amax() < 1e-15);
}

#[test]
fn contradiction_ends_at_least_squares() {
    let f = linear(DMatrix::from_row_slice(2, 1, &[1.0, 1.0]), DVector::from_row_slice(&[1.0, 3.0]));
    let error = solve(f, DVector::zeros(1), &NewtonOptions::default()).unwrap_err();
    let NewtonError::NotConverged { best, limit } = error else { panic!("{error}") };
    assert!((best.x[0] - 2.0).abs() < 1e-15);
    assert!(best.residual > 0.1 && limit == 1e-10);
}

#[test]
fn quadratic_convergence_and_damping() {
    // arctan: the undamped method diverges from 3
    let mut errors = Vec::new();
    let f = |x: &DVector<f64>| {
        errors.push(x[0].abs());
        Evaluation {
            residual: DVector::from_row_slice(&[x[0].atan()]),
            jacobian: DMatrix::from_row_slice(1, 1, &[1.0 / (1.0 + x[0] * x[0])]),
            magnitude: DVector::from_row_slice(&[1.0]),
        }
    };
    let root = solve(f, DVector::from_row_slice(&[3.0]), &NewtonOptions::default()).unwrap();
    assert!(root.x[0].abs() < 1e-15);
    let small: Vec<f64> = errors.into_iter().filter(|e| (1e-7..0.5).contains(e)).collect();
    assert!(small.windows(2).all(|w| w[1] <= 2.0 * w[0].powi(2)), "{small:?}");
}

#[test]
fn nothing_finite_is_an_error() {
    let f = |x: &DVector<f64>| Evaluation {
        residual: DVector::from_row_slice(&[1.0 / x[0]]),
        jacobian: DMatrix::from_row_slice(1, 1, &[1.0]),
        magnitude: DVector::from_row_slice(&[1.0]),
    };
    let error = solve(f, DVector::from_row_slice(&[0.0]), &NewtonOptions::default()).unwrap_err();
    assert_eq!(error, NewtonError::NotFinite { iteration: 0 });
}

#[test]
fn no_equations_leave_everything_open() {
    let f = linear(DMatrix::zeros(0, 2), DVector::zeros(0));
    let root = solve(f, DVector::from_row_slice(&[1.0, 2.0]), &NewtonOptions::default()).unwrap();
    assert_eq!((root.rank, root.null_space.ncols()), (0, 2));
    assert_eq!(root.x, DVector::from_row_slice(&[1.0, 2.0]));
    let f = linear(DMatrix::zeros(0, 0), DVector::zeros(0));
    assert_eq!(solve(f, DVector::zeros(0), &NewtonOptions::default()).unwrap().rank, 0);
    let f = linear(DMatrix::zeros(1, 0), DVector::from_row_slice(&[1.0]));
    assert!(solve(f, DVector::zeros(0), &NewtonOptions::default()).is_err());
}
