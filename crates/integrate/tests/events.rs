//! Events and roots.

use crate::problems::*;
use diffsol_methods::{EVERY, TR_BDF2};
use integrate::{EvaluationError, Options, Status, StopCause, find_root};

/// θ'' = −sin θ.
fn pendulum() -> Case {
    Case::new(2, |_, y| vec![y[1].clone(), -&y[0].sin()])
}

/// The pendulum's period 2π/agm(1, cos(θ₀/2)) from rest at θ₀.
fn period(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, (amplitude / 2.0).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    2.0 * std::f64::consts::PI / a
}

fn stopped_at(solution: &integrate::Solution, event: usize) -> f64 {
    match solution.status {
        Status::Stopped { t, cause: StopCause::Event { index } } if index == event => {
            assert_eq!(t, solution.dense.end());
            assert_eq!(solution.dense.step_times().last(), Some(&t));
            t
        }
        ref status => panic!("{status:?} instead of event {event}"),
    }
}

#[test]
fn the_pendulum_swings_in_its_period() {
    // ω = 0 at the start is passed over; next it holds after half a period, at the other turning point
    for amplitude in [0.1, 1.0, 2.0, 3.0] {
        let mut case = pendulum().with_events(1, |_, y, g| {
            g[0] = y[1];
            Ok(())
        });
        let options = Options::with_tolerance(1e-14);
        let solution = attempt(&mut case, 0.0, &[amplitude, 0.0], 100.0, &options);
        let t = stopped_at(&solution, 0);
        let error = 2.0 * t / period(amplitude) - 1.0;
        assert!(error.abs() < 1e-12, "θ₀ = {amplitude}: relative error of the period {error:e}");
        assert!((solution.dense.end_state()[0] + amplitude).abs() < 1e-12);
        // Going on from the event finds the next one, not the same again.
        let solution = attempt(&mut case, t, solution.dense.end_state(), 100.0, &options);
        let error = stopped_at(&solution, 0) / period(amplitude) - 1.0;
        assert!(error.abs() < 1e-12, "θ₀ = {amplitude}: relative error of the period {error:e}");
    }
}

#[test]
fn every_method_finds_the_first_of_several_events_in_both_directions() {
    for method in EVERY {
        for direction in [1.0, -1.0] {
            let mut case = oscillator().with_events(3, |t, y, g| {
                g[0] = y[0] + 0.5; // cos t = −1/2
                g[1] = y[0] - 0.5; // cos t = 1/2: the first
                g[2] = 3.0 - t.abs();
                Ok(())
            });
            let options = Options { method, ..Options::with_tolerance(1e-9) };
            let solution = attempt(&mut case, 0.0, &[1.0, 0.0], 10.0 * direction, &options);
            let t = stopped_at(&solution, 1);
            let exact = direction * std::f64::consts::FRAC_PI_3;
            let limit = if method == TR_BDF2 { 1e-5 } else { 1e-6 };
            assert!((t - exact).abs() < limit, "{method:?}: {t} instead of {exact}");
            assert!((solution.dense.end_state()[0] - 0.5).abs() < 1e-14);
            assert!((state::<2>(&solution, 0.5 * t)[0] - (0.5 * t).cos()).abs() < limit);
            assert!(solution.dense.try_evaluate(t + 1e-6 * direction, &mut [0.0; 2]).is_err());
            assert_eq!(case.evaluations, solution.work.evaluations);
        }
    }
}

/// As a chart's coefficients are where its pivot vanishes: large on both sides of it only.
#[test]
fn an_event_at_the_pole_of_another_does_not_hide_it() {
    let mut case = Case::new(1, |_, y| vec![y[0].number(1.0)]).with_events(2, |t, _, g| {
        g[0] = 1.0 - (t - 53.0).powi(-2); // negative between 52 and 54
        g[1] = t - 53.0;
        Ok(())
    });
    let solution = attempt(&mut case, 0.0, &[0.0], 400.0, &Options::with_tolerance(1e-9));
    assert!((stopped_at(&solution, 0) - 52.0).abs() < 1e-9);
}

/// As the square of a velocity where a motion comes to rest and turns back: the jump makes the steps short.
#[test]
fn an_event_that_touches_zero_at_a_jump_is_seen() {
    for method in EVERY {
        for direction in [1.0, -1.0] {
            let mut case = Case::new(2, |_, y| vec![y[0].number(1.0), &y[0] * &(&y[0] * &y[0]).powf(-0.5)])
                .with_events(1, |_, y, g| {
                    g[0] = y[0] * y[0];
                    Ok(())
                });
            let options = Options { method, ..Options::with_tolerance(1e-11) };
            let solution = attempt(&mut case, 0.0, &[-direction, 0.0], 3.0 * direction, &options);
            let t = stopped_at(&solution, 0);
            assert!((t - direction).abs() < 1e-5, "{method:?}: {t}");
        }
    }
}

#[test]
fn a_double_crossing_within_a_step_is_seen() {
    // The wait is linear, steps grow without bound; the event is positive on (40, 60) only.
    let mut case = Case::new(1, |_, y| vec![y[0].number(1.0)]).with_events(1, |t, _, g| {
        g[0] = 100.0 - (t - 50.0).powi(2);
        Ok(())
    });
    let solution = attempt(&mut case, 0.0, &[0.0], 100.0, &Options::with_tolerance(1e-3));
    let t = stopped_at(&solution, 0);
    assert!((t - 40.0).abs() < 1e-12, "{t}");
    assert!((solution.dense.end_state()[0] - 40.0).abs() < 1e-12);
}

#[test]
fn an_event_at_the_very_end_counts() {
    let mut case = oscillator().with_events(1, |t, _, g| {
        g[0] = t - 2.0;
        Ok(())
    });
    let solution = attempt(&mut case, 0.0, &[1.0, 0.0], 2.0, &Options::with_tolerance(1e-9));
    assert_eq!(stopped_at(&solution, 0), 2.0);
}

#[test]
fn events_that_cannot_be_evaluated_stop_the_run() {
    for method in EVERY {
        let mut case = oscillator().with_events(1, |t, _, g| {
            g[0] = 1.0;
            if t <= 1.0 { Ok(()) } else { Err(EvaluationError { reason: "no event past 1".into() }) }
        });
        let options = Options { method, ..Options::with_tolerance(1e-6) };
        let solution = attempt(&mut case, 0.0, &[1.0, 0.0], 2.0, &options);
        match solution.status {
            Status::Stopped { t, cause: StopCause::Evaluation { reason } } => {
                assert!((t - 1.0).abs() < 1e-9, "{method:?} {t}");
                assert_eq!(reason, "no event past 1");
            }
            status => panic!("{method:?} {status:?}"),
        }
        let mut nan = oscillator().with_events(2, |_, _, g| {
            g[1] = f64::NAN;
            Ok(())
        });
        let status = attempt(&mut nan, 0.0, &[1.0, 0.0], 2.0, &options).status;
        assert!(
            matches!(&status, Status::Stopped { t: 0.0, cause: StopCause::Evaluation { reason } } if reason == "event function 1 is NaN at t = 0"),
            "{status:?}"
        );
    }
}

type RootCase = (fn(f64) -> f64, f64, f64, f64);

#[test]
fn roots() {
    // Brent's test functions, and some that are hard on interpolation.
    let cases: [RootCase; 7] = [
        (|x| x, -1.0, 2.0, 0.0),
        (|x| x.powi(9), -1.0, 4.0, 0.0),
        (|x| x.powi(19), -1.0, 4.0, 0.0),
        (|x| x.exp() - 1e10, -1.0, 100.0, 10.0 * std::f64::consts::LN_10),
        (|x| x.cos(), 1.0, 2.0, std::f64::consts::FRAC_PI_2),
        (|x| if x < 0.7 { -1.0 } else { 1.0 }, 0.0, 1.0, 0.7),
        (|x| (x - 1.0) * (1.0 + (x - 1.0).powi(2)), 0.0, 3.0, 1.0),
    ];
    for (f, a, b, root) in cases {
        for (a, b) in [(a, b), (b, a)] {
            let mut calls = 0;
            let mut counted = |x: f64| {
                calls += 1;
                f(x)
            };
            let found = find_root(&mut counted, a, b, 1e-15).unwrap();
            assert!((found - root).abs() < 1e-14 * root.abs().max(1.0), "{found} instead of {root}");
            assert!(calls < 250, "{calls} calls for the root {root}");
        }
    }
    assert_eq!(find_root(&mut |x| x, 0.0, 1.0, 0.0), Some(0.0));
    assert_eq!(find_root(&mut |x| x - 1.0, 0.0, 1.0, 0.0), Some(1.0));
    assert_eq!(find_root(&mut |x| x + 2.0, 0.0, 1.0, 0.0), None);
    assert_eq!(find_root(&mut |_| f64::NAN, 0.0, 1.0, 0.0), None);
    assert_eq!(find_root(&mut |x| if x == 0.0 || x == 1.0 { x - 0.5 } else { f64::NAN }, 0.0, 1.0, 0.0), None);
    assert_eq!(find_root(&mut |x| x, f64::NEG_INFINITY, 1.0, 0.0), None);
}
