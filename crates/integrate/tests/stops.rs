//! Every way in which a run ends before its end, every bad call, and the counters.

use crate::problems::*;
use diffsol_methods::{BDF, ESDIRK34, EVERY, TR_BDF2};
use integrate::{CallError, EvaluationError, Interrupt, Method, Options, Start, Status, StopCause, integrate};

fn options(method: Method) -> Options {
    Options { method, ..Options::with_tolerance(1e-7) }
}

#[test]
fn nothing_gets_past_a_blow_up() {
    for method in EVERY {
        for (tolerance, limit) in [(1e-3, 2e-2), (1e-6, 2e-4), (1e-9, 2e-6)] {
            let options = Options { method, ..Options::with_tolerance(tolerance) };
            for (sign, start) in [(1.0, 1.0), (-1.0, -1.0)] {
                // Forwards from 1 and, mirrored, backwards from −1: both explode at |t| = 1.
                let solution = attempt(&mut blow_up(), 0.0, &[start], 2.0 * sign, &options);
                let Status::Stopped { t, ref cause } = solution.status else {
                    panic!("{method:?} {tolerance:e}: success past the end of the solution")
                };
                assert!((t.abs() - 1.0).abs() < limit, "{method:?} {tolerance:e}: stopped at {t}");
                assert!(
                    matches!(
                        cause,
                        StopCause::StepTooSmall { .. }
                            | StopCause::NotFinite { component: 0 }
                            | StopCause::Creeping { .. }
                    ),
                    "{method:?} {tolerance:e}: {cause:?}"
                );
                assert!(solution.dense.end_state()[0].is_finite());
                let [y] = state(&solution, 0.5 * sign);
                assert!((sign * y - 2.0).abs() < limit, "{method:?} {tolerance:e}: {y:?}");
            }
        }
    }
}

#[test]
fn rates_that_are_not_finite_are_named() {
    for method in EVERY {
        // From the start on.
        let mut nan = Case::new(2, |_, y| vec![y[0].number(0.0), y[0].number(f64::NAN)]);
        let status = attempt(&mut nan, 0.0, &[1.0, 1.0], 1.0, &options(method)).status;
        let not_finite = StopCause::NotFinite { component: 1 };
        assert_eq!(status, Status::Stopped { t: 0.0, cause: not_finite.clone() }, "{method:?}");
        // From t = 1/3 on.
        let second = |t: f64| if t > 1.0 / 3.0 { f64::INFINITY } else { -1.0 };
        let mut wall = Case::new(2, move |t, y| vec![y[0].number(1.0), y[0].number(second(t.0[0]))]);
        let solution = attempt(&mut wall, 0.0, &[1.0, 1.0], 1.0, &options(method));
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
    // y' = −√(1 + y), y(0) = 0: y = (1 − t/2)² − 1 reaches the wall y = −1 at t = 2, with zero slope; y' =
    // −1/y runs into y = 0 at t = 1/2, with infinite slope. Backwards alike.
    let gentle = Case::new(1, |_, y| vec![-&(&y[0] + &y[0].number(1.0)).powf(0.5)])
        .with_refusal(|_, y| (y[0] < -0.75).then(|| format!("depth {} under the floor −0.75", y[0])));
    let steep =
        Case::new(1, |_, y| vec![-&y[0].powf(-1.0)]).with_refusal(|_, y| (y[0] <= 0.0).then(|| "not above 0".into()));
    for method in EVERY {
        let solution = attempt(&mut gentle.clone(), 0.0, &[0.0], 9.0, &options(method));
        match solution.status {
            Status::Stopped { t, cause: StopCause::Evaluation { reason } } => {
                assert!((t - 1.0).abs() < 1e-4, "{method:?}: stopped at {t}");
                assert!(reason.contains("under the floor"), "{method:?}: {reason}");
                assert!((solution.dense.end_state()[0] + 0.75).abs() < 1e-9, "{method:?}");
            }
            status => panic!("{method:?} {status:?}"),
        }
        let solution = attempt(&mut steep.clone(), 0.0, &[1.0], 9.0, &options(method));
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
    for method in EVERY {
        let mut case = Case::new(1, |_, y| vec![y[0].clone()])
            .with_refusal(|t, _| (!(0.0..=1.0).contains(&t)).then(|| format!("outside of [0, 1]: {t}")));
        let solution = run(&mut case, 0.0, &[1.0], 1.0, &options(method));
        assert!((solution.dense.end_state()[0] - std::f64::consts::E).abs() < 1e-4);
        run(&mut case, 1.0, &[1.0], 0.0, &options(method));
    }
}

#[test]
fn failing_projections_and_jacobians_stop_the_run() {
    for method in EVERY {
        let mut case = oscillator().with_projection(|t, _| match t <= 0.5 {
            true => Ok(0.0),
            false => Err(EvaluationError { reason: "no projection past 1/2".into() }),
        });
        let status = attempt(&mut case, 0.0, &[1.0, 0.0], 2.0, &options(method)).status;
        assert!(
            matches!(&status, Status::Stopped { t, cause: StopCause::Evaluation { reason } }
                if (t - 0.5).abs() < 1e-9 && reason == "no projection past 1/2"),
            "{method:?} {status:?}"
        );
        let mut case = oscillator().with_projection(|_, y| {
            y[1] = f64::NAN;
            Ok(1.0)
        });
        let status = attempt(&mut case, 0.0, &[1.0, 0.0], 2.0, &options(method)).status;
        assert_eq!(status, Status::Stopped { t: 0.0, cause: StopCause::NotFinite { component: 1 } }, "{method:?}");
    }
    for method in [BDF, TR_BDF2, ESDIRK34, Method::Radau5] {
        let broken = |y: &Jet| Jet(y.0.iter().enumerate().map(|(k, y)| if k == 0 { *y } else { f64::NAN }).collect());
        let mut case = Case::new(2, move |_, y| vec![broken(&y[1]), broken(&y[0])]);
        let status = attempt(&mut case, 0.0, &[1.0, 0.0], 2.0, &options(method)).status;
        assert!(
            matches!(&status, Status::Stopped { t: 0.0, cause: StopCause::Evaluation { reason } } if reason.contains("Jacobian")),
            "{method:?} {status:?}"
        );
    }
}

#[test]
fn a_run_that_creeps_up_to_a_singularity_says_so() {
    // turned by the angle 1e-3/(1 - t): ever faster up to t = 1
    let mut case = Case::new(2, |t, y| {
        let rate = &(&t.number(1.0) - t).powf(-2.0) * 1e-3;
        vec![-&(&rate * &y[1]), &rate * &y[0]]
    });
    let solution = attempt(&mut case, 0.0, &[1.0, 0.0], 2.0, &options(Method::Dop853));
    let Status::Stopped { t, cause: StopCause::Creeping { steps, moved } } = solution.status else {
        panic!("{:?}", solution.status)
    };
    assert!(steps >= 2_000 && moved < 1e-6 && (t - 1.0).abs() < 1e-6, "{t} {steps} {moved}");
}

#[test]
fn steps_are_limited() {
    for method in EVERY {
        let options = Options { max_steps: 10, ..options(method) };
        let solution = attempt(&mut oscillator(), 0.0, &[1.0, 0.0], 100.0, &options);
        let cause = StopCause::TooManySteps { limit: 10 };
        assert_eq!(solution.status, Status::Stopped { t: solution.dense.end(), cause }, "{method:?}");
        assert!(solution.work.steps > 0 && solution.work.steps + solution.work.rejected >= 10);
        assert!(solution.dense.end() > 0.0 && solution.dense.end() < 100.0);
        // those before count
        let first = attempt(&mut oscillator(), 0.0, &[1.0, 0.0], 0.1, &Options { max_steps: 1000, ..options.clone() });
        let limit = first.work.steps + first.work.rejected + 10;
        let rest = Options { before: Some(first.done()), max_steps: limit, ..options };
        let solution = attempt(&mut oscillator(), 0.1, first.dense.end_state(), 100.0, &rest);
        assert!(solution.work.steps > first.work.steps && solution.work.steps <= limit, "{method:?}");
        let cause = StopCause::TooManySteps { limit };
        assert_eq!(solution.status, Status::Stopped { t: solution.dense.end(), cause }, "{method:?}");
    }
}

#[test]
fn work_is_counted_to_the_evaluation() {
    for method in EVERY {
        for mut case in [oscillator(), oscillator().with_projection(onto_circle)] {
            let solution = run(&mut case, 0.0, &[1.0, 0.0], 10.0, &options(method));
            assert_eq!(solution.work.evaluations, case.evaluations, "{method:?}");
            assert_eq!(solution.work.jacobians, case.jacobians, "{method:?}");
            assert_eq!(solution.work.jacobians > 0, method.is_implicit(), "{method:?}");
        }
        // On the way to a wall, too.
        let mut case = blow_up();
        let solution = attempt(&mut case, 0.0, &[1.0], 2.0, &options(method));
        assert_eq!(solution.work.evaluations, case.evaluations, "{method:?}");
    }
}

#[test]
fn the_end_is_hit_exactly() {
    for method in EVERY {
        for (t, end) in [(0.0, 1.0), (0.1, 0.7), (1e6, 1e6 + 1.0), (0.0, 1e-9), (-3.0, -0.3), (2.0, 1.9), (0.0, -1e3)] {
            let solution = run(&mut nonautonomous(), t, &[1.0], end, &options(method));
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
    let mut empty = Case::new(0, |_, _| Vec::new());
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
    let mut without = Case { taylor: false, ..oscillator() };
    assert_eq!(integrate(&mut without, &start, 1.0, &taylor).err(), Some(CallError::NoTaylor));
    let longest = |max_step: f64| call(&start, 1.0, &Options { max_step, ..good.clone() });
    assert_eq!(longest(0.0), Some(CallError::MaxStep { found: 0.0, limit: 0.0 }));
    assert!(matches!(longest(f64::NAN), Some(CallError::MaxStep { .. })));
    let breakpoints = vec![0.5, f64::INFINITY];
    let found = call(&start, 1.0, &Options { breakpoints, ..good.clone() });
    assert_eq!(found, Some(CallError::Breakpoint { number: 2, found: f64::INFINITY }));
    let options = Options { max_steps: 0, ..good };
    assert_eq!(call(&start, 1.0, &options), Some(CallError::MaxSteps { found: 0, limit: 1 }));
}

#[test]
fn steps_are_no_longer_than_allowed_and_end_where_they_are_to() {
    for method in EVERY {
        for direction in [1.0, -1.0] {
            let breakpoints = [0.7, 5.0, 0.3, 0.3, -1.0].map(|t| direction * t).to_vec();
            let options = Options { max_step: 0.01, breakpoints, ..options(method) };
            let solution = attempt(&mut oscillator(), 0.0, &[1.0, 0.0], direction * 2.0, &options);
            assert_eq!(solution.status, Status::Completed, "{method:?}");
            let times = solution.dense.step_times();
            assert_eq!(solution.work.steps + 1, times.len(), "{method:?}");
            assert!([0.3, 0.7, 2.0].iter().all(|t| times.contains(&(direction * t))), "{method:?}: {times:?}");
            let longest = times.windows(2).map(|t| (t[1] - t[0]) * direction).fold(0.0, f64::max);
            assert!(longest < 0.01 + 1e-12, "{method:?}: {longest}");
            assert!(method.is_implicit() || longest > 0.0099, "{method:?}: {longest}");
            for t in [0.2, 0.3, 0.5, 0.9, 2.0] {
                let mut y = [0.0; 2];
                solution.dense.evaluate(direction * t, &mut y);
                assert!((y[0] - t.cos()).abs() < 1e-4, "{method:?} at {t}: {y:?}");
            }
            let few = Options { max_steps: 7, ..options };
            let solution = attempt(&mut oscillator(), 0.0, &[1.0, 0.0], direction * 2.0, &few);
            let cause = StopCause::TooManySteps { limit: 7 };
            assert_eq!(solution.status, Status::Stopped { t: solution.dense.end(), cause }, "{method:?}");
        }
    }
}

#[test]
fn an_interrupt_ends_the_run_at_the_end_of_a_step() {
    for method in EVERY {
        let interrupt = Interrupt::default();
        let options = Options { interrupt: Some(interrupt.clone()), ..options(method) };
        // the oscillator, which raises the flag once it is past t = 1
        let mut raising = Case::new(2, move |t, y| {
            if t.0[0] > 1.0 {
                interrupt.raise();
            }
            vec![y[1].clone(), -&y[0]]
        });
        let solution = attempt(&mut raising, 0.0, &[1.0, 0.0], 100.0, &options);
        let end = solution.dense.end();
        assert_eq!(solution.status, Status::Stopped { t: end, cause: StopCause::Interrupted }, "{method:?}");
        assert!(end > 0.0 && end < 10.0, "{method:?}: {end}");
        assert!((solution.dense.end_state()[0] - end.cos()).abs() < 1e-4, "{method:?}");
        // the flag stays up: what starts after it makes no step
        let solution = attempt(&mut oscillator(), 0.0, &[1.0, 0.0], 100.0, &options);
        assert_eq!(solution.status, Status::Stopped { t: 0.0, cause: StopCause::Interrupted }, "{method:?}");
        assert_eq!(solution.work.steps, 0);
    }
}

#[test]
fn who_watches_sees_how_far_a_run_is_and_a_time_limit_ends_it() {
    for method in EVERY {
        let interrupt = Interrupt::default();
        let watched = interrupt.clone();
        let options = Options { interrupt: Some(interrupt.within(3600.0)), ..options(method) };
        let last = std::cell::Cell::new((0.0, 0));
        let mut watching = Case::new(2, move |_, y| {
            let (t, steps) = watched.reached();
            assert!((steps == 0) == (t == 0.0) && (t, steps) >= last.get(), "{method:?}: {steps} steps to {t}");
            last.set((t, steps));
            vec![y[1].clone(), -&y[0]]
        });
        let solution = attempt(&mut watching, 0.0, &[1.0, 0.0], 10.0, &options);
        assert_eq!(solution.status, Status::Completed, "{method:?}");
        assert!(interrupt.reached().0 > 5.0 && !interrupt.is_raised(), "{method:?}: {:?}", interrupt.reached());
        // a limit that is over leaves what was reached, here nothing
        let options = Options { interrupt: Some(interrupt.within(0.0)), ..options };
        let solution = attempt(&mut oscillator(), 0.0, &[1.0, 0.0], 10.0, &options);
        let cause = StopCause::TimeLimit { seconds: 0.0 };
        assert_eq!(solution.status, Status::Stopped { t: 0.0, cause }, "{method:?}");
    }
}

#[test]
fn a_problem_is_told_of_every_accepted_state_and_may_refuse_one() {
    for method in EVERY {
        for refuse in [0, 3] {
            let mut diary = Case { refuse, ..Case::new(1, |t, _| vec![t.cos()]) };
            let options = Options { method, ..Options::with_tolerance(1e-8) };
            let solution = run(&mut diary, 0.0, &[0.0], 2.0, &options);
            let times: Vec<f64> = diary.accepted.iter().map(|a| a.0).collect();
            let steps = solution.dense.step_times();
            assert_eq!(times, steps[steps.len() - times.len()..], "{method:?}");
            assert_eq!(diary.accepted.last().map(|a| &a.1[..]), Some(solution.dense.end_state()));
            assert!(refuse == 0 || solution.work.rejected >= refuse, "{method:?}: {:?}", solution.work);
        }
    }
}
