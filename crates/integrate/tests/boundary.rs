//! Shooting and fitting.

use crate::problems::*;
use integrate::{BoundaryError, CallError, Options, ShootOptions, Start, StopCause, fit, integrate, shoot};

/// y'' = 3y²/2, y(0) = 4, y(1) = 1: y = 4/(1 + t)², and a second solution (Stoer, Bulirsch, section 7.3.1).
fn cubic() -> Case {
    Case::new(2, |_, y| vec![y[1].clone(), &(&y[0] * &y[0]) * 1.5])
}

fn end_of_cubic(c: &[f64], r: &mut [f64]) -> Result<(), BoundaryError> {
    let start = Start { t: 0.0, y: vec![4.0, c[0]] };
    let solution = integrate(&mut cubic(), &start, 1.0, &Options::with_tolerance(1e-13))?;
    r[0] = solution.completed()?.end_state()[0] - 1.0;
    Ok(())
}

#[test]
fn a_linear_problem_takes_one_jacobian() {
    // y'' = −y, y(0) = 0, y(1) = 1.
    let mut end = |c: &[f64], r: &mut [f64]| {
        let start = Start { t: 0.0, y: vec![0.0, c[0]] };
        let solution = integrate(&mut oscillator(), &start, 1.0, &Options::with_tolerance(1e-13))?;
        r[0] = solution.completed()?.end_state()[0] - 1.0;
        Ok(())
    };
    let shot = shoot(&mut end, &[0.0], &ShootOptions::with_tolerance(1e-11)).unwrap();
    assert!((shot.unknowns[0] - 1.0 / 1f64.sin()).abs() < 2e-11, "{shot:?}");
    assert!(shot.residual <= 1e-11);
    assert!(shot.iterations <= 2);
    assert!((shot.condition - 1.0).abs() < 1e-12);
}

#[test]
fn a_nonlinear_problem_has_two_solutions() {
    for (guess, slope) in [(-6.0, -8.0), (-40.0, -35.858_548_824_857)] {
        let shot = shoot(&mut end_of_cubic, &[guess], &ShootOptions::with_tolerance(1e-11)).unwrap();
        assert!((shot.unknowns[0] - slope).abs() < 1e-9, "{shot:?}");
    }
}

#[test]
fn guesses_that_blow_up_on_the_way_are_backed_out_of() {
    // From −0.5 the first step goes far; beyond it y'' = 3y²/2 explodes before t = 1.
    let shot = shoot(&mut end_of_cubic, &[-3.0], &ShootOptions::with_tolerance(1e-10)).unwrap();
    assert!((shot.unknowns[0] + 8.0).abs() < 1e-9 || (shot.unknowns[0] + 35.858_548_824_857).abs() < 1e-7, "{shot:?}");
}

#[test]
fn two_unknowns() {
    // A throw without drag: from the origin to (3, 1) in time 1 under gravity 2.
    let mut end = |c: &[f64], r: &mut [f64]| {
        r[0] = c[0] - 3.0;
        r[1] = c[1] - 1.0 - 1.0;
        r[0] += 0.1 * r[1] * r[1] + 0.3 * r[1].sin();
        Ok(())
    };
    let shot = shoot(&mut end, &[0.0, 0.0], &ShootOptions::with_tolerance(1e-12)).unwrap();
    assert!(distance(&shot.unknowns, &[3.0, 2.0]) < 1e-11, "{shot:?}");
}

#[test]
fn a_fit_finds_frequency_and_amplitude() {
    let data: Vec<f64> = (0..20).map(|i| 1.5 * (0.8 * i as f64 * 0.3).cos()).collect();
    let mut misfit = |c: &[f64], r: &mut [f64]| {
        for (i, r) in r.iter_mut().enumerate() {
            *r = c[0] * (c[1] * i as f64 * 0.3).cos() - data[i];
        }
        Ok(())
    };
    let shot = fit(&mut misfit, 20, &[1.0, 1.0], &ShootOptions::with_tolerance(1e-12)).unwrap();
    assert!(distance(&shot.unknowns, &[1.5, 0.8]) < 1e-10, "{shot:?}");
    assert!(shot.residual < 1e-10);
}

#[test]
fn a_fit_that_does_not_determine_its_constants_says_so() {
    let mut misfit = |c: &[f64], r: &mut [f64]| {
        r.fill(c[0] + c[1] - 1.0);
        Ok(())
    };
    let shot = fit(&mut misfit, 3, &[0.0, 0.0], &ShootOptions::with_tolerance(1e-12)).unwrap();
    assert!(shot.condition > 1e10, "{shot:?}");
}

#[test]
fn every_error() {
    let options = ShootOptions::with_tolerance(1e-10);
    let mut ok = |c: &[f64], r: &mut [f64]| {
        r[0] = c[0];
        Ok(())
    };
    assert_eq!(shoot(&mut ok, &[], &options), Err(BoundaryError::Dimension { unknowns: 0, residuals: 0 }));
    assert_eq!(fit(&mut ok, 1, &[1.0, 2.0], &options), Err(BoundaryError::Dimension { unknowns: 2, residuals: 1 }));
    for wrong in [
        ShootOptions { tolerance: 0.0, ..options.clone() },
        ShootOptions { max_iterations: 0, ..options.clone() },
        ShootOptions { difference_step: f64::NAN, ..options.clone() },
        ShootOptions { scale: -1.0, ..options.clone() },
        ShootOptions { least_gain: 1.0, ..options.clone() },
    ] {
        assert!(matches!(shoot(&mut ok, &[1.0], &wrong), Err(BoundaryError::Option { .. })), "{wrong:?}");
    }
    assert!(matches!(shoot(&mut ok, &[f64::INFINITY], &options), Err(BoundaryError::Option { name: "guess", .. })));

    let mut refuses = |_: &[f64], _: &mut [f64]| Err(BoundaryError::Residual { reason: "no".into() });
    assert_eq!(shoot(&mut refuses, &[1.0], &options), Err(BoundaryError::Residual { reason: "no".into() }));
    let mut nan = |_: &[f64], r: &mut [f64]| {
        r[0] = f64::NAN;
        Ok(())
    };
    assert!(matches!(shoot(&mut nan, &[1.0], &options), Err(BoundaryError::NotFinite { index: 0, .. })));
    let mut bad_call = |c: &[f64], _: &mut [f64]| {
        integrate(&mut oscillator(), &Start { t: 0.0, y: c.to_vec() }, 1.0, &Options::with_tolerance(1e-6))?;
        Ok(())
    };
    let call = CallError::Dimension { expected: 2, found: 1 };
    assert_eq!(shoot(&mut bad_call, &[1.0], &options), Err(BoundaryError::Call(call)));
    let mut explodes = |c: &[f64], r: &mut [f64]| {
        let start = Start { t: 0.0, y: c.to_vec() };
        let solution = integrate(&mut blow_up(), &start, 2.0, &Options::with_tolerance(1e-6))?;
        r[0] = solution.completed()?.end_state()[0];
        Ok(())
    };
    assert!(matches!(
        shoot(&mut explodes, &[1.0], &options),
        Err(BoundaryError::Stopped { cause: StopCause::StepTooSmall { .. } | StopCause::NotFinite { .. }, .. })
    ));
    // No root: 1 + c².
    let mut rootless = |c: &[f64], r: &mut [f64]| {
        r[0] = 1.0 + (c[0] - 0.3).powi(2);
        Ok(())
    };
    let error = shoot(&mut rootless, &[2.0], &options).unwrap_err();
    assert!(
        matches!(error, BoundaryError::NotConverged { residual, .. } | BoundaryError::Singular { residual, .. } if (residual - 1.0).abs() < 1e-6)
    );
    let few = ShootOptions { max_iterations: 1, ..options.clone() };
    assert!(matches!(shoot(&mut rootless, &[2.0], &few), Err(BoundaryError::NotConverged { iterations: 1, .. })));
    assert!(fit(&mut rootless, 1, &[2.0], &few).unwrap().exhausted);
    // The second unknown has no effect, and the residuals contradict each other.
    let mut singular = |c: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (c[0], c[0] - 1.0);
        Ok(())
    };
    assert!(matches!(shoot(&mut singular, &[2.0, 1.0], &options), Err(BoundaryError::Singular { .. })));
    // derivatives of condition 1e4 determine an end, also where the search does not come to it
    let mut determined = |c: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (c[0] + c[1] - 1.0, 1e-4 * (c[0] - c[1]).sinh());
        Ok(())
    };
    let found = shoot(&mut determined, &[2.0, 1.0], &options).unwrap();
    assert!(found.unknowns.iter().all(|x| (x - 0.5).abs() < 1e-6), "{found:?}");
    assert!(matches!(shoot(&mut determined, &[8.0, 1.0], &few), Err(BoundaryError::NotConverged { .. })));
}

#[test]
fn an_unknown_that_only_errors_move_stays() {
    // as an integration would: exact to 1e-9, with errors that depend on c, up to the edge c₁ = 2
    let mut fitted = |c: &[f64], r: &mut [f64]| {
        if c[0] > 2.0 {
            return Err(BoundaryError::Residual { reason: "no".into() });
        }
        let error = 1e-9 * (1e5 * c[1]).sin();
        (r[0], r[1]) = (c[0] - 3.0 + error, 1.0 - error);
        Ok(())
    };
    let coarse = ShootOptions { max_iterations: 10, ..ShootOptions::with_tolerance(1e-8) };
    let shot = fit(&mut fitted, 2, &[0.5, 1.0], &coarse).expect("the guess will do");
    assert!(shot.unknowns[1] == 1.0 && shot.condition.is_infinite() && shot.unknowns[0] > 0.5, "{shot:?}");
    // with differences too small to matter the unknown runs away
    let shot = fit(&mut fitted, 2, &[0.5, 1.0], &ShootOptions { tolerance: 1e-12, ..coarse }).expect("the guess");
    assert!((shot.unknowns[1] - 1.0).abs() > 1.0, "{shot:?}");
}

/// `r = (c₀² + c₁ − 3, c₀ − c₁²)` with its derivatives, the first of them multiplied by `part`.
struct Curves {
    part: f64,
    calls: usize,
}

impl integrate::Residuals for Curves {
    fn residual(&mut self, c: &[f64], r: &mut [f64]) -> Result<(), BoundaryError> {
        self.calls += 1;
        r.copy_from_slice(&[c[0] * c[0] + c[1] - 3.0, c[0] - c[1] * c[1]]);
        Ok(())
    }
    fn jacobian(&mut self, c: &[f64], jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        jacobian.copy_from_slice(&[2.0 * c[0] * self.part, 1.0, 1.0, -2.0 * c[1]]);
        Ok(self.part > 0.0)
    }
}

#[test]
fn the_callers_derivatives_are_taken_where_he_has_them() {
    let options = ShootOptions::with_tolerance(1e-12);
    let guess = [1.0, 1.5];
    let searched = |part: f64| {
        let mut curves = Curves { part, calls: 0 };
        let shot = shoot(&mut curves, &guess, &options).unwrap();
        assert!((shot.unknowns[1].powi(4) + shot.unknowns[1] - 3.0).abs() < 1e-11, "{shot:?}");
        assert_eq!(shot.evaluations, curves.calls);
        shot
    };
    let (exact, differences) = (searched(1.0), searched(0.0));
    assert_eq!((exact.exact, differences.exact), (exact.iterations, 0));
    assert!(exact.iterations <= 6 && exact.evaluations + 3 * exact.iterations < differences.evaluations);
    // it is these that are followed: wrong ones lead nowhere
    let wrong = shoot(&mut Curves { part: 0.5, calls: 0 }, &guess, &options);
    assert!(matches!(wrong, Err(BoundaryError::NotConverged { .. })), "{wrong:?}");
}
