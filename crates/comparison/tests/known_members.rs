//! Members of ensembles against motions known in closed form: their estimates, and their constraints.

use integrate::Projection;
use motion::{
    CHETAEV, Ending, Ensemble, EnsembleOptions, ErrorEstimate, Form, MemberMotion, Settings, VAKONOMIC, choices,
    solve_choice,
};
use scene::Scene;

use crate::known_values::{HELD, is_about};

/// Members of an ensemble in lanes that start with `x' = a`, at these times: `x = a sin t`, `λ = −x²`.
fn members(speeds: &[f64], times: &[f64], tolerance: f64, projection: Projection) -> Vec<MemberMotion> {
    let scene = Scene::parse("held", HELD).unwrap_or_else(|e| panic!("{e}"));
    let chetaev = choices(&scene).into_iter().find(|c| c.formulation == CHETAEV).expect("linear constraints");
    let settings = Settings { tolerance, projection, form: Form::Named, ..Settings::default() };
    let ensemble = Ensemble::new(&scene, &chetaev, &["x'"], &settings).expect("an ensemble");
    let rows: Vec<[f64; 1]> = speeds.iter().map(|a| [*a]).collect();
    let options = EnsembleOptions { threads: 1, estimate: true };
    let motions = ensemble.answers(ensemble.members(&rows, 1), times, &options);
    let motions: Vec<MemberMotion> = motions.into_iter().map(|motion| motion.expect("a member")).collect();
    assert!(motions.iter().all(|motion| motion.run.alone.is_none() && motion.outputs.len() == times.len()));
    motions
}

#[test]
fn estimates_of_members_are_what_their_looser_runs_are_wrong_by() {
    let times: Vec<f64> = (1..=60).map(|i| 0.05 * f64::from(i)).collect();
    let speeds: Vec<f64> = (0..11).map(|i| 0.5 + 0.1 * f64::from(i)).collect();
    for tolerance in [1e-4, 1e-6] {
        let [found, looser] =
            [1.0, 100.0].map(|part| members(&speeds, &times, part * tolerance, Projection::EveryStep));
        for ((a, found), looser) in speeds.iter().zip(found).zip(looser) {
            let ErrorEstimate { absolute, relative, coordinates, multipliers, .. } = found.estimate.expect("asked for");
            let mut worst = [0.0_f64; 3];
            for (t, now) in times.iter().zip(&looser.outputs) {
                let x = a * t.sin();
                let errors = [x - now.coordinates[0], x * x + now.multipliers[0], a * t.cos() - now.velocities[0]];
                worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error.abs()));
            }
            let of = format!("x' = {a} at {tolerance:e}");
            is_about(&format!("{of}, x"), coordinates[0], worst[0]);
            is_about(&format!("{of}, kinetic"), absolute, 2.0 * worst[0]);
            is_about(&format!("{of}, relative"), relative, worst[0] / a);
            is_about(&format!("{of}, multiplier"), multipliers[0], worst[1]);
            let differences = found.run.differences.iter().map(|d| d.iter().fold(0.0_f64, |a, d| a.max(d.abs())));
            is_about(&format!("{of}, states"), differences.fold(0.0, f64::max), worst[0].max(worst[2]));
        }
    }
}

/// A pendulum in its plane, with `x² + y² = 1` said by velocities.
const ROUND: &str = r#"
title = "Round"
[coordinates]
x = { start = 1 }
y = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2)/2 - y"
constraints = ["x*x' + y*y'"]
[start.velocities]
"x'" = 0
"y'" = 0.5
[run]
duration = 3
"#;

#[test]
fn members_in_lanes_stay_on_their_constraint_by_projection_alone() {
    let scene = Scene::parse("round", ROUND).unwrap_or_else(|e| panic!("{e}"));
    for formulation in [CHETAEV, VAKONOMIC] {
        let choice = choices(&scene).into_iter().find(|c| c.formulation == formulation).expect("a choice");
        let off = |projection: Projection| {
            let settings = Settings { tolerance: 1e-4, projection, form: Form::Named, ..Settings::default() };
            let ensemble = Ensemble::new(&scene, &choice, &["y'"], &settings).expect("an ensemble");
            let rows: Vec<[f64; 1]> = (0..9).map(|i| [0.3 + 0.05 * f64::from(i)]).collect();
            let options = EnsembleOptions { threads: 1, estimate: false };
            let motions = ensemble.answers(ensemble.members(&rows, 1), &[3.0], &options);
            let off = |motion: Result<MemberMotion, String>| {
                let MemberMotion { outputs, run, .. } = motion.expect("a member");
                assert!(run.alone.is_none(), "{formulation:?}: {:?}", run.alone);
                let (q, v) = (&outputs[0].coordinates, &outputs[0].velocities);
                ((q[0] * v[0] + q[1] * v[1]).abs(), run.projection)
            };
            motions.into_iter().map(off).collect::<Vec<_>>()
        };
        for ((without, none), (with, report)) in off(Projection::Off).into_iter().zip(off(Projection::EveryStep)) {
            println!("{formulation:?}: off by {without:.1e} without, by {with:.1e} with projection, {report:?}");
            assert!(without > 1e-8 && with < 1e-13, "{formulation:?}: {without:e}, {with:e}");
            // every projection is counted, and the largest is about what it prevented
            assert!(none.projections == 0 && report.projections > 5, "{report:?}");
            assert!(report.largest > 1e-3 * without && report.largest < 1e3 * without, "{without:e}, {report:?}");
        }
    }
}

/// The members of this text, with `x'` varied over these values.
fn started(text: &str, speeds: &[f64], settings: &Settings, estimate: bool) -> Vec<MemberMotion> {
    let scene = Scene::parse("members", text).unwrap_or_else(|e| panic!("{e}"));
    let ensemble = Ensemble::new(&scene, &choices(&scene)[0], &["x'"], settings).expect("an ensemble");
    let rows: Vec<[f64; 1]> = speeds.iter().map(|a| [*a]).collect();
    let end = scene.start.t + scene.duration;
    let options = EnsembleOptions { threads: 1, estimate };
    let motions = ensemble.answers(ensemble.members(&rows, 1), &[0.25 * end, 0.5 * end, end], &options);
    motions.into_iter().map(|motion| motion.expect("a member")).collect()
}

const FREE: &str = "title = \"free\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                    lagrangian = \"(x'^2 + y'^2)/2\"\nforces = { x = \"FORCE\" }\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 0\n\
                    [run]\nduration = 2\n";

#[test]
fn members_with_large_estimates_are_untrusted_and_those_with_small_ones_are_not() {
    let (text, mut words) = (FREE.replace("FORCE", "-(30*x)^3"), Vec::new());
    for k in 0..14 {
        let settings = Settings { tolerance: 0.3 * 0.25_f64.powi(k), ..Settings::default() };
        for member in started(&text, &[0.5, 1.0, 2.0], &settings, true) {
            let estimate = member.estimate.as_ref().expect("asked for");
            let part = estimate.worst.as_ref().map_or(0.0, |worst| worst.1).max(estimate.relative);
            let (word, cause) = member.status();
            assert_eq!((word, cause.is_some()), if part > 1e-3 { ("untrusted", true) } else { ("completed", false) });
            words.push(word);
        }
    }
    assert!(words.contains(&"untrusted") && words.contains(&"completed"), "{words:?}");
}

#[test]
fn a_member_ends_where_the_run_for_its_estimate_ends() {
    // stiff: series of low order, those of the looser run, are stable for short steps only
    let text = FREE.replace("FORCE", "-1e4*(x' - cos(t))");
    let settings = |tolerance, max_steps| Settings { tolerance, max_steps, ..Settings::default() };
    let [loose, tight] = [1e-6, 1e-8]
        .map(|tolerance| started(&text, &[1.0], &settings(tolerance, 1_000_000), false).remove(0).run.work.steps);
    assert!(tight + 100 < loose, "{tight} steps, {loose} of the looser run");
    let between = settings(1e-6, (loose + tight) / 2);
    for member in started(&text, &[1.0; 9], &between, true) {
        let (word, cause) = member.status();
        let cause = cause.expect("a cause");
        assert!(word == "stopped" && cause.contains("the run that estimates the error stops here"), "{word}: {cause}");
        let Ending::Stopped { t, .. } = member.run.ending else { panic!("complete") };
        assert!((0.9..2.0).contains(&t) && member.outputs.len() == if t < 1.0 { 1 } else { 2 }, "{t}");
    }
}

#[test]
fn what_is_listed_as_constant_and_is_not_is_a_finding() {
    let listed = FREE.replace("[start.velocities]", "[invariants]\nspeed = \"x'\"\nother = \"y'\"\n[start.velocities]");
    // x' = a + 1e-3 (1 − cos t)
    let driven = listed.replace("FORCE", "1e-3*sin(t)");
    for (text, begins) in
        [(&listed.replace("FORCE", "0"), None), (&driven, Some("speed is not constant: it has changed by "))]
    {
        let scene = Scene::parse("listed", text).unwrap_or_else(|e| panic!("{e}"));
        let motion = solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion");
        let found = started(text, &[0.5, 1.0, 3.0], &Settings::default(), true).into_iter().map(|member| {
            let (word, cause) = member.status();
            assert_eq!((word, &member.doubt), ("completed", &None), "{cause:?}");
            member.breaches
        });
        for breaches in found.chain([motion.breaches]) {
            let said = breaches.first().map(|breach| breach.to_string());
            assert_eq!((breaches.len(), said.is_some()), (usize::from(begins.is_some()), begins.is_some()), "{said:?}");
            assert!(said.zip(begins).is_none_or(|(said, begins)| said.starts_with(begins)), "{breaches:?}");
            // 1e-3 (1 − cos t) by the end of 3 s
            assert!(breaches.iter().all(|breach| breach.largest > 1e-4 && breach.largest < 2.1e-3), "{breaches:?}");
        }
    }
}

/// x' = a + (t/2)^41/20.5, which is a before the middle of the run to the last digit.
#[test]
fn a_change_is_noted_when_it_is_certain() {
    let listed = FREE.replace("[start.velocities]", "[invariants]\nspeed = \"x'\"\n[start.velocities]");
    for member in started(&listed.replace("FORCE", "(t/2)^40"), &[0.5, 1.0, 3.0], &Settings::default(), true) {
        let [breach] = &member.breaches[..] else { panic!("x' is not constant") };
        assert_eq!(breach.name, "speed");
        assert!((1.0..=3.0).contains(&breach.t), "{}", breach.t);
    }
}
