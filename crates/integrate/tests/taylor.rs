//! Taylor series: accuracy against the tolerance, step control where coefficients mislead, counters.

use crate::problems::*;
use integrate::{Dense, DenseError, Method, Options, Status};

fn options(tolerance: f64) -> Options {
    Options { method: Method::Taylor, ..Options::with_tolerance(tolerance) }
}

#[test]
fn errors_follow_the_tolerance_down_to_round_off() {
    for exponent in [3, 5, 7, 9, 11, 13, 15] {
        let tolerance = 10f64.powi(-exponent);
        let solution = run(&mut oscillator(), 0.0, &[1.0, 0.0], 50.0, &options(tolerance));
        let off = errors(&solution, circle).0;
        // Each step may err by the tolerance; fifty radians, errors add up.
        assert!(off < 20.0 * tolerance + 1e-13, "oscillator at {tolerance:e}: {off:e}");
        let solution = run(&mut nonautonomous(), 0.0, &[1.0], 40.0, &options(tolerance));
        let off = errors(&solution, |t| [t.sin().exp()]).0;
        assert!(off < 200.0 * tolerance + 1e-13, "y' = y cos t at {tolerance:e}: {off:e}");
    }
}

#[test]
fn the_arenstorf_orbit_closes() {
    // Errors grow a millionfold along this orbit.
    for (tolerance, limit) in [(1e-12, 1e-5), (1e-15, 1e-7)] {
        let solution = run(&mut arenstorf(), 0.0, &ARENSTORF_START, ARENSTORF_PERIOD, &options(tolerance));
        let missed = distance(solution.dense.end_state(), &ARENSTORF_START);
        assert!(missed < limit, "{tolerance:e}: misses the start by {missed:e}");
    }
}

#[test]
fn an_order_counts_as_one_and_an_expansion_as_one_evaluation() {
    let mut case = oscillator();
    let solution = run(&mut case, 0.0, &[1.0, 0.0], 10.0, &options(1e-9));
    let work = solution.work;
    // ⌈1 + 9 ln 10⌉ = 22 orders, at the start and at the end of every step.
    assert_eq!((work.evaluations, work.orders), (work.steps + 1, 22 * (work.steps + 1)));
    assert_eq!((case.evaluations, work.jacobians, work.rejected), (work.evaluations, 0, 0));
}

#[test]
fn ends_alone_are_the_same_ends() {
    let everywhere = run(&mut nonautonomous(), 0.0, &[1.0], 10.0, &options(1e-10));
    let ends = Options { dense: Dense::EndOnly, ..options(1e-10) };
    let ends = run(&mut nonautonomous(), 0.0, &[1.0], 10.0, &ends);
    assert_eq!(ends.dense.end_state(), everywhere.dense.end_state());
    assert!(matches!(ends.dense.try_evaluate(5.0, &mut [0.0]), Err(DenseError::NotStored { .. })));
}

#[test]
fn coefficients_that_vanish_in_groups_do_not_mislead() {
    // y' = 7t⁶ y: y = exp(t⁷), whose coefficients at 0 are zero but for every seventh order.
    let mut case = Case::new(1, |t, y| {
        let cube = &(t * t) * t;
        vec![&(&(&cube * &cube) * &y[0]) * 7.0]
    });
    for tolerance in [1e-4, 1e-7, 1e-10, 1e-13] {
        for (from, to) in [(0.0, 1.2), (-1.2, 1.2), (1.2, -1.2)] {
            let start = f64::powi(from, 7).exp();
            let solution = run(&mut case, from, &[start], to, &options(tolerance));
            let off = errors(&solution, |t| [t.powi(7).exp()]).0;
            // Backwards the solution grows a thousandfold, and errors with it.
            let limit = if from == 0.0 { 100.0 } else { 1e5 };
            assert!(off < limit * tolerance + 1e-11, "{tolerance:e} from {from}: {off:e}");
        }
    }
    // y = t³: a polynomial is done in one step.
    let mut cubic = Case::new(1, |t, _| vec![&(t * t) * 3.0]);
    let solution = run(&mut cubic, 0.0, &[0.0], 10.0, &options(1e-12));
    assert_eq!(solution.dense.end_state(), [1000.0]);
    assert!(solution.work.steps < 12, "{:?}", solution.work);
}

#[test]
fn a_branch_point_is_not_passed() {
    // y' = −√(1 + y): y = (1 − t/2)² − 1 up to t = 2; there the polynomial rises, the solution stays at −1.
    let mut case = Case::new(1, |_, y| vec![-&(&y[0] + &y[0].number(1.0)).powf(0.5)]);
    let options = Options { max_steps: 1000, ..options(1e-9) };
    let solution = attempt(&mut case, 0.0, &[0.0], 9.0, &options);
    // How it ends there is up to round-off of 1 + y; that it does not come up again is not.
    assert!(solution.work.rejected > 0, "{:?}", solution.work);
    let Status::Stopped { t, .. } = solution.status else { panic!("{:?}", solution.status) };
    assert!(t > 1.9, "stopped at {t}");
    for i in 0..=100 {
        let t = t * f64::from(i) / 100.0;
        let [y] = state(&solution, t);
        let exact = if t < 2.0 { (1.0 - 0.5 * t).powi(2) - 1.0 } else { -1.0 };
        assert!((y - exact).abs() < 1e-6, "{y} at {t}");
    }
}

#[test]
fn units_of_time_do_not_matter() {
    // y' = ω y cos ωt
    let scaled = |omega: f64| Case::new(1, move |t, y| vec![&(&y[0] * &(t * omega).cos()) * omega]);
    let plain = run(&mut scaled(1.0), 0.0, &[1.0], 10.0, &options(1e-13));
    for omega in [1e12, 1e-12, 1e25, 1e-25, 1e100] {
        let solution = run(&mut scaled(omega), 0.0, &[1.0], 10.0 / omega, &options(1e-13));
        let off = (solution.dense.end_state()[0] - 10f64.sin().exp()).abs();
        assert!(off < 1e-11, "ω = {omega:e}: {off:e}");
        assert!(solution.work.steps.abs_diff(plain.work.steps) < 3, "ω = {omega:e}: {:?}", solution.work);
    }
}
