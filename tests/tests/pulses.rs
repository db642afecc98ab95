//! What is switched on and off is found: forces and potentials of any width at any time, by every method and
//! in ensembles. The referee takes small steps where something is switched.

use diffsol_methods::{BDF, ESDIRK34, EVERY, TR_BDF2};
use discrete::Composition;
use integrate::Method;
use motion::{
    Choice, Ending, Ensemble, EnsembleOptions, Motion, Prepared, Settings, SolveError, Steps, choices, error_estimate,
    setting, solve_by_steps, solve_choice,
};
use scene::Scene;
use symbolic::SplitMix;

/// Number of pulses; `PULSES` asks for more.
const PULSES: usize = 60;
/// Largest part of runs that may be refused.
const REFUSED: f64 = 0.05;
/// What a run may be off by, of the size of its coordinates: BDF at its tolerance is.
const ALLOWED: f64 = 1e-4;
const DURATION: f64 = 10.0;

/// Lagrangian, constraints, coordinates with their starts, velocities given, coordinates pushed.
struct Body {
    lagrangian: &'static str,
    constraints: &'static [&'static str],
    coordinates: &'static [(&'static str, f64)],
    given: [&'static str; 2],
    pushed: [&'static str; 2],
}

const BODIES: [Body; 4] = [
    Body {
        lagrangian: "(x'^2 + y'^2 + phi'^2)/2",
        constraints: &["y'*cos(phi) - x'*sin(phi)"],
        coordinates: &[("x", 0.0), ("y", 0.0), ("phi", 0.3)],
        given: ["x", "phi"],
        pushed: ["x", "phi"],
    },
    Body {
        lagrangian: "(x'^2 + y'^2 + z'^2)/2",
        constraints: &["z' - y*x'"],
        coordinates: &[("x", 0.0), ("y", 0.2), ("z", 0.0)],
        given: ["x", "y"],
        pushed: ["x", "y"],
    },
    Body {
        lagrangian: "(x'^2 + y'^2)/2 + a'^2/4 + b'^2/8",
        constraints: &["x' - a'*cos(b)", "y' - a'*sin(b)"],
        coordinates: &[("x", 0.0), ("y", 0.0), ("a", 0.1), ("b", 0.4)],
        given: ["a", "b"],
        pushed: ["a", "b"],
    },
    Body {
        lagrangian: "(x'^2 + y'^2 + 0.4*a'^2 + 0.4*b'^2)/2",
        constraints: &["x' - b' + 0.3*y", "y' + a' - 0.3*x"],
        coordinates: &[("x", 0.5), ("y", 0.0), ("a", 0.0), ("b", 0.0)],
        given: ["x", "y"],
        pushed: ["a", "y"],
    },
];

/// A pulse around `at`, nothing beyond `reach` of it.
struct Pulse {
    at: f64,
    reach: f64,
    finest: f64,
    text: String,
    scene: String,
}

impl Pulse {
    fn new(random: &mut SplitMix) -> Pulse {
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let width = 10.0_f64.powf(between(-3.0, 0.0));
        let at = between(1.0, DURATION - 1.0 - width);
        let strength = between(0.5, 2.0);
        let edge = width / between(4.0, 40.0);
        let (half, is_bell) = (width / 2.0, between(0.0, 1.0) < 0.3);
        let shape = match is_bell {
            true => format!("exp(-((t - {at})/{half})^2)"),
            false => format!("(tanh((t - {at} + {half})/{edge}) - tanh((t - {at} - {half})/{edge}))/2"),
        };
        let (reach, finest) = if is_bell { (6.0 * half, half / 40.0) } else { (half + 18.0 * edge, edge / 12.0) };
        let body = &BODIES[(between(0.0, 4.0) as usize).min(3)];
        let is_potential = between(0.0, 1.0) < 0.5;
        let speed = if between(0.0, 1.0) < 0.5 { 0.0 } else { between(0.1, 0.8) };
        let text = format!("{strength}*{shape}");
        let push = [1.0, 0.4].map(|part| format!("{part}*on"));
        let (added, forces) = if is_potential {
            let terms: Vec<String> = push.iter().zip(body.pushed).map(|(push, q)| format!(" + {push}*{q}")).collect();
            (terms.concat(), String::new())
        } else {
            let terms: Vec<String> =
                push.iter().zip(body.pushed).map(|(push, q)| format!("{q} = \"{push}\"")).collect();
            (String::new(), format!("forces = {{ {} }}", terms.join(", ")))
        };
        let coordinates: String =
            body.coordinates.iter().map(|(q, start)| format!("{q} = {{ unit = \"1\", start = {start} }}\n")).collect();
        let given: String = body.given.iter().map(|q| format!("\"{q}'\" = {speed}\n")).collect();
        let (lagrangian, constraints) = (body.lagrangian, body.constraints);
        let scene = format!(
            "title = \"pulse\"\n[coordinates]\n{coordinates}[definitions]\non = \"{text}\"\n[system]\n\
             lagrangian = \"{lagrangian}{added}\"\nconstraints = {constraints:?}\n{forces}\n[start.velocities]\n{given}\
             [run]\nduration = {DURATION}\n"
        );
        Pulse { at, reach, finest, text, scene }
    }

    /// Coordinates at the end by the classical Runge–Kutta method, in steps that see the pulse.
    fn end(&self, scene: &Scene, choice: &Choice) -> Vec<f64> {
        let equations = motion::derive_at(&scene.system, &scene.start, choice).expect("equations");
        let ready = motion::prepare(setting(scene), equations, &choice.constants, &Settings::default());
        let mut ready: Prepared = ready.expect("a start");
        let (mut t, mut y) = (ready.t, ready.start.clone());
        let mut rates = |t: f64, y: &[f64]| {
            let mut rates = vec![0.0; y.len()];
            ready.compiled.rates(t, y, &mut rates).expect("rates");
            rates
        };
        let moved = |y: &[f64], h: f64, k: &[f64]| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + h * k).collect() };
        let places = [(self.at - self.reach, 2e-3), (self.at + self.reach, self.finest), (DURATION, 2e-3)];
        for (end, longest) in places {
            let steps = ((end - t) / longest).ceil().max(1.0);
            let h = (end - t) / steps;
            for _ in 0..steps as usize {
                let a = rates(t, &y);
                let b = rates(t + h / 2.0, &moved(&y, h / 2.0, &a));
                let c = rates(t + h / 2.0, &moved(&y, h / 2.0, &b));
                let d = rates(t + h, &moved(&y, h, &c));
                for (i, y) in y.iter_mut().enumerate() {
                    *y += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
                }
                t += h;
            }
        }
        ready.compiled.outputs(DURATION, &y).expect("outputs").coordinates
    }
}

fn off(found: &[f64], right: &[f64]) -> f64 {
    let size = right.iter().fold(1.0_f64, |size, q| size.max(q.abs()));
    found.iter().zip(right).map(|(a, b)| (a - b).abs() / size).fold(0.0, f64::max)
}

#[test]
fn every_pulse_is_found_by_every_method_and_in_ensembles() {
    let count = std::env::var("PULSES").ok().and_then(|count| count.parse().ok()).unwrap_or(PULSES);
    let mut random = SplitMix::new(16);
    let (mut refused, mut asked, mut equal, mut passed_over) = (0, 0, 0, 0);
    for index in 0..count {
        let pulse = Pulse::new(&mut random);
        let scene = Scene::parse("pulse", &pulse.scene).unwrap_or_else(|error| panic!("{error}\n{}", pulse.scene));
        let choice = &choices(&scene)[0];
        let right = pulse.end(&scene, choice);
        let what = |by: &str| format!("pulse {index} by {by}, {}: {}", pulse.text, pulse.scene);
        for method in [None].into_iter().chain(EVERY.map(Some)) {
            // the last two have order 2 and 3
            let tolerance =
                if method.is_some_and(|method| [TR_BDF2, ESDIRK34].contains(&method)) { 1e-6 } else { 1e-8 };
            let settings = Settings { method, tolerance, ..Settings::default() };
            let mut motion = solve_choice(&scene, choice, &settings).unwrap_or_else(|e| panic!("{}: {e}", what("")));
            asked += 1;
            if !motion.is_complete() || motion.doubt.is_some() {
                refused += 1;
                continue;
            }
            let found = motion.at(motion.end()).expect("an end").coordinates;
            assert!(
                off(&found, &right) < ALLOWED,
                "{}: {found:?}, not {right:?}",
                what(method.map_or("auto", Method::name))
            );
        }
        let composition = Composition::ALL[index % 4];
        for step in [2.0, 0.2, (5.0 * pulse.finest).max(1e-3)] {
            let by = format!("equal steps of {step}, {composition:?}");
            match solve_by_steps(&scene, choice, Steps { step, composition }, &Settings::default()) {
                // it says so, and where
                Ok(motion) if !motion.is_complete() => {
                    if let Some((length, enough)) = passes_over(&motion) {
                        let t = motion.end();
                        let around = t < pulse.at + pulse.reach && t + 2.0 * length > pulse.at - pulse.reach;
                        assert!(around && enough < length, "{}: {t}, {enough}", what(&by));
                        passed_over += 1;
                    }
                }
                Ok(mut motion) => {
                    let estimate = error_estimate(&mut motion, setting(&scene)).expect("an estimate");
                    let found = motion.at(motion.end()).expect("an end").coordinates;
                    let allowed = ALLOWED + 10.0 * estimate.relative;
                    assert!(off(&found, &right) < allowed, "{}: {found:?}, not {right:?}", what(&by));
                    equal += 1;
                }
                // steps too long to be solved
                Err(SolveError::Discrete(_)) => {}
                Err(error) => panic!("{}: {error}", what(&by)),
            }
        }
        if index % 10 == 0 {
            let settings = Settings { method: Some(Method::Taylor), tolerance: 1e-8, ..Settings::default() };
            let mut ensemble = Ensemble::new(&scene, choice, &[], &settings).expect("an ensemble");
            let member = ensemble.member(&[]).expect("a member");
            let motion = ensemble.motions(&[member], &[DURATION], &EnsembleOptions::default()).remove(0);
            let found = &motion.expect("a motion").outputs[0].coordinates;
            assert!(off(found, &right) < ALLOWED, "{}: {found:?}, not {right:?}", what("an ensemble"));
        }
    }
    assert!(refused as f64 <= REFUSED * asked as f64, "{refused} of {asked} runs are refused");
    assert!(equal > count / 5 && passed_over > count, "{equal} by equal steps, {passed_over} refused");
    println!("{count} pulses, {asked} runs, {refused} refused, none passed over");
}

/// The steps of a motion that passes over something, and steps that would do.
fn passes_over(motion: &Motion) -> Option<(f64, f64)> {
    let Ending::Stopped { cause, .. } = &motion.ending else { return None };
    let (step, rest) = cause.strip_prefix("a step of ")?.split_once(" passes over")?;
    let (_, rest) = rest.split_once("steps of ")?;
    Some((step.parse().ok()?, rest.split(' ').next()?.parse().ok()?))
}

/// Half a second of a push on a sledge at rest, as a user would write it.
const SWITCH: &str = r#"
title = "switch"
[coordinates]
x = { start = 0 }
y = { start = 0 }
phi = { start = 0.3 }
[definitions]
on = "(tanh((t - 5)/0.01) - tanh((t - 5.5)/0.01))/2"
[system]
lagrangian = "(x'^2 + y'^2 + phi'^2)/2"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
forces = { x = "on*cos(phi)", y = "on*sin(phi)", phi = "0.4*on" }
[start.velocities]
"x'" = 0
"phi'" = 0
[run]
duration = 10
"#;

#[test]
fn equal_steps_stop_before_a_switch_and_say_what_would_do() {
    let scene = Scene::parse("switch", SWITCH).expect("a scene");
    let choice = &choices(&scene)[0];
    let solve = |step: f64| {
        let steps = Steps { step, composition: Composition::Second };
        solve_by_steps(&scene, choice, steps, &Settings::default()).expect("a motion")
    };
    let mut motion = solve(1.0);
    let (step, enough) = passes_over(&motion).unwrap_or_else(|| panic!("{:?}", motion.ending));
    assert!((4.0..=5.0).contains(&motion.end()) && step == 1.0 && enough > 1e-3 && enough < 0.1, "{enough}");
    assert!(matches!(&motion.ending, Ending::Stopped { t, cause } if *t == motion.end() && cause.contains("tanh of")));
    assert!(motion.at(motion.end()).expect("what was reached").coordinates[0].abs() < 1e-12);
    let mut motion = solve(enough);
    let end = motion.at(10.0).expect("an end").coordinates;
    assert!((end[0] - 1.6337).abs() < 1e-2 && (end[2] - 1.25).abs() < 1e-3, "{end:?}");
}

#[test]
fn every_method_and_ensembles_end_a_step_at_breakpoints() {
    let scene = Scene::parse("switch", &SWITCH.replace("duration = 10", "duration = 10\nbreakpoints = [5.5, 5, 12]"));
    let scene = scene.expect("a scene");
    let again = Scene::parse("switch", &scene.to_toml()).expect("as written");
    assert_eq!(again.system.breakpoints, [5.5, 5.0, 12.0]);
    let choice = &choices(&scene)[0];
    for method in [None].into_iter().chain(EVERY.map(Some)) {
        let settings = Settings { method, tolerance: 1e-6, max_step: 0.5, ..Settings::default() };
        let mut motion = solve_choice(&scene, choice, &settings).expect("a motion");
        let times = motion.step_times();
        assert!([5.0, 5.5].iter().all(|t| times.contains(t)), "{method:?}: {times:?}");
        assert!(times.windows(2).all(|t| t[1] - t[0] <= 0.5 + 1e-12), "{method:?}: {times:?}");
        assert!((motion.at(10.0).expect("an end").coordinates[2] - 1.25).abs() < 1e-3, "{method:?}");
    }
    let mut ensemble = Ensemble::new(&scene, choice, &[], &Settings::default()).expect("an ensemble");
    assert!(ensemble.refusal().is_some());
    let member = ensemble.member(&[]).expect("a member");
    let run = ensemble.run(&[member], &[10.0], &EnsembleOptions::default()).remove(0).expect("a run");
    assert!((run.states[0][2] - 1.25).abs() < 1e-9, "{:?}", run.states);
    let steps = Steps { step: 0.3, composition: Composition::Second };
    let error = solve_by_steps(&scene, choice, steps, &Settings::default()).expect_err("refused");
    assert!(matches!(error, SolveError::Breakpoint { t: 5.5 | 5.0, .. }), "{error}");
}

/// A high power of time is zero to a high order where steps begin: x(1) by every method, and of two members.
fn flat(scene: &str, coordinate: usize, right: f64) {
    let scene = Scene::parse("flat", scene).expect("a scene");
    let (choice, mut completed) = (&choices(&scene)[0], 0);
    for method in EVERY.into_iter().map(Some).chain([None]) {
        let mut motion = solve_choice(&scene, choice, &Settings { method, ..Settings::default() }).expect("a motion");
        let Ending::Completed = motion.ending else { continue };
        completed += 1;
        let found = motion.at(1.0).expect("the end").coordinates[coordinate];
        let allowed = if method == Some(BDF) { ALLOWED } else { 1e-7 };
        assert!((found - right).abs() < allowed, "{method:?}: {found} instead of {right}");
    }
    assert!(completed > 5, "{completed} methods complete it");
    let mut ensemble = Ensemble::new(&scene, choice, &[], &Settings::default()).expect("an ensemble");
    let members = vec![ensemble.member(&[]).expect("a member"); 2];
    for run in ensemble.run(&members, &[1.0], &EnsembleOptions::default()) {
        let found = run.expect("a run").states[0][coordinate];
        assert!((found - right).abs() < 1e-9, "in lanes: {found} instead of {right}");
    }
}

#[test]
fn a_force_that_is_flat_at_both_ends_is_not_passed() {
    // x(1) = ∫ (1 − t) (4 t (1 − t))⁴⁰ dt = 4⁴⁰ (40!)²/81! / 2
    let right = (1..=40).fold(0.5 / 81.0, |product, k| product * 4.0 * f64::from(k) / f64::from(40 + k));
    let scene = "title = 'flat'\n[coordinates]\nx = { start = 0 }\n[system]\nlagrangian = \"x'^2/2\"\n\
                 forces = { x = '(4*t*(1-t))^40' }\n[start]\nvelocities = { \"x'\" = 0 }\n[run]\nduration = 1\n";
    flat(scene, 0, right);
}

#[test]
fn a_constraint_that_is_flat_at_the_start_is_kept() {
    // straight on at the speed √(1 + t⁴⁰), by the midpoint rule
    let parts = 200_000;
    let speed = |i: i32| (1.0 + ((f64::from(i) + 0.5) / f64::from(parts)).powi(40)).sqrt();
    let right = 0.6 * (0..parts).map(speed).sum::<f64>() / f64::from(parts);
    let scene = "title = 'flat'\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"x'^2 + y'^2 - 1 - t^40\"]\n\
                 [start]\nvelocities = { \"x'\" = 0.6, \"y'\" = 0.8 }\n[run]\nduration = 1\n";
    flat(scene, 0, right);
}

#[test]
fn a_first_step_sees_what_its_stages_miss() {
    // inertia that is large where it starts: 1 + 0.4 s'(x)², and s' is -1/(2w) at the start
    for w in [1e-8_f64, 1e-9] {
        let scene = format!(
            "title = 'edge'\n[coordinates]\nx = {{ start = '0.4' }}\n[definitions]\n\
             R = 'rotation(z, step(x, 0.1, 0.4, {w:e}))'\nW = 'angular_velocity(R)'\n[system]\n\
             lagrangian = \"x'^2/2 + dot(W, W)/5\"\nconstraints = []\n[start.velocities]\n\"x'\" = 1\n\
             [run]\nduration = 2\n"
        );
        let scene = Scene::parse("edge", &scene).expect("a scene");
        let (speed, mut told) = ((1.0 + 0.1 / (w * w)).sqrt(), 0);
        for choice in choices(&scene) {
            for method in [Method::Taylor, Method::Dop853, Method::Radau5] {
                let settings = Settings { method: Some(method), max_steps: 20_000, ..Settings::default() };
                let Ok(mut motion) = solve_choice(&scene, &choice, &settings) else { continue };
                if motion.doubt.is_some() || motion.end() < 1e-5 {
                    continue;
                }
                let estimate = error_estimate(&mut motion, setting(&scene)).expect("an estimate").coordinates[0];
                let (x, right) = (motion.at(motion.end()).expect("an end").coordinates[0], speed * motion.end());
                let allowed = 10.0 * estimate + 1e-3 * right;
                assert!((x - right).abs() < allowed, "{} by {method:?}, {w}: {x} for {right}", choice.label);
                told += usize::from(allowed < 0.1 * right);
            }
        }
        assert!(told > 2, "{told} motions leave the edge");
    }
}
