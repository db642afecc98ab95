//! Members against single runs of scenes that are derived and compiled for themselves.

use equations::Formulation;
use integrate::Method;
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Choice, Ending, Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, MemberRun, REMOVED_CONSTRAINT,
    Settings, SolveError, VAKONOMIC, choices, constants_of, solve_choice,
};
use scene::Scene;
use symbolic::LANES;

const SLEDGE: &str = include_str!("../../scene/scenes/sledge.toml");

/// Two states, the first unbounded at `t = 1 / u₀`: `x' = u`, `u' = b u²` by a force of its own.
const BLOW_UP: &str = r#"
title = "Velocity that grows with its square"
[parameters]
b = 1
[coordinates]
x = { start = 0 }
y = { start = 0 }
[system]
lagrangian = "(x'^2 + y'^2)/2"
constraints = ["y' - x'"]
forces = { x = "2*b*x'^2" }
[start.velocities]
"x'" = 0.5
[run]
duration = 1.5
"#;

fn settings() -> Settings {
    Settings { method: Some(Method::Taylor), tolerance: 1e-10, ..Settings::default() }
}

fn scene(text: &str, overrides: &[(&str, f64)]) -> Scene {
    let overrides: Vec<(String, f64)> = overrides.iter().map(|(name, x)| (name.to_string(), *x)).collect();
    Scene::parse_with("member", text, &overrides).unwrap()
}

fn choice(scene: &Scene, formulation: &Formulation) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation == formulation).unwrap()
}

/// Numbers between 0 and 1.
fn golden(i: usize) -> f64 {
    (0.618_033_988_749_894_9 * (i + 1) as f64).fract()
}

/// Sledges on slopes of their own, with starts and durations of their own.
fn sledges(count: usize) -> Vec<Scene> {
    let member = |i: usize| {
        let x = |k: usize| golden(7 * i + k);
        scene(
            SLEDGE,
            &[
                ("alpha", 0.2 + 0.5 * x(0)),
                ("k", 0.5 + x(1)),
                ("phi", 2.0 * x(2) - 1.0),
                ("phi'", 3.0 * x(3) - 1.5),
                ("duration", 1.0 + 4.0 * x(4)),
                ("mu0_1", x(5) - 0.5),
            ],
        )
    };
    (0..count).map(member).collect()
}

fn run(ensemble: &Ensemble, members: &[EnsembleMember], times: &[f64], threads: usize) -> Vec<MemberRun> {
    let options = EnsembleOptions { threads, estimate: true };
    ensemble.run(members, times, &options).into_iter().map(Result::unwrap).collect()
}

fn ready(scenes: &[Scene], formulation: &Formulation, parameters: &[&str]) -> (Ensemble, Vec<EnsembleMember>) {
    let choice = choice(&scenes[0], formulation);
    let mut ensemble = Ensemble::new(&scenes[0], &choice, parameters, &settings()).unwrap();
    let start = |scene| start_of(scene, &choice, parameters);
    let members = scenes.iter().map(|scene| ensemble.member_at(&start(scene)).unwrap()).collect();
    (ensemble, members)
}

fn start_of(scene: &Scene, choice: &Choice, parameters: &[&str]) -> EnsembleStart {
    EnsembleStart::of(scene, parameters, constants_of(choice, scene))
}

#[test]
fn a_member_is_the_same_to_the_last_bit_whatever_runs_beside_it() {
    let scenes = sledges(3 * LANES + 1);
    let (ensemble, members) = ready(&scenes, VAKONOMIC, &["alpha", "k"]);
    let times = [0.5, 1.0];
    let all = run(&ensemble, &members, &times, 1);
    assert_eq!(run(&ensemble, &members, &times, 3), all);
    let backwards: Vec<EnsembleMember> = members.iter().rev().cloned().collect();
    let mut other = run(&ensemble, &backwards, &times, 2);
    other.reverse();
    assert_eq!(other, all);
    for (member, expected) in members.iter().zip(&all).take(5) {
        assert_eq!(run(&ensemble, std::slice::from_ref(member), &times, 1)[0], *expected);
    }
}

#[test]
fn members_that_stop_do_so_alone_and_where_they_should() {
    let speeds = [0.5, 2.0, 0.1, 1.0, -1.0, 0.9, 0.3, 0.6, 4.0, 0.2];
    let scenes: Vec<Scene> = speeds.iter().map(|&u| scene(BLOW_UP, &[("x'", u), ("b", 1.0)])).collect();
    let (ensemble, members) = ready(&scenes, CHETAEV, &["b"]);
    for (u, run) in speeds.into_iter().zip(run(&ensemble, &members, &[0.2, 1.5], 1)) {
        // u' = b u², x = −ln(1 − b u₀ t)/b
        let stops = u * 1.5 > 1.0;
        assert_eq!(run.alone.is_some(), stops, "{u}: {:?}", run.alone);
        assert_eq!(run.states.len(), if stops { 1 } else { 2 }, "{u}");
        let expected = -(1.0 - 0.2 * u).ln();
        assert!((run.states[0][0] - expected).abs() < 1e-10, "{u}: {} and {expected}", run.states[0][0]);
        match run.ending {
            Ending::Completed => assert!(!stops, "{u}"),
            Ending::Stopped { t, .. } => assert!(stops && (t - 1.0 / u).abs() < 1e-3, "{u}: {t}"),
        }
    }
}

#[test]
fn what_is_no_member_is_refused() {
    let base = scene(SLEDGE, &[]);
    let chetaev = choice(&base, CHETAEV);
    let refused =
        |names: &[&str]| matches!(Ensemble::new(&base, &chetaev, names, &settings()), Err(SolveError::Member { .. }));
    assert!(refused(&["g", "g"]) && refused(&["mu0_1"]));
    let unknown = Ensemble::new(&base, &chetaev, &["g", "beta"], &settings());
    assert!(matches!(unknown, Err(SolveError::Scene(fault)) if fault.kind.to_string().contains("`beta`")));
    let mut ensemble = Ensemble::new(&base, &chetaev, &["g", "y'"], &settings()).unwrap();
    assert!(ensemble.member(&[3.0, 0.5 * 0.3_f64.sin()]).is_ok());
    assert!(ensemble.member(&[3.0, 3.0]).unwrap_err().contains("contradict"));
    assert!(ensemble.member(&[f64::NAN, 0.0]).unwrap_err().contains("`g`"));
    for tolerance in [0.0, 1.0, -1e-9, f64::NAN, f64::INFINITY] {
        let settings = Settings { tolerance, ..settings() };
        let refused = Ensemble::new(&base, &chetaev, &[], &settings);
        assert!(matches!(refused, Err(SolveError::Tolerance { .. })), "tolerance {tolerance}");
    }
    let natural = choice(&base, REMOVED_CONSTRAINT);
    assert!(Ensemble::new(&base, &natural, &["g"], &settings()).is_ok());
    assert!(Ensemble::new(&base, &natural, &[], &settings()).is_ok());
}

#[test]
fn costates_vary_as_given_constants() {
    let base = scene(SLEDGE, &[]);
    let removed = choice(&base, REMOVED_CONSTRAINT);
    let names = ["P0_y", "phi'", "P0_x"];
    let ensemble = Ensemble::new(&base, &removed, &names, &settings()).unwrap();
    let rows: Vec<[f64; 3]> = (0..12).map(|i| [golden(i) - 0.5, 1.0 + golden(i + 20), 2.0 * golden(i + 40)]).collect();
    let answers = ensemble.answers(ensemble.members(&rows, 1), &[0.5], &EnsembleOptions::default());
    for ([y, omega, x], answer) in rows.iter().zip(answers) {
        let answer = answer.unwrap();
        let own = scene(SLEDGE, &[("phi'", *omega)]);
        let constants = ConstantsRule::Given(vec![*x, *y]);
        let removed = choice(&own, REMOVED_CONSTRAINT);
        let mut alone = solve_choice(&own, &Choice { constants, ..removed }, &settings()).unwrap();
        let expected = alone.at(0.5).unwrap();
        for (one, other) in answer.outputs[0].coordinates.iter().zip(&expected.coordinates) {
            assert!((one - other).abs() < 1e-9, "{one} and {other}");
        }
    }
    let without = choice(&base, CHETAEV);
    for (choice, name) in [(&removed, "P0_phi"), (&without, "P0_x")] {
        let refused = Ensemble::new(&base, choice, &[name], &settings());
        assert!(matches!(refused, Err(SolveError::Member { reason }) if reason.contains(name)));
    }
}

#[test]
fn members_that_fail_at_the_start_do_not_disturb_the_others() {
    let scenes = sledges(LANES + 5);
    let (mut ensemble, mut members) = ready(&scenes, VAKONOMIC, &["alpha", "k"]);
    let times = [0.7];
    let expected = run(&ensemble, &members, &times, 1);
    // a start that is no number, and one without a length
    let vakonomic = choice(&scenes[0], VAKONOMIC);
    let mut broken = |member: &EnsembleMember, i: usize| match i % 2 {
        0 => member.clone().starting_at(vec![f64::NAN; member.start().len()]),
        _ => {
            let start = start_of(&scenes[i], &vakonomic, &["alpha", "k"]);
            ensemble.member_at(&EnsembleStart { end: start.state.t, ..start }).unwrap()
        }
    };
    let mut order = Vec::new();
    for (i, member) in members.split_off(0).into_iter().enumerate() {
        if i % 3 == 0 {
            members.push(broken(&member, i));
            order.push(None);
        }
        members.push(member);
        order.push(Some(i));
    }
    for threads in [1, 2] {
        let options = EnsembleOptions { threads, estimate: true };
        for (outcome, i) in ensemble.run(&members, &times, &options).into_iter().zip(&order) {
            match i {
                Some(i) => assert_eq!(outcome.unwrap(), expected[*i]),
                None => assert!(matches!(outcome, Err(SolveError::Call(_))), "{outcome:?}"),
            }
        }
    }
    let state = mechanics::State { t: 0.0, q: vec![0.0; 3], v: vec![0.0; 3] };
    let constants = ConstantsRule::Given(vec![f64::NAN]);
    let start = EnsembleStart { state, end: 1.0, parameters: vec![0.3, 0.7], constants };
    assert!(matches!(ensemble.member_at(&start), Err(SolveError::ConstantNotFinite { .. })));
    let start = EnsembleStart { parameters: vec![0.3], constants: ConstantsRule::Zero, ..start };
    assert!(matches!(ensemble.member_at(&start), Err(SolveError::Member { .. })));
}

#[test]
fn starts_and_natural_constants_do_not_depend_on_threads_and_order() {
    let scenes = sledges(LANES + 1);
    let base = scene(SLEDGE, &[]);
    let removed = choice(&base, REMOVED_CONSTRAINT);
    let mut ensemble = Ensemble::new(&base, &removed, &["phi", "phi'"], &settings()).unwrap();
    let rows: Vec<[f64; 2]> = scenes.iter().map(|scene| [scene.start.q[2], scene.start.v[2]]).collect();
    let members: Vec<EnsembleMember> = ensemble.members(&rows, 3).into_iter().map(Result::unwrap).collect();
    for (row, member) in rows.iter().zip(&members).rev() {
        assert_eq!(ensemble.member(row).unwrap(), *member);
    }
    // P_x = g sin α (T − t), of the scene's own slope: parameters are those of the ensemble
    let natural = members.iter().map(|member| member.constants()[0] - 9.81 * 0.4_f64.sin() * 10.0);
    assert!(natural.fold(0.0, |a: f64, x| a.max(x.abs())) < 1e-8);
    let started = vec![Ok(members[0].clone()), Err("no start".into())];
    let refused = ensemble.answers(started, &[0.5], &EnsembleOptions::default());
    assert!(refused[0].as_ref().is_ok_and(|motion| motion.status() == ("completed", None)));
    assert_eq!(refused[1].as_ref().unwrap_err(), "no start");
}

#[test]
fn members_with_very_different_steps_do_not_wait_for_one_another_in_their_results() {
    let rates = [0.01, 300.0, 1.0, 30.0, 0.1, 100.0, 3.0, 10.0, 0.03, 200.0, 0.3];
    let scenes: Vec<Scene> = rates.iter().map(|&w| scene(SLEDGE, &[("phi'", w), ("duration", 2.0)])).collect();
    let (ensemble, members) = ready(&scenes, CHETAEV, &[]);
    let runs = run(&ensemble, &members, &[1.1, 2.0], 2);
    let steps: Vec<usize> = runs.iter().map(|run| run.work.steps).collect();
    assert!(steps[1] > 50 * steps[0], "{steps:?}");
    for ((w, scene), run) in rates.iter().zip(&scenes).zip(&runs) {
        // φ = φ₀ + w t, u = u₀ + (g sin α/w)(sin φ − sin φ₀) along the blade: Neimark & Fufaev 1972
        let (phi, a) = (0.3 + 2.0 * w, 9.81 * 0.4_f64.sin());
        let u = 0.5 + a / w * (phi.sin() - 0.3_f64.sin());
        let state = &run.states[1];
        assert_eq!(run.ending, Ending::Completed);
        // y = (x, y, φ, φ', u), in whatever order the quasi-velocities are
        let speed = state[3..].iter().map(|found| (found - u).abs()).fold(f64::INFINITY, f64::min);
        assert!((state[2] - phi).abs() < 1e-9 * (1.0 + phi.abs()), "w = {w}: {state:?}, phi = {phi}");
        assert!(speed < 1e-9 * (1.0 + u.abs()), "w = {w}: {state:?}, u = {u}");
        let single = solve_choice(scene, &choice(scene, CHETAEV), &settings()).unwrap();
        assert_eq!(run.work.steps.abs_diff(single.work.steps), 0, "w = {w}");
    }
}

#[test]
fn an_interrupt_ends_members_on_the_way() {
    let interrupt = integrate::Interrupt::default();
    let endless = scene(SLEDGE, &[("duration", 1e9)]);
    let settings = Settings { interrupt: Some(interrupt.clone()), max_steps: usize::MAX, ..settings() };
    let mut ensemble = Ensemble::new(&endless, &choice(&endless, CHETAEV), &[], &settings).unwrap();
    let members = vec![ensemble.member(&[]).unwrap(); 3];
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(std::time::Duration::from_millis(50));
            interrupt.raise();
        });
        for run in ensemble.run(&members, &[], &EnsembleOptions { threads: 1, estimate: true }) {
            let Ending::Stopped { cause, .. } = run.unwrap().ending else { panic!("an end of what is endless") };
            assert!(cause.contains("interrupt"), "{cause}");
        }
    });
}
