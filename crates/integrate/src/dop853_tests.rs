//! One step of DOP853 at a time: local orders of the step and of its dense output.

use crate::dense::{Basis, evaluate_segment};
use crate::dop853::Dop853;
use crate::options::Options;
use crate::problem::{EvaluationError, Problem, Start};
use crate::stepper::{Attempt, Stepper};
use crate::system::System;

/// y' = y cos t: y = y(0) exp(sin t).
struct Nonautonomous;

impl Problem for Nonautonomous {
    fn dimension(&self) -> usize {
        1
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        rates[0] = y[0] * t.cos();
        Ok(())
    }
    fn jacobian(&mut self, t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        jacobian[0] = t.cos();
        Ok(())
    }
}

/// Errors at the end and the largest within one step of length `h` from t = 0.3.
fn local_errors(h: f64) -> (f64, f64) {
    let exact = |t: f64| (t.sin() - 0.3f64.sin()).exp();
    let mut problem = Nonautonomous;
    let system = System::new(&mut problem);
    let start = Start { t: 0.3, y: vec![1.0] };
    let mut stepper = Dop853::new(&system, &start, 0.3 + h, &Options::with_tolerance(0.9)).unwrap();
    stepper.set_step(h);
    assert!(matches!(stepper.attempt(), Attempt::Candidate { t, rejected: 0 } if t == 0.3 + h));
    let mut segment = vec![0.0; 8];
    stepper.finish(false, Some(&mut segment)).unwrap();
    assert_eq!(system.work().evaluations, 1 + 11 + 1 + 3);
    let within = (1..100).map(|i| {
        let theta = f64::from(i) / 100.0;
        let mut y = [0.0];
        evaluate_segment(Basis::Nested, &segment, theta, &mut y);
        (y[0] - exact(0.3 + theta * h)).abs()
    });
    ((stepper.candidate()[0] - exact(0.3 + h)).abs(), within.fold(0.0, f64::max))
}

#[test]
fn the_local_error_is_of_ninth_and_within_the_step_of_eighth_order() {
    let lengths = [0.4, 0.25];
    let errors = lengths.map(local_errors);
    let order = |a: f64, b: f64| (a / b).ln() / (lengths[0] / lengths[1]).ln();
    let step = order(errors[0].0, errors[1].0);
    let dense = order(errors[0].1, errors[1].1);
    println!("{errors:?}: {step} {dense}");
    assert!((8.2..9.6).contains(&step), "local order of the step: {step}, errors {errors:?}");
    assert!((7.5..8.6).contains(&dense), "local order within the step: {dense}, errors {errors:?}");
}
