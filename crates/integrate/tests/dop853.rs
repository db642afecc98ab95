//! DOP853: orders, accuracy at the round-off plateau, counters.

use crate::problems::*;
use integrate::{Dense, DenseError, Options};

#[test]
fn a_nonautonomous_problem_gives_order_eight_at_the_steps_and_seven_between() {
    let (mut at_ends, mut between) = (Vec::new(), Vec::new());
    for tolerance in [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13] {
        let solution = run(&mut nonautonomous(), 0.0, &[1.0], 40.0, &Options::with_tolerance(tolerance));
        let (everywhere, ends) = errors(&solution, |t| [t.sin().exp()]);
        at_ends.push((solution.work.steps as f64, ends));
        between.push((solution.work.steps as f64, everywhere));
    }
    let orders = (-slope(&at_ends), -slope(&between));
    assert!((7.2..9.5).contains(&orders.0), "order {} at the ends of the steps: {at_ends:?}", orders.0);
    assert!((6.7..8.7).contains(&orders.1), "order {} between: {between:?}", orders.1);
}

#[test]
fn the_arenstorf_orbit_closes() {
    let points: Vec<(f64, f64)> = [1e-8, 1e-9, 1e-10, 1e-11, 1e-12]
        .iter()
        .map(|&tolerance| {
            let options = Options::with_tolerance(tolerance);
            let solution = run(&mut arenstorf(), 0.0, &ARENSTORF_START, ARENSTORF_PERIOD, &options);
            (solution.work.steps as f64, distance(solution.dense.end_state(), &ARENSTORF_START))
        })
        .collect();
    let order = -slope(&points);
    assert!(order > 7.5, "order {order} from {points:?}");
    assert!(points[4].1 < 1e-8, "{points:?}");
}

#[test]
fn round_off_is_a_plateau_and_no_trap() {
    for tolerance in [1e-14, 1e-15, 1e-16, 1e-18] {
        let options = Options::with_tolerance(tolerance);
        let solution = run(&mut oscillator(), 0.0, &[1.0, 0.0], 20.0, &options);
        let (everywhere, _) = errors(&solution, circle);
        assert!(everywhere < 6.0 * tolerance.max(4e-15), "{tolerance:e}: {everywhere:e}");
        assert!(solution.work.steps < 500 && solution.work.rejected < 20, "{:?}", solution.work);
        let solution = run(&mut arenstorf(), 0.0, &ARENSTORF_START, ARENSTORF_PERIOD, &options);
        assert!(solution.work.steps < 2000 && solution.work.rejected < 200, "{:?}", solution.work);
    }
}

#[test]
fn ends_alone_cost_three_evaluations_a_step_less_and_say_so() {
    let everywhere = Options::with_tolerance(1e-10);
    let ends = Options { dense: Dense::EndOnly, ..everywhere.clone() };
    let [a, b] = [&everywhere, &ends].map(|options| run(&mut oscillator(), 0.0, &[1.0, 0.0], 10.0, options));
    assert_eq!(a.dense.end_state(), b.dense.end_state());
    assert_eq!(a.work.evaluations, b.work.evaluations + 3 * a.work.steps);
    assert_eq!(b.work.evaluations, 2 + 12 * b.work.steps + 11 * b.work.rejected);
    assert_eq!(state(&b, 0.0), [1.0, 0.0]);
    assert_eq!(state::<2>(&b, 10.0), b.dense.end_state());
    let not_stored = DenseError::NotStored { t: 5.0, start: 0.0, end: 10.0 };
    assert_eq!(b.dense.try_evaluate(5.0, &mut [0.0; 2]), Err(not_stored));
}

#[test]
fn slopes_match_where_steps_meet() {
    let solution = run(&mut oscillator(), 0.0, &[1.0, 0.0], 10.0, &Options::with_tolerance(1e-6));
    let times = solution.dense.step_times();
    let state = |t: f64| state::<2>(&solution, t);
    let d = 1e-4;
    for t in &times[1..times.len() - 1] {
        let (before, at, after) = (state(t - d), state(*t), state(t + d));
        for i in 0..2 {
            let (left, right) = ((at[i] - before[i]) / d, (after[i] - at[i]) / d);
            assert!((left - right).abs() < 2.0 * d, "slope jumps from {left} to {right} at {t}");
        }
    }
}

/// Where a motion is fast, `|y|/|F|` is the shortest bound on the first step; both runs would begin with it.
#[test]
fn runs_of_other_tolerances_do_not_share_the_error_of_their_first_step() {
    let start = 0.5;
    let mut problem = Case::new(1, |t, _| vec![&(t * 1000.0).cos() * 1000.0]);
    let exact = |t: f64| start + (1000.0 * t).sin();
    let [looser, kept] =
        [1e-8, 1e-10].map(|tolerance| run(&mut problem, 0.0, &[start], 0.02, &Options::with_tolerance(tolerance)));
    let first = looser.dense.step_times()[1];
    assert!(kept.dense.step_times()[1] < 0.9 * first, "{first} {}", kept.dense.step_times()[1]);
    for i in 1..20 {
        let t = first * f64::from(i) / 20.0;
        let [a, b] = [&looser, &kept].map(|run| state::<1>(run, t)[0]);
        let error = (b - exact(t)).abs();
        assert!(error <= 2.0 * (a - b).abs() + 1e-15, "{error:e} at {t}, the runs differ by {:e}", (a - b).abs());
    }
}
