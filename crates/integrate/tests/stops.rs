//! Every way in which a run ends before its end, every bad call, and the counters.

use crate::problems::*;
use integrate::{CallError, EvaluationError, Interrupt, Method, Options, Problem, Start, Status, StopCause, integrate};

fn options(method: Method) -> Options {
    Options { method, ..Options::with_tolerance(1e-7) }
}

fn one(t: f64) -> Start {
    Start { t, y: vec![1.0] }
}

#[test]
fn nothing_gets_past_a_blow_up() {
    for method in Method::ALL {
        for (tolerance, limit) in [(1e-3, 2e-2), (1e-6, 2e-4), (1e-9, 2e-6)] {
            let options = Options { method, ..Options::with_tolerance(tolerance) };
            for (sign, start) in [(1.0, 1.0), (-1.0, -1.0)] {
                // Forwards from 1 and, mirrored, backwards from −1: both explode at |t| = 1.
                let start = Start { t: 0.0, y: vec![start] };
                let solution = integrate(&mut blow_up(), &start, 2.0 * sign, &options).unwrap();
                let Status::Stopped { t, ref cause } = solution.status else {
                    panic!("{method:?} {tolerance:e}: success past the end of the solution")
                };
                assert!((t.abs() - 1.0).abs() < limit, "{method:?} {tolerance:e}: stopped at {t}");
                assert!(
                    matches!(cause, StopCause::StepTooSmall { .. } | StopCause::NotFinite { component: 0 }),
                    "{method:?} {tolerance:e}: {cause:?}"
                );
                assert!(solution.dense.end_state()[0].is_finite());
                let mut y = [0.0];
                solution.dense.evaluate(0.5 * sign, &mut y);
                assert!((sign * y[0] - 2.0).abs() < limit, "{method:?} {tolerance:e}: {y:?}");
            }
        }
    }
}

#[test]
fn rates_that_are_not_finite_are_named() {
    for method in Method::ALL {
        // From the start on.
        let mut nan = Case::new(
            2,
            |_, _, r| {
                (r[0], r[1]) = (0.0, f64::NAN);
                Ok(())
            },
            |_, _, j| j.fill(0.0),
        )
        .with_series(|_, y| vec![y[0].number(0.0), y[0].number(f64::NAN)]);
        let start = Start { t: 0.0, y: vec![1.0, 1.0] };
        let status = integrate(&mut nan, &start, 1.0, &options(method)).unwrap().status;
        let not_finite = StopCause::NotFinite { component: 1 };
        assert_eq!(status, Status::Stopped { t: 0.0, cause: not_finite.clone() }, "{method:?}");
        // From t = 1/3 on.
        let mut wall = Case::new(
            2,
            |t, _, r| {
                (r[0], r[1]) = (1.0, if t > 1.0 / 3.0 { f64::INFINITY } else { -1.0 });
                Ok(())
            },
            |_, _, j| j.fill(0.0),
        )
        .with_series(|_, y| vec![y[0].number(1.0), y[0].number(-1.0)]);
        let solution = integrate(&mut wall, &start, 1.0, &options(method)).unwrap();
        match solution.status {
            Status::Stopped { t, ref cause } => {
                assert_eq!(*cause, not_finite, "{method:?}");
                assert!((t - 1.0 / 3.0).abs() < 1e-9, "{method:?}: stopped at {t}");
                assert!((solution.dense.end_state()[1] - (1.0 - t)).abs() < 1e-9, "{method:?}");
            }
            status => panic!("{method:?} {status:?}"),
        }
    }
}

#[test]
fn a_wall_is_walked_up_to_and_reported_in_the_problems_words() {
    // y' = −√(1 + y), y(0) = 0: y = (1 − t/2)² − 1 reaches the wall y = −1 at t = 2, with zero slope; y' = −1/y runs
    // into y = 0 at t = 1/2, with infinite slope. Backwards alike.
    let gentle = Case::new(
        1,
        |_, y, r| {
            if y[0] < -0.75 {
                return Err(EvaluationError { reason: format!("depth {} under the floor −0.75", y[0]) });
            }
            r[0] = -(1.0 + y[0]).sqrt();
            Ok(())
        },
        |_, y, j| j[0] = -0.5 / (1.0 + y[0]).sqrt(),
    )
    .with_series(|_, y| vec![-&(&y[0] + &y[0].number(1.0)).powf(0.5)]);
    let steep = Case::new(
        1,
        |_, y, r| {
            if y[0] <= 0.0 {
                return Err(EvaluationError { reason: "not above 0".into() });
            }
            r[0] = -1.0 / y[0];
            Ok(())
        },
        |_, y, j| j[0] = 1.0 / (y[0] * y[0]),
    )
    .with_series(|_, y| vec![-&y[0].powf(-1.0)]);
    for method in Method::ALL {
        let solution = integrate(&mut gentle.clone(), &Start { t: 0.0, y: vec![0.0] }, 9.0, &options(method)).unwrap();
        match solution.status {
            Status::Stopped { t, cause: StopCause::Evaluation { reason } } => {
                assert!((t - 1.0).abs() < 1e-4, "{method:?}: stopped at {t}");
                assert!(reason.contains("under the floor"), "{method:?}: {reason}");
                assert!((solution.dense.end_state()[0] + 0.75).abs() < 1e-9, "{method:?}");
            }
            status => panic!("{method:?} {status:?}"),
        }
        let solution = integrate(&mut steep.clone(), &one(0.0), 9.0, &options(method)).unwrap();
        match solution.status {
            Status::Stopped { t, cause: StopCause::Evaluation { .. } | StopCause::StepTooSmall { .. } } => {
                assert!((t - 0.5).abs() < 1e-3, "{method:?}: stopped at {t}");
            }
            status => panic!("{method:?} {status:?}"),
        }
    }
}

#[test]
fn a_wall_next_to_the_start_is_no_hindrance_on_the_way_away() {
    for method in Method::ALL {
        let mut case = Case::new(
            1,
            |t, y, r| {
                if !(0.0..=1.0).contains(&t) {
                    return Err(EvaluationError { reason: format!("outside of [0, 1]: {t}") });
                }
                r[0] = y[0];
                Ok(())
            },
            |_, _, j| j[0] = 1.0,
        )
        .with_series(|_, y| vec![y[0].clone()]);
        let solution = integrate(&mut case, &one(0.0), 1.0, &options(method)).unwrap();
        assert_eq!(solution.status, Status::Completed, "{method:?}");
        assert!((solution.dense.end_state()[0] - std::f64::consts::E).abs() < 1e-4);
        let solution = integrate(&mut case, &one(1.0), 0.0, &options(method)).unwrap();
        assert_eq!(solution.status, Status::Completed, "{method:?}");
    }
}

#[test]
fn failing_projections_and_jacobians_stop_the_run() {
    for method in Method::ALL {
        let mut case = oscillator().with_projection(|t, _| match t <= 0.5 {
            true => Ok(0.0),
            false => Err(EvaluationError { reason: "no projection past 1/2".into() }),
        });
        let start = Start { t: 0.0, y: vec![1.0, 0.0] };
        let status = integrate(&mut case, &start, 2.0, &options(method)).unwrap().status;
        assert!(
            matches!(&status, Status::Stopped { t, cause: StopCause::Evaluation { reason } }
                if (t - 0.5).abs() < 1e-9 && reason == "no projection past 1/2"),
            "{method:?} {status:?}"
        );
        let mut case = oscillator().with_projection(|_, y| {
            y[1] = f64::NAN;
            Ok(1.0)
        });
        let status = integrate(&mut case, &start, 2.0, &options(method)).unwrap().status;
        assert_eq!(status, Status::Stopped { t: 0.0, cause: StopCause::NotFinite { component: 1 } }, "{method:?}");
    }
    for method in [Method::Bdf, Method::TrBdf2, Method::Esdirk34, Method::Radau5] {
        let mut case = Case { jacobian: |_, _, j| j.fill(f64::NAN), ..oscillator() };
        let start = Start { t: 0.0, y: vec![1.0, 0.0] };
        let status = integrate(&mut case, &start, 2.0, &options(method)).unwrap().status;
        assert!(
            matches!(&status, Status::Stopped { t: 0.0, cause: StopCause::Evaluation { reason } } if reason.contains("Jacobian")),
            "{method:?} {status:?}"
        );
    }
}

#[test]
fn steps_are_limited() {
    for method in Method::ALL {
        let start = Start { t: 0.0, y: vec![1.0, 0.0] };
        let options = Options { max_steps: 10, ..options(method) };
        let solution = integrate(&mut oscillator(), &start, 100.0, &options).unwrap();
        let cause = StopCause::TooManySteps { limit: 10 };
        assert_eq!(solution.status, Status::Stopped { t: solution.dense.end(), cause }, "{method:?}");
        assert!(solution.work.steps > 0 && solution.work.steps + solution.work.rejected >= 10);
        assert!(solution.dense.end() > 0.0 && solution.dense.end() < 100.0);
    }
}

#[test]
fn work_is_counted_to_the_evaluation() {
    for method in Method::ALL {
        for case in [oscillator(), oscillator().with_projection(onto_circle)] {
            let mut case = case;
            let start = Start { t: 0.0, y: vec![1.0, 0.0] };
            let solution = integrate(&mut case, &start, 10.0, &options(method)).unwrap();
            assert_eq!(solution.work.evaluations, case.evaluations, "{method:?}");
            assert_eq!(solution.work.jacobians, case.jacobians, "{method:?}");
            let implicit = method.is_implicit();
            assert_eq!(solution.work.jacobians > 0, implicit, "{method:?}");
        }
        // On the way to a wall, too.
        let mut case = blow_up();
        let solution = integrate(&mut case, &one(0.0), 2.0, &options(method)).unwrap();
        assert_eq!(solution.work.evaluations, case.evaluations, "{method:?}");
    }
}

#[test]
fn the_end_is_hit_exactly() {
    for method in Method::ALL {
        for (t, end) in [(0.0, 1.0), (0.1, 0.7), (1e6, 1e6 + 1.0), (0.0, 1e-9), (-3.0, -0.3), (2.0, 1.9), (0.0, -1e3)] {
            let solution = integrate(&mut nonautonomous(), &one(t), end, &options(method)).unwrap();
            assert_eq!(solution.status, Status::Completed, "{method:?} from {t} to {end}");
            assert_eq!(solution.dense.end().to_bits(), end.to_bits());
            assert_eq!(solution.dense.start().to_bits(), t.to_bits());
            let exact = (end.sin() - t.sin()).exp();
            let error = (solution.dense.end_state()[0] - exact).abs();
            assert!(error < 1e-3, "{method:?} from {t} to {end}: {error:e}");
        }
    }
}

#[test]
fn every_bad_call() {
    let good = Options::with_tolerance(1e-6);
    let call = |start: &Start, end: f64, options: &Options| integrate(&mut oscillator(), start, end, options).err();
    let start = Start { t: 0.0, y: vec![1.0, 0.0] };
    assert_eq!(call(&start, 1.0, &good), None);
    let short = Start { t: 0.0, y: vec![1.0] };
    assert_eq!(call(&short, 1.0, &good), Some(CallError::Dimension { expected: 2, found: 1 }));
    let mut empty = Case::new(0, |_, _, _| Ok(()), |_, _, _| ());
    let nothing = Start { t: 0.0, y: vec![] };
    let no_unknowns = CallError::NoUnknowns { found: 0, limit: 1 };
    assert_eq!(integrate(&mut empty, &nothing, 1.0, &good).err(), Some(no_unknowns));
    for found in [0.0, -1.0, 1.0, f64::INFINITY] {
        let options = Options { relative_tolerance: found, ..good.clone() };
        assert_eq!(call(&start, 1.0, &options), Some(CallError::RelativeTolerance { found, limit: 1.0 }));
    }
    for found in [0.0, -1.0, f64::INFINITY] {
        let options = Options { absolute_tolerance: found, ..good.clone() };
        assert_eq!(call(&start, 1.0, &options), Some(CallError::AbsoluteTolerance { found, limit: 0.0 }));
    }
    let options = Options { relative_tolerance: f64::NAN, ..good.clone() };
    assert!(matches!(call(&start, 1.0, &options), Some(CallError::RelativeTolerance { .. })));
    let options = Options { absolute_tolerance: f64::NAN, ..good.clone() };
    assert!(matches!(call(&start, 1.0, &options), Some(CallError::AbsoluteTolerance { .. })));
    let options = Options { sizes: vec![1.0], ..good.clone() };
    assert_eq!(call(&start, 1.0, &options), Some(CallError::Sizes { expected: 2, found: 1 }));
    for found in [0.0, -1.0, f64::INFINITY] {
        let options = Options { sizes: vec![1.0, found], ..good.clone() };
        assert_eq!(call(&start, 1.0, &options), Some(CallError::Size { component: 1, found, limit: 0.0 }));
    }
    let infinite = Start { t: 0.0, y: vec![1.0, f64::INFINITY] };
    let not_finite = CallError::StartNotFinite { component: 1, found: f64::INFINITY };
    assert_eq!(call(&infinite, 1.0, &good), Some(not_finite));
    assert_eq!(call(&start, f64::INFINITY, &good), Some(CallError::TimeNotFinite { start: 0.0, end: f64::INFINITY }));
    assert!(matches!(
        call(&Start { t: f64::NAN, y: vec![1.0, 0.0] }, 1.0, &good),
        Some(CallError::TimeNotFinite { .. })
    ));
    assert!(matches!(call(&start, 0.0, &good), Some(CallError::EmptyInterval { start: 0.0, end: 0.0, .. })));
    let late = Start { t: 1.0, y: vec![1.0, 0.0] };
    assert!(matches!(call(&late, 1.0f64.next_up(), &good), Some(CallError::EmptyInterval { .. })));
    let taylor = Options { method: Method::Taylor, ..good.clone() };
    assert_eq!(
        integrate(&mut robertson(), &Start { t: 0.0, y: vec![1.0; 3] }, 1.0, &taylor).err(),
        Some(CallError::NoTaylor)
    );
    let options = Options { max_steps: 0, ..good };
    assert_eq!(call(&start, 1.0, &options), Some(CallError::MaxSteps { found: 0, limit: 1 }));
}

/// The oscillator, which raises the flag once it is past t = 1.
struct Interrupting {
    case: Case,
    interrupt: Interrupt,
}

impl Problem for Interrupting {
    fn dimension(&self) -> usize {
        self.case.dimension()
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        if t > 1.0 {
            self.interrupt.raise();
        }
        self.case.rates(t, y, rates)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        self.case.jacobian(t, y, jacobian)
    }
    fn has_taylor(&self) -> bool {
        true
    }
    fn taylor(&mut self, t: f64, y: &[f64], unit: f64, coefficients: &mut [f64]) -> Result<(), EvaluationError> {
        if t > 1.0 {
            self.interrupt.raise();
        }
        self.case.taylor(t, y, unit, coefficients)
    }
}

#[test]
fn an_interrupt_ends_the_run_at_the_end_of_a_step() {
    for method in Method::ALL {
        let interrupt = Interrupt::default();
        let options = Options { interrupt: Some(interrupt.clone()), ..options(method) };
        let mut problem = Interrupting { case: oscillator(), interrupt };
        let start = Start { t: 0.0, y: vec![1.0, 0.0] };
        let solution = integrate(&mut problem, &start, 100.0, &options).unwrap();
        let end = solution.dense.end();
        assert_eq!(solution.status, Status::Stopped { t: end, cause: StopCause::Interrupted }, "{method:?}");
        assert!(end > 0.0 && end < 10.0, "{method:?}: {end}");
        assert!((solution.dense.end_state()[0] - end.cos()).abs() < 1e-4, "{method:?}");
        // the flag stays up: what starts after it makes no step
        let solution = integrate(&mut oscillator(), &start, 100.0, &options).unwrap();
        assert_eq!(solution.status, Status::Stopped { t: 0.0, cause: StopCause::Interrupted }, "{method:?}");
        assert_eq!(solution.work.steps, 0);
    }
}

/// `y' = 1`, and everything that was accepted.
struct Diary {
    accepted: Vec<(f64, f64)>,
    refuse: usize,
}

impl Problem for Diary {
    fn dimension(&self) -> usize {
        1
    }
    fn rates(&mut self, t: f64, _: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        rates[0] = t.cos();
        Ok(())
    }
    fn jacobian(&mut self, _: f64, _: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        jacobian[0] = 0.0;
        Ok(())
    }
    fn has_taylor(&self) -> bool {
        true
    }
    fn taylor(&mut self, t: f64, y: &[f64], unit: f64, coefficients: &mut [f64]) -> Result<(), EvaluationError> {
        solution(|t, _| vec![t.cos()], t, y, unit, coefficients);
        Ok(())
    }
    fn accepted(&mut self, t: f64, y: &[f64]) -> Result<(), EvaluationError> {
        if self.refuse > 0 {
            self.refuse -= 1;
            return Err(EvaluationError { reason: "not yet".into() });
        }
        self.accepted.push((t, y[0]));
        Ok(())
    }
}

#[test]
fn a_problem_is_told_of_every_accepted_state_and_may_refuse_one() {
    for method in Method::ALL {
        for refuse in [0, 3] {
            let mut diary = Diary { accepted: Vec::new(), refuse };
            let mut options = Options::with_tolerance(1e-8);
            options.method = method;
            let start = Start { t: 0.0, y: vec![0.0] };
            let solution = integrate(&mut diary, &start, 2.0, &options).unwrap();
            assert_eq!(solution.status, Status::Completed, "{method:?}");
            let times: Vec<f64> = diary.accepted.iter().map(|a| a.0).collect();
            let steps = solution.dense.step_times();
            assert_eq!(times, steps[steps.len() - times.len()..], "{method:?}");
            assert_eq!(diary.accepted.last().map(|a| a.1), Some(solution.dense.end_state()[0]));
            assert!(refuse == 0 || solution.work.rejected >= refuse, "{method:?}: {:?}", solution.work);
        }
    }
}
