//! Words and estimates of motions that are known in closed form, on either side of every limit.

use std::f64::consts::PI;

use comparison::{Gap, Sampling, Verdict, compare_motions, compare_motions_by};
use diffsol_methods::TSIT45;
use integrate::Method;
use motion::{
    CHETAEV, Doubt, Ending, ErrorEstimate, Metric, Motion, Settings, choices, error_estimates, setting, solve_choice,
};
use scene::Scene;

/// `x = cos t + d p(t)` with `p` of [`apart_at`], beside `c`, and the same of `z` with `e`, which has hardly
/// any inertia.
const PUSHED: &str = r#"
title = "Two oscillators, pushed"
[parameters]
d = 0
e = 0
c = 0
[coordinates]
x = { start = "1 + c" }
z = { start = "1 + c" }
[system]
lagrangian = "4*(x'^2/2 - (x - c)^2/2 + d*(t/pi)^20*x) + 1e-28*(z'^2/2 - (z - c)^2/2 + e*(t/pi)^20*z)"
[start.velocities]
"x'" = 0
"z'" = 0
[run]
duration = 3.141592653589793
"#;

fn by(tolerance: f64) -> Settings {
    Settings { tolerance, method: Some(Method::Dop853), ..Settings::default() }
}

/// `p(t) = ∫₀ᵗ sin(t − s) (s/π)²⁰ ds`, which has hardly begun before errors are as large as they become.
fn apart_at(t: f64) -> f64 {
    const PARTS: i32 = 400;
    let h = t / f64::from(PARTS);
    let at = |i: i32| (t - h * f64::from(i)).sin() * (h * f64::from(i) / PI).powi(20);
    // Simpson
    let weight = |i: i32| if i == 0 || i == PARTS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=PARTS).map(|i| weight(i) * at(i)).sum::<f64>() * h / 3.0
}

fn pushed(c: f64, [d, e]: [f64; 2]) -> Scene {
    let with = [("c".to_string(), c), ("d".to_string(), d), ("e".to_string(), e)];
    Scene::parse_with("pushed", PUSHED, &with).unwrap_or_else(|e| panic!("{e}"))
}

fn motion(c: f64, push: [f64; 2], settings: &Settings) -> Motion {
    let scene = pushed(c, push);
    solve_choice(&scene, &choices(&scene)[0], settings).expect("a motion")
}

/// The motion without a push, and one that is this much apart from it at the end in `x` and in `z`.
fn gap_of(c: f64, apart: [f64; 2], settings: &Settings) -> Gap {
    let mut metric = Metric::new(&pushed(c, [0.0; 2]).system).expect("a metric");
    let [mut still, mut moved] = [[0.0; 2], apart.map(|x| x / apart_at(PI))].map(|push| motion(c, push, settings));
    compare_motions(&mut still, &mut moved, &mut metric).expect("a gap")
}

/// The largest error of `x` of a run at this tolerance, from the closed form; that of `z` is the same.
fn known_error(c: f64, tolerance: f64) -> f64 {
    // the run that a motion keeps is made at a hundredth of its tolerance
    let mut motion = motion(c, [0.0; 2], &by(100.0 * tolerance));
    let error = |t: f64, motion: &mut Motion| (motion.at(t).expect("in range").coordinates[0] - c - t.cos()).abs();
    motion.grid(200).into_iter().map(|t| error(t, &mut motion)).fold(0.0, f64::max)
}

/// A tolerance at which the two runs of a motion differ by parts of 10⁻⁹ of its way, and one by 10⁻⁷.
const FINE: f64 = 1e-10;
const COARSE: f64 = 1e-6;

#[test]
fn a_gap_counts_from_ten_times_the_errors_of_both() {
    for (tolerance, under) in [(FINE, "same"), (COARSE, "undecided")] {
        let error = known_error(0.0, tolerance);
        for (part, word) in [(0.0, under), (3.0, under), (30.0, "different")] {
            let gap = gap_of(0.0, [part * 2.0 * error, 0.0], &by(tolerance));
            let word_said = gap.verdict.word();
            assert_eq!(word_said, word, "{part} times the errors {error:.1e}: {:?}", gap.verdict);
            assert_eq!(gap.certain_from.is_some(), word == "different", "{part}");
            // M = 4: twice as long as x
            assert!(gap.estimates.iter().all(|e| (0.5..2.0).contains(&(e / (2.0 * error)))), "{gap:?}");
            let apart = 2.0 * part * 2.0 * error;
            assert!((gap.largest - apart).abs() < 5.0 * error, "{:.3e} is known, found {:.3e}", apart, gap.largest);
        }
    }
}

#[test]
fn a_coordinate_counts_alone_from_a_hundred_times_its_own_errors() {
    let error = known_error(0.0, FINE);
    for (part, word) in [(3.0, "same"), (30.0, "undecided"), (300.0, "different")] {
        let gap = gap_of(0.0, [0.0, part * 2.0 * error], &by(FINE));
        assert_eq!(gap.verdict.word(), word, "{part} times {error:.1e}: {:?}", gap.verdict);
        let seen = gap.certain_by_coordinate.iter().map(Option::is_some).collect::<Vec<_>>();
        assert_eq!((seen, gap.shows()), (vec![false, word == "different"], false), "{part}");
        if let Verdict::Undecided { because } = gap.verdict {
            assert!(because.starts_with("z differs by ") && because.ends_with("which is 10 times its own estimates"));
        }
    }
}

#[test]
fn motions_are_the_same_only_where_both_are_known_to_a_part_of_1e_8() {
    // errors of both over what x may have moved by, t sin t at most; or of one over the way, from 1 to −1
    for (c, part, words) in [(0.0, 2.0 / 1.82, "estimate of "), (1e3, 0.5, "estimate ")] {
        let (mut same, mut undecided, mut nearest) = (0.0_f64, f64::INFINITY, String::new());
        for k in 0..32 {
            let tolerance = 1e-6 * 0.7_f64.powi(k);
            let part = part * known_error(c, tolerance);
            match gap_of(c, [0.0; 2], &by(tolerance)).verdict {
                Verdict::Same => same = same.max(part),
                Verdict::Undecided { because } if part < undecided => (undecided, nearest) = (part, because),
                Verdict::Undecided { .. } => {}
                Verdict::Different => panic!("{part:.1e}"),
            }
        }
        assert!(nearest.contains(words) && nearest.ends_with("is over 1e-8, and no gap is certain"), "{nearest}");
        println!("beside {c}: same up to {same:.1e}, undecided from {undecided:.1e}");
        assert!((3e-9..1.2e-8).contains(&same) && (0.8e-8..4e-8).contains(&undecided), "{c}: {same:e}, {undecided:e}");
    }
}

#[test]
fn a_gap_passes_a_threshold_where_it_is_known_to_and_only_if_it_is_certain() {
    // M = 4
    let passes = |apart: f64, threshold: f64| {
        let (mut before, mut after) = (0.0, PI);
        for _ in 0..60 {
            let t = 0.5 * (before + after);
            let is_before = 2.0 * apart * apart_at(t) / apart_at(PI) < threshold;
            (before, after) = if is_before { (t, after) } else { (before, t) };
        }
        after
    };
    for apart in [1e-5, 1e-2, 0.5] {
        let gap = gap_of(0.0, [apart, 0.0], &by(1e-10));
        for (found, threshold) in gap.passes.iter().zip([1e-6, 1e-3, 1e-1]) {
            if threshold > 2.0 * apart {
                assert_eq!(*found, None, "{apart} never passes {threshold}");
                continue;
            }
            let (found, known) = (found.expect("passed"), passes(apart, threshold));
            assert!((found - known).abs() < 1e-3 * known, "{apart}, {threshold}: {found}, known {known}");
        }
    }
    // larger than 10⁻⁶ from early on, and no more than three times the errors
    let error = known_error(0.0, 1e-3);
    let gap = gap_of(0.0, [6.0 * error, 0.0], &by(1e-3));
    assert!(gap.largest > 1e-5 && gap.certain_from.is_none(), "{:?}", gap.verdict);
    assert_eq!(gap.passes, [None; 3]);
    // and thirty times: from when on it is certain, and not from when on it is as large
    let gap = gap_of(0.0, [60.0 * error, 0.0], &by(1e-3));
    let certain = gap.points.iter().find(|p| p.gap > p.limit).expect("certain").t;
    let found = gap.passes[0].expect("passed");
    assert!(found >= certain && found > 1.1 * passes(60.0 * error, 1e-6), "{found}, certain from {certain}");
    assert_eq!(gap.certain_from, Some(certain));
}

#[test]
fn where_a_motion_is_doubted_nothing_is_certain_any_more() {
    let error = known_error(0.0, FINE);
    let apart = 2e4 * error;
    let mut metric = Metric::new(&pushed(0.0, [0.0; 2]).system).expect("a metric");
    let mut doubted_from = |from: f64, one: usize| {
        let push = [[0.0; 2], [apart / apart_at(PI), 0.0]];
        let mut motions = push.map(|push| motion(0.0, push, &by(FINE)));
        motions[one].doubt = Some(Doubt { from, because: "doubted".into() });
        let [still, moved] = &mut motions;
        compare_motions(still, moved, &mut metric).expect("a gap")
    };
    let at = |t: f64| 2.0 * apart * apart_at(t) / apart_at(PI);
    for one in [0, 1] {
        // the gap is certain before the doubt begins, and only what is certain counts
        let gap = doubted_from(2.8, one);
        assert_eq!(gap.verdict, Verdict::Different);
        assert!(gap.points.iter().all(|p| (p.t < 2.8) == p.limit.is_finite() && (!p.certain || p.t < 2.8)), "{gap:?}");
        assert!(gap.largest > at(2.78) - 3.0 * error && gap.largest < at(2.8) + 3.0 * error, "{:e}", gap.largest);
        assert!(gap.bound().is_infinite() && gap.limit_at(2.9).is_infinite() && gap.limit_at(2.7).is_finite());
        // it has not begun
        let gap = doubted_from(0.5, one);
        assert_eq!(gap.verdict, Verdict::Undecided { because: "doubted".into() });
        assert_eq!((gap.certain_from, gap.passes), (None, [None; 3]));
    }
}

#[test]
fn of_two_doubts_that_of_the_first_motion_is_told() {
    let mut motions = ["one", "other"].map(|because| {
        let mut motion = motion(0.0, [0.0; 2], &by(FINE));
        motion.doubt = Some(Doubt { from: 0.5, because: because.into() });
        motion
    });
    let mut metric = Metric::new(&pushed(0.0, [0.0; 2]).system).expect("a metric");
    let [one, other] = &mut motions;
    let mut word =
        |first: &mut Motion, second: &mut Motion| compare_motions(first, second, &mut metric).expect("a gap").verdict;
    assert_eq!((word(one, other), word(other, one)), (undecided("one"), undecided("other")));
    // and one that there is, whichever it is of
    one.doubt = None;
    assert_eq!((word(one, other), word(other, one)), (undecided("other"), undecided("other")));
}

fn undecided(because: &str) -> Verdict {
    Verdict::Undecided { because: because.into() }
}

/// A limit is never under ten times round-off of the way: the estimate of a motion on a straight line is 0.
#[test]
fn a_limit_has_a_floor_where_the_runs_agree_to_the_last_digit() {
    let text = "title = \"free\"\n[coordinates]\nx = { start = 4 }\n[system]\nlagrangian = \"x'^2/2\"\n\
                [start.velocities]\n\"x'\" = 2\n[run]\nduration = 8\n";
    let scene = Scene::parse("free", text).unwrap_or_else(|e| panic!("{e}"));
    let [mut one, mut other] =
        [(); 2].map(|()| solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion"));
    let mut metric = Metric::new(&scene.system).expect("a metric");
    let gap = compare_motions(&mut one, &mut other, &mut metric).expect("a gap");
    assert_eq!(gap.verdict, Verdict::Same);
    assert!(gap.estimates.iter().all(|estimate| *estimate < 2e-14), "{:?}", gap.estimates);
    for point in &gap.points {
        let size = 4.0 + 2.0 * point.t;
        assert!(point.limit >= 1e-13 * size && point.limit < 2e-13 * size, "{}: {:e}", point.t, point.limit);
    }
}

/// Two oscillators of hardly any inertia beside a particle: the one that is known least is named.
#[test]
fn of_what_is_not_known_well_enough_the_worst_is_named() {
    for (y, z, worst) in [(5, 3, "y"), (3, 5, "z")] {
        let text = format!(
            "title = \"beside\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 1 }}\nz = {{ start = 1 }}\n[system]\n\
             lagrangian = \"x'^2/2 + 1e-20*(y'^2 - {y}^2*y^2 + z'^2 - {z}^2*z^2)/2\"\n[start.velocities]\n\
             \"x'\" = 1\n\"y'\" = 0\n\"z'\" = 0\n[run]\nduration = 3\n"
        );
        let scene = Scene::parse("beside", &text).unwrap_or_else(|e| panic!("{e}"));
        let run = || solve_choice(&scene, &choices(&scene)[0], &by(1e-4)).expect("a motion");
        let (mut one, mut other) = (run(), run());
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let gap = compare_motions(&mut one, &mut other, &mut metric).expect("a gap");
        let Verdict::Undecided { because } = gap.verdict else { panic!("{:?}", gap.verdict) };
        assert!(because.starts_with(&format!("relative error estimate of {worst} ")), "{because}");
    }
}

#[test]
fn of_a_motion_back_every_limit_is_that_of_the_end() {
    let from_there = [("x".to_string(), -1.0), ("z".to_string(), -1.0)];
    let there = Scene::parse_with("pushed", PUSHED, &from_there).unwrap_or_else(|e| panic!("{e}"));
    let [mut on, mut back] = [&pushed(0.0, [0.0; 2]), &there]
        .map(|scene| solve_choice(scene, &choices(scene)[0], &by(FINE)).expect("a motion"));
    let mut metric = Metric::new(&there.system).expect("a metric");
    let sampling = Sampling { rate: -1.0, offset: PI, ..Sampling::default() };
    let gap = compare_motions_by(&mut on, &mut back, &mut metric, &sampling).expect("a gap");
    assert_eq!((gap.verdict.word(), gap.end), ("same", PI));
    let limit = gap.limit_at(PI);
    is_about("limit", limit, 10.0 * 2.0 * 2.0 * known_error(0.0, FINE));
    assert!(gap.points.iter().all(|p| p.limit == limit), "{:?}", gap.points);
}

#[test]
fn estimates_and_limits_are_those_of_their_motion_and_their_time() {
    let mut metric = Metric::new(&pushed(0.0, [0.0; 2]).system).expect("a metric");
    let [mut coarse, mut fine] = [COARSE, FINE].map(|tolerance| motion(0.0, [0.0; 2], &by(tolerance)));
    let gap = compare_motions(&mut coarse, &mut fine, &mut metric).expect("a gap");
    for (estimate, error) in gap.estimates.iter().zip([COARSE, FINE].map(|tolerance| known_error(0.0, tolerance))) {
        is_about("kinetic", *estimate, 2.0 * error);
    }
    // nothing is seen of what is under ten times both, and no more is said
    let limit = 10.0 * (gap.estimates[0] + gap.estimates[1]);
    is_about("limit at the end", gap.limit_at(PI), limit);
    assert!(gap.bound() >= limit && gap.bound() < 1.2 * limit, "{:e}, {limit:e}", gap.bound());
    for pair in gap.points.windows(2) {
        assert!(pair[0].limit <= pair[1].limit && gap.limit_at(pair[1].t) == pair[1].limit);
        assert_eq!(gap.limit_at(0.5 * (pair[0].t + pair[1].t)), pair[1].limit);
    }
    assert!(gap.limit_at(0.01) < 1e-3 * limit && gap.limit_at(3.2).is_infinite());
    // one estimate that is too large is enough, of a coordinate or, beside 1000, of the way
    assert_eq!(gap.verdict.word(), "undecided", "{:?}", gap.verdict);
    for tolerances in [[1e-8, 1e-11], [1e-11, 1e-8]] {
        let [mut one, mut two] = tolerances.map(|tolerance| motion(1e3, [0.0; 2], &by(tolerance)));
        let gap = compare_motions(&mut one, &mut two, &mut metric).expect("a gap");
        assert_eq!(gap.verdict.word(), "undecided", "{:?}", gap.verdict);
    }
}

#[test]
fn what_rests_as_far_as_can_be_told_is_undecided() {
    // on its top, where it moves by what last digits of its start are
    let text = "title = \"top\"\n[coordinates]\nphi = { start = 3.141592653589793 }\n[system]\n\
                lagrangian = \"phi'^2/2 + cos(phi)\"\n[start.velocities]\n\"phi'\" = 0\n[run]\nduration = 8\n";
    let scene = Scene::parse("top", text).unwrap_or_else(|e| panic!("{e}"));
    let solve = || solve_choice(&scene, &choices(&scene)[0], &Settings { plain: true, ..Settings::default() });
    let (mut one, mut two) = (solve().expect("a motion"), solve().expect("a motion"));
    let mut metric = Metric::new(&scene.system).expect("a metric");
    let gap = compare_motions(&mut one, &mut two, &mut metric).expect("a gap");
    let Verdict::Undecided { because } = gap.verdict else { panic!("{gap:?}") };
    assert!(because.starts_with("at rest, as far as can be told: no way is over 10 times the error"), "{because}");
}

/// `x = sin t`, `y` is held by a constraint against the force `x²`, and so `λ = −x²`; `M = diag(4, 1)`.
pub(crate) const HELD: &str = r#"
title = "Held"
[parameters]
b = 1
[coordinates]
x = { start = 0 }
y = { start = 0 }
[system]
lagrangian = "4*(x'^2/2 - x^2/2) + b*y'^2/2"
constraints = ["y'"]
forces = { y = "x^2" }
[start]
velocities = { "x'" = 1 }
[run]
duration = 3
"#;

/// What the looser run is wrong by at its worst: kinetic, of x, of x', of λ. The same of the run that has the
/// hundredfold tolerance; this is the kept run.
fn known(motion: &mut Motion, times: &[f64]) -> [f64; 4] {
    let mut worst = [0.0_f64; 4];
    for &t in times {
        let now = motion.at(t).expect("in range");
        let (x, v, m) = (now.coordinates[0], now.velocities[0], now.multipliers[0]);
        let errors = [2.0 * (x - t.sin()), x - t.sin(), v - t.cos(), m + t.sin().powi(2)];
        worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error.abs()));
    }
    worst
}

/// Whether an estimate is what it is known to be: the error of the looser run, up to a factor.
#[track_caller]
pub(crate) fn is_about(what: &str, estimate: f64, known: f64) {
    println!("{what}: estimate {estimate:.2e}, known {known:.2e}");
    assert!(known > 1e-13 && (0.3..3.0).contains(&(estimate / known)), "{what}: {estimate:e}, known {known:e}");
}

#[test]
fn estimates_are_what_the_looser_run_is_wrong_by() {
    let scene = Scene::parse("held", HELD).unwrap_or_else(|e| panic!("{e}"));
    let chetaev = choices(&scene).into_iter().find(|c| c.formulation == CHETAEV).expect("linear constraints");
    for method in [Method::Dop853, TSIT45, Method::Radau5, Method::Taylor] {
        for tolerance in [1e-5, 1e-7] {
            let settings = |tolerance| Settings { tolerance, method: Some(method), ..Settings::default() };
            let solve = |tolerance| solve_choice(&scene, &chetaev, &settings(tolerance)).expect("a motion");
            let (mut motion, mut looser) = (solve(tolerance), solve(100.0 * tolerance));
            let (_, ErrorEstimate { absolute, coordinates, multipliers, relative, .. }) =
                error_estimates(&mut motion, setting(&scene), &[]).expect("in range");
            let times = motion.grid(200);
            let [kinetic, x, v, multiplier] = known(&mut looser, &times);
            let of = format!("{} at {tolerance:e}", method.name());
            is_about(&format!("{of}, kinetic"), absolute, kinetic);
            // the way is 2, from 0 to 1, in the kinetic metric
            is_about(&format!("{of}, relative"), relative, kinetic / 2.0);
            is_about(&format!("{of}, x"), coordinates[0], x);
            is_about(&format!("{of}, multiplier"), multipliers[0], multiplier);
            let apart = |t: &f64| {
                let (kept, looser) = motion.at_in_both_runs(*t).expect("in range");
                (kept.velocities[0] - looser.velocities[0]).abs()
            };
            is_about(&format!("{of}, x'"), times.iter().map(apart).fold(0.0, f64::max), v);
        }
    }
}

#[test]
fn a_motion_with_a_large_estimate_is_untrusted_and_one_with_a_small_one_is_not() {
    let mut words = Vec::new();
    for k in 0..40 {
        let tolerance = 0.5 * 0.8_f64.powi(k);
        let mut motion = motion(0.0, [0.0; 2], &by(tolerance));
        let estimate = error_estimates(&mut motion, setting(&pushed(0.0, [0.0; 2])), &[]).expect("in range").1;
        let (word, cause) = estimate.status(&motion);
        // of x, which moves by 2, and over that way
        let part = (estimate.coordinates[0] / 2.0).max(estimate.relative);
        assert_eq!(word == "untrusted", part > 1e-3, "{tolerance:e}: {estimate:?}");
        assert_eq!(word == "completed", cause.is_none(), "{cause:?}");
        words.push((part, word));
        motion.doubt = Some(Doubt { from: 1.0, because: "doubted".into() });
        assert_eq!(estimate.status(&motion), ("untrusted", Some("doubted".into())));
        // a motion that stops is "stopped", and its doubt is in the message as well
        motion.ending = Ending::Stopped { t: 2.5, cause: "a wall".into() };
        assert_eq!(estimate.status(&motion), ("stopped", Some("stopped at t = 2.5: a wall; doubted".into())));
        motion.doubt = None;
        assert_eq!(estimate.status(&motion), ("stopped", Some("stopped at t = 2.5: a wall".into())));
    }
    let near = |word: &str| words.iter().any(|(part, said)| *said == word && (3e-4..3e-3).contains(part));
    assert!(near("untrusted") && near("completed"), "{words:?}");
}
