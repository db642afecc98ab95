//! Round-off of known size: what of it is put into an estimate, in single motions and in members, alike.
//!
//! The force `A − A cos(10⁻¹⁴ x)` is zero to the last digit, and `2A` is added up to the rate of the
//! velocity. Within a time `T` that comes to `2A T ε`; where it counts, the looser run has half a last
//! digit of it in its rate, so that the runs are apart by `A T ε` in the velocity at the end.

use comparison::{Verdict, compare_motions};
use motion::{
    CHETAEV, Ensemble, EnsembleOptions, Form, MemberMotion, Metric, Motion, REMOVED_CONSTRAINT, Settings, VAKONOMIC,
    choices, solve_choice,
};
use scene::Scene;

use crate::support;

const EPS: f64 = f64::EPSILON;

/// A particle at this speed under this force, from x = 0 up to this time.
fn particle(force: &str, speed: f64, duration: f64) -> Scene {
    let text = format!(
        "title = \"free\"\n[coordinates]\nx = {{ start = 0 }}\n[system]\nlagrangian = \"x'^2/2\"\n\
         forces = {{ x = \"{force}\" }}\n[start.velocities]\n\"x'\" = {speed:?}\n[run]\nduration = {duration:?}\n"
    );
    support::read("free", &text)
}

fn motion(scene: &Scene) -> Motion {
    solve_choice(scene, &choices(scene)[0], &Settings::default()).expect("a motion")
}

/// The motion as a member of an ensemble, looked at at these parts of the run.
fn member(scene: &Scene, parts: &[f64]) -> MemberMotion {
    let times: Vec<f64> = parts.iter().map(|part| scene.start.t + part * scene.duration).collect();
    support::member(scene, &choices(scene)[0], &times)
}

/// What the runs are apart by in the velocity at the end, kept minus looser, single and as a member.
fn apart(scene: &Scene) -> [f64; 2] {
    let mut single = motion(scene);
    let (kept, looser) = single.at_in_both_runs(single.end()).expect("the end");
    let member = member(scene, &[0.5, 1.0]);
    let differences = member.run.differences.last().expect("the end");
    // the speed is the state that is no place
    let states = member.run.states.last().expect("the end");
    let speed = (0..2).min_by(|&i, &j| {
        let off = |i: usize| (states[i] - kept.velocities[0]).abs();
        off(i).total_cmp(&off(j))
    });
    [kept.velocities[0] - looser.velocities[0], differences[speed.expect("two states")]]
}

/// Half a last digit of `2A` is `A ε`, which the rate has as far as the sum in which it stands has digits.
#[test]
fn round_off_counts_from_256_last_digits_on_and_half_of_it_is_put_in() {
    for (a, counts) in [(50.0, false), (80.0, true), (750.0, true)] {
        // 4A is added up
        let scene = particle(&format!("{a:?} - {a:?}*cos(1e-14*x)"), 1.0, 2.0);
        let apart = apart(&scene);
        assert!(apart[0] * apart[1] > 0.0, "{a}: to either side, {apart:?}");
        for found in apart.map(|apart| apart.abs() / EPS) {
            let known = if counts { 2.0 * a } else { 0.0 };
            assert!((0.6 * known..known + 16.0).contains(&found), "{a}: {found:.0} last digits");
        }
    }
}

/// A pulse between the instants of the first look, which sees a sixth of it: `A exp(−50 (t − 3/4)²)`. The
/// error of the pulse itself is in both terms, and cancels.
#[test]
fn round_off_between_the_instants_of_a_first_look_counts() {
    let found = |height: f64| {
        let pulse = format!("{height:?}*exp(-50*(t - 0.75)^2)");
        let mut single = motion(&particle(&format!("{pulse} - {pulse}*cos(1e-14*x)"), 1.0, 2.0));
        let (kept, looser) = single.at_in_both_runs(2.0).expect("the end");
        (kept.velocities[0] - looser.velocities[0]).abs() / EPS
    };
    // sqrt(π/50) A is added up twice, and once more for the product
    let [little, much] = [60.0, 700.0].map(found);
    println!("{little} and {much} last digits");
    assert!(little < 16.0 && (150.0..800.0).contains(&much), "{little}, {much}");
}

#[test]
fn round_off_is_a_part_of_the_size_that_a_state_has_anywhere() {
    // 10⁻⁴ of a speed of 1000 is trusted, and of 10 not
    for (speed, trusted) in [(1000.0, true), (10.0, false)] {
        let scene = particle(&format!("{0:?} - {0:?}*cos(1e-18*x)", 0.5e-4 / EPS), speed, 1.0);
        let member = member(&scene, &[0.5, 1.0]);
        assert_eq!(member.status().0 == "completed", trusted, "{speed}: {:?}", member.status());
        assert_eq!(motion(&scene).doubt.is_none(), trusted, "{speed}");
    }
    // a speed that becomes 10⁻³ within the run is known to 10⁻⁹ of that
    let scene = particle("1e10 + 1 - 1e10*cos(1e-14*x)", 0.0, 1e-3);
    assert!(member(&scene, &[0.5, 1.0]).doubt.is_some() && motion(&scene).doubt.is_some());
    // what rests has the size of the scene, which is 1
    let scene = particle("500 - 500*cos(1e-14*x)", 0.0, 1.0);
    assert_eq!((member(&scene, &[0.5, 1.0]).doubt, motion(&scene).doubt), (None, None));
}

#[test]
fn round_off_late_in_a_run_is_seen() {
    // 2·10¹⁶ (t/2)²⁰⁰ is added up to a rate of −x² (t/2)²⁰⁰
    let scene = particle("(cos(1e-8*x) - 1)*2e16*(t/2)^200", 1.0, 2.0);
    let parts: Vec<f64> = (1..=20).map(|i| 0.05 * f64::from(i)).collect();
    assert!(motion(&scene).doubt.is_some_and(|doubt| doubt.from > 1.0));
    assert!(member(&scene, &parts).doubt.is_some_and(|doubt| doubt.from > 1.0));
    // and none where it is over
    let scene = particle("(cos(1e-8*x) - 1)*2e16*(t/2)^200", 1.0, 1.0);
    assert!(motion(&scene).doubt.is_none() && member(&scene, &parts).doubt.is_none());
}

/// `λ = 10⁸ cos(10⁻⁹ x) − 10⁸`, with half a last digit of `2·10⁸`: 2.2·10⁻⁸, beside 0.
#[test]
fn round_off_of_a_multiplier_is_in_its_estimate_and_makes_it_no_doubt() {
    let text = "title = \"held\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\n\
                forces = { y = \"1e8 - 1e8*cos(1e-9*x)\" }\n[start.velocities]\n\"x'\" = 1\n[run]\nduration = 2\n";
    let scene = Scene::parse("held", text).unwrap_or_else(|e| panic!("{e}"));
    let member = member(&scene, &[0.25, 0.5, 0.75, 1.0]);
    let estimate = member.estimate.as_ref().expect("asked for");
    let known = 0.5 * EPS * 2e8;
    let found = estimate.multipliers[0];
    assert!((0.5 * known..3.0 * known).contains(&found), "{found:e}, {known:e}");
    assert_eq!(member.status(), ("completed", None), "{estimate:?}");
}

/// `λ = 10⁸ (2 sin x cos x − sin 2x)` is round-off and differs from run to run by all that it is.
#[test]
fn a_multiplier_that_is_round_off_makes_no_member_untrusted() {
    let text = "title = \"held\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\n\
                forces = { y = \"1e8*(sin(2*x) - 2*sin(x)*cos(x))\" }\n[start.velocities]\n\"x'\" = 1\n[run]\n\
                duration = 2\n";
    let scene = Scene::parse("held", text).unwrap_or_else(|e| panic!("{e}"));
    let parts: Vec<f64> = (1..=40).map(|i| 0.025 * f64::from(i)).collect();
    let member = member(&scene, &parts);
    let estimate = member.estimate.as_ref().expect("asked for");
    let size = member.outputs.iter().fold(0.0_f64, |a, now| a.max(now.multipliers[0].abs()));
    let apart = estimate.multipliers[0];
    assert!(size < 1e-7 && apart > 1e-3 * size, "{size:e}, {apart:e}: nothing is tried");
    assert_eq!(member.status(), ("completed", None), "{estimate:?}");
}

/// `y' = k x'`, where `x' = 10⁻² + t`: without its `k` the constraint would be off by all of `y'`.
#[test]
fn constraints_of_members_are_watched_with_their_own_parameters() {
    let text = "title = \"led\"\n[parameters]\nk = 1\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2 + (1 + k^2)*x\"\nconstraints = [\"y' - k*x'\"]\n[start.velocities]\n\
                \"x'\" = 0.01\n[run]\nduration = 2\n";
    let scene = Scene::parse("led", text).unwrap_or_else(|e| panic!("{e}"));
    let ensemble = Ensemble::new(&scene, &choices(&scene)[0], &["k"], &Settings::default()).expect("an ensemble");
    let options = EnsembleOptions { threads: 1, estimate: true };
    let rows = [[0.5], [1.0], [3.0]];
    for ([k], motion) in rows.into_iter().zip(ensemble.answers(ensemble.members(&rows, 1), &[1.0, 2.0], &options)) {
        let motion = motion.expect("a member");
        assert_eq!(motion.status(), ("completed", None), "{k}");
        let off = motion.outputs[1].velocities[1] - k * 2.01;
        assert!(off.abs() < 1e-8, "{k}: {off:e}");
    }
}

/// Two constraints that are parallel but for `a/2`: velocities are known to that part, places to the last
/// digit.
#[test]
fn velocities_at_a_start_are_known_as_well_as_the_constraints_tell_them() {
    for a in [1e-4, 1e-6] {
        let text = format!(
            "title = \"near\"\n[coordinates]\nx = {{ start = 1 }}\ny = {{ start = 2 }}\nz = {{ start = 3 }}\n\
             w = {{ start = 4 }}\n[system]\nlagrangian = \"(x'^2 + 2*y'^2 + 3*z'^2 + 5*w'^2)/2\"\n\
             constraints = [\"x' + y'\", \"x' + y' + {a:?}*(z' - w')\"]\n[start.velocities]\n\"x'\" = 1\n\"z'\" = 1\n\
             [run]\nduration = 1\n"
        );
        let scene = Scene::parse("near", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
        let settings = Settings { form: Form::Named, ..Settings::default() };
        // singular values 2 and a of rows (1, 1, 0, 0) and (1, 1, a, −a)
        let lost = 2.0 / a;
        for choice in choices(&scene) {
            let mut motion = solve_choice(&scene, &choice, &settings).expect("a motion");
            let start = motion.start();
            let (kept, looser) = motion.at_in_both_runs(start).expect("the start");
            let part = |one: &[f64], other: &[f64]| -> f64 {
                let parts = one.iter().zip(other).map(|(a, b)| (a - b).abs() / a.abs());
                parts.fold(0.0, f64::max) / EPS
            };
            let (places, speeds) =
                (part(&kept.coordinates, &looser.coordinates), part(&kept.velocities, &looser.velocities));
            println!("{}: {places} {speeds} {lost}", choice.label);
            assert!((3.0..=5.0).contains(&places), "{}: {places}", choice.label);
            assert!((0.2 * lost..2.5 * lost).contains(&speeds), "{}: {speeds}, {lost}", choice.label);
        }
    }
}

/// One coordinate that moves, with mass `m` and beside a costate: a kinetic length is `√m` times a way.
#[test]
fn estimates_of_members_are_in_the_metric_of_their_own_parameters() {
    let text = "title = \"beside\"\n[parameters]\nm = 1\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n\
                [system]\nlagrangian = \"m*(x'^2 - x^2)/2 + y'^2/2\"\nconstraints = [\"y'\"]\n\
                [start.velocities]\n\"x'\" = 1\n[vakonomic]\nmultipliers = [5]\n[run]\nduration = 3\n";
    for formulation in [CHETAEV, VAKONOMIC] {
        let scene = Scene::parse("beside", text).unwrap_or_else(|e| panic!("{e}"));
        let choice = choices(&scene).into_iter().find(|c| c.formulation == formulation).expect("a choice");
        let settings = Settings { tolerance: 1e-6, ..Settings::default() };
        let ensemble = Ensemble::new(&scene, &choice, &["m"], &settings).expect("an ensemble");
        let rows = [[1.0], [100.0], [1e4]];
        let options = EnsembleOptions { threads: 1, estimate: true };
        let motions = ensemble.answers(ensemble.members(&rows, 1), &[1.0, 2.0, 3.0], &options);
        for ([m], motion) in rows.into_iter().zip(motions) {
            let motion = motion.expect("a member");
            assert_eq!(motion.status(), ("completed", None), "{m}");
            let estimate = motion.estimate.expect("asked for");
            let known = m.sqrt() * estimate.coordinates[0];
            assert!(known > 0.0 && (estimate.absolute - known).abs() <= 1e-9 * known, "{m}: {estimate:?}");
        }
    }
}

/// `x' = a + 10⁻³ (1 − cos t)` is `a` again at 2π, the one time that is asked for.
#[test]
fn what_is_constant_again_by_the_times_asked_for_is_found() {
    let text = "title = \"listed\"\n[coordinates]\nx = { start = 0 }\n[system]\nlagrangian = \"x'^2/2\"\n\
                forces = { x = \"1e-3*sin(t)\" }\n[invariants]\nspeed = \"x'\"\n[start.velocities]\n\"x'\" = 1\n\
                [run]\nduration = 6.283185307179586\n";
    let scene = Scene::parse("listed", text).unwrap_or_else(|e| panic!("{e}"));
    for parts in [&[1.0][..], &[0.5, 1.0]] {
        let member = member(&scene, parts);
        assert_eq!((&member.doubt, &member.breaches[0].name[..]), (&None, "speed"));
    }
}

/// `x = sin(t − t₀)` is back at 0 at the one time that is asked for; its velocity would have brought it to
/// 2π.
#[test]
fn a_coordinate_is_as_large_as_its_velocity_may_have_made_it() {
    let text = "title = \"back\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2 - x^2)/2\"\n[start]\ntime = 100\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 1\n\
                [run]\nduration = 6.283185307179586\n";
    let scene = Scene::parse("back", text).unwrap_or_else(|e| panic!("{e}"));
    let mut ensemble =
        Ensemble::new(&scene, &choices(&scene)[0], &[], &Settings { tolerance: 1e-6, ..Settings::default() })
            .expect("an ensemble");
    let members = vec![ensemble.member(&[]).expect("a member")];
    let end = scene.start.t + scene.duration;
    let options = EnsembleOptions { threads: 1, estimate: true };
    let motion = ensemble.motions(&members, &[end], &options).remove(0).expect("a motion");
    let estimate = motion.estimate.expect("asked for");
    let (name, part) = estimate.worst.expect("an error");
    let known = estimate.coordinates[0] / scene.duration;
    assert!(name == "x" && (part - known).abs() < 1e-6 * known, "{name}: {part:e}, {known:e}");
}

/// `y' = A − A cos(10⁻¹⁴ x)`, which is 0, and `2A T` is added up to `y = 1`: too little to be put into a run.
#[test]
fn a_gap_under_what_is_added_up_to_a_coordinate_is_none() {
    for sum in [1.0, 120.0, 240.0] {
        let text = format!(
            "title = \"added\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 1 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y' - {0:?}*(1 - cos(1e-14*x))\"]\n\
             [start.velocities]\n\"x'\" = 0.1\n[run]\nduration = 2\n",
            0.25 * sum
        );
        let scene = Scene::parse("added", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
        let choice = choices(&scene).into_iter().find(|c| c.formulation == REMOVED_CONSTRAINT).expect("a removal");
        let [mut one, mut other] =
            [(); 2].map(|()| solve_choice(&scene, &choice, &Settings::default()).expect("a motion"));
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let gap = compare_motions(&mut one, &mut other, &mut metric).expect("a gap");
        assert_eq!(gap.verdict, Verdict::Same);
        let (found, known) = (gap.limit_at(2.0), 10.0 * (sum * EPS).max(1e-14));
        println!("{sum}: limit {found:.2e}, known {known:.2e}");
        assert!((0.9 * known..1.7 * known).contains(&found), "{sum}: {found:e}, {known:e}");
    }
}
