//! The dense output of every method.

use crate::problems::*;
use diffsol_methods::{EVERY, TR_BDF2};
use integrate::{DenseError, Method, Options, Projection};

#[test]
fn it_is_continuous_also_where_states_are_projected() {
    for method in EVERY {
        for projection in [Projection::EveryStep, Projection::Off] {
            let options = Options { method, projection, ..Options::with_tolerance(1e-5) };
            let mut case = oscillator().with_projection(onto_circle);
            let solution = run(&mut case, 0.0, &[1.0, 0.0], 10.0, &options);
            let times = solution.dense.step_times();
            assert_eq!(times.len(), solution.work.steps + 1);
            assert_eq!((times[0], times[times.len() - 1]), (0.0, 10.0));
            for &t in &times[1..] {
                let [before, at]: [[f64; 2]; 2] = [t.next_down(), t].map(|t| state(&solution, t));
                assert!(distance(&before, &at) < 1e-14, "{method:?}: jump at {t}: {before:?} {at:?}");
                if projection == Projection::EveryStep {
                    assert!((at[0].hypot(at[1]) - 1.0).abs() < 4e-16, "{method:?}: off the circle at {t}");
                }
            }
        }
    }
}

#[test]
fn it_is_as_good_as_the_steps() {
    // Within a small factor of the error at the ends of the steps, for every method. Those of Radau5 are of
    // an order that its polynomial does not have, and the measure is the tolerance.
    for method in EVERY {
        let options = Options { method, ..Options::with_tolerance(1e-7) };
        let solution = run(&mut oscillator(), 0.0, &[1.0, 0.0], 10.0, &options);
        let error = |t: f64| distance(&state::<2>(&solution, t), &circle(t));
        let ends = solution.dense.step_times().iter().map(|&t| error(t)).fold(0.0, f64::max);
        let between = largest_error(&solution, 20_000, circle);
        let ends = if method == Method::Radau5 { ends.max(1e-7) } else { ends };
        assert!(between < 3.0 * ends, "{method:?}: {between:e} between, {ends:e} at the ends of the steps");
    }
}

#[test]
fn questions_it_cannot_answer() {
    for (from, to) in [(1.0, 3.0), (3.0, 1.0)] {
        let solution = run(&mut oscillator(), from, &[1.0, 0.0], to, &Options::with_tolerance(1e-9));
        let (dense, mut y) = (&solution.dense, [7.0; 2]);
        assert_eq!((dense.start(), dense.end(), dense.dimension()), (from, to, 2));
        for t in [0.9, 3.1, f64::NAN, f64::INFINITY] {
            let answer = dense.try_evaluate(t, &mut y);
            assert!(matches!(answer, Err(DenseError::OutsideRange { start, end, .. }) if (start, end) == (from, to)));
        }
        assert_eq!(y, [7.0; 2]);
        let short = dense.try_evaluate(2.0, &mut y[..1]);
        assert_eq!(short, Err(DenseError::Dimension { expected: 2, found: 1 }));
        // Round-off outside is clamped.
        for t in [1.0f64.next_down(), 3.0f64.next_up()] {
            dense.try_evaluate(t, &mut y).unwrap();
            let end = if (t < 2.0) == (from < 2.0) { dense.start_state() } else { dense.end_state() };
            assert_eq!(y, end);
        }
    }
}

#[test]
fn backward_integration_returns_to_the_start() {
    for method in EVERY {
        let options = Options { method, ..Options::with_tolerance(1e-9) };
        let there = run(&mut nonautonomous(), 0.5, &[1.0], 4.0, &options);
        let back = run(&mut nonautonomous(), 4.0, there.dense.end_state(), 0.5, &options);
        let missed = (back.dense.end_state()[0] - 1.0).abs();
        let limit = if method == TR_BDF2 { 1e-4 } else { 1e-6 };
        assert!(missed < limit, "{method:?}: misses the start by {missed:e}");
        for i in 0..=35 {
            let t = 0.5 + 0.1 * f64::from(i);
            let ([a], [b]) = (state(&there, t), state(&back, t));
            assert!((a - b).abs() < limit, "{method:?} at {t}");
        }
    }
}
