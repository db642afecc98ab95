//! References with a known error: two methods agree, forms agree, closed and 42-digit solutions are met.

use crate::references::{Motion, REFERENCES};
use equations::Equations;
use mechanics::StartError;
use motion::{Choice, Settings, choices, derive, prepare, setting};
use reference::{DoubleDouble, Entry, Question, Reference, ReferenceError, reference, reference_in};
use scene::Scene;
use symbolic::Scalar;

fn scene(name: &str) -> Scene {
    let path = format!("{}/../crates/scene/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scene::parse(name, &std::fs::read_to_string(path).unwrap()).unwrap()
}

fn choice(scene: &Scene, label: &str) -> Choice {
    choices(scene).into_iter().find(|c| c.label == label).unwrap()
}

/// Equations and free constants of a choice, as a run in `f64` has them.
fn asked(scene: &Scene, label: &str) -> (Equations, Vec<f64>) {
    let choice = choice(scene, label);
    let equations = derive(&scene.system, &choice).unwrap();
    let ready = prepare(setting(scene), equations, &choice.constants, &Settings::default()).unwrap();
    (ready.equations, ready.constants)
}

fn times(end: f64) -> Vec<f64> {
    (1..=10).map(|i| end * f64::from(i) / 10.0).collect()
}

fn computed(scene: &Scene, label: &str, times: &[f64]) -> Result<Reference, ReferenceError> {
    let (equations, constants) = asked(scene, label);
    let question =
        Question { system: &scene.system, start: &scene.start, equations: &equations, constants: &constants };
    reference(&question, times, 1e-20)
}

/// The motion over `end`, with an error of at most 1e-20, which is printed.
fn known(name: &str, label: &str, end: f64) -> Reference {
    let scene = scene(name);
    let clock = std::time::Instant::now();
    let found = computed(&scene, label, &times(end)).unwrap();
    let a = found.agreement;
    println!(
        "{name}, {label}, {end} s: reference error {:.1e} (methods {:.1e}, tolerances {:.1e}); f {:.1e}; {:.2} s",
        found.error(),
        a.methods,
        a.taylor,
        found.constraint_residual,
        clock.elapsed().as_secs_f64()
    );
    assert!(found.error() <= 1e-20 && a.methods <= 1e-20 && a.taylor <= 1e-20, "{a:?}");
    // no run is projected onto the constraint: staying on it is a result
    assert!(found.constraint_residual < 1e-24, "{:.1e}", found.constraint_residual);
    found
}

/// The two forms of the vakonomic motion are different equations in different states.
fn both_forms(name: &str, end: f64) {
    let (multipliers, costates) = (known(name, "vakonomic", end), known(name, "vakonomic, costate form", end));
    let gap = multipliers.gap(&costates);
    println!("{name}, {end} s: the two vakonomic forms agree to {gap:.1e}");
    assert!(gap <= 1e-20 && gap > 0.0);
}

#[test]
fn sledge_over_ten_seconds() {
    let chetaev = known("sledge", "Chetaev", 10.0);
    let removed = known("sledge", "removed constraint (arc-length)", 10.0);
    assert!(chetaev.gap(&removed) > 1.0);
    both_forms("sledge", 10.0);
}

#[test]
fn particle_over_ten_seconds() {
    known("particle", "Chetaev", 10.0);
    known("particle", "removed constraint (along-x)", 10.0);
    both_forms("particle", 10.0);
}

#[test]
fn ball_in_cone_over_five_seconds() {
    known("ball-in-cone", "Chetaev", 5.0);
    both_forms("ball-in-cone", 5.0);
}

#[test]
fn ball_in_cone_with_removed_constraint_over_five_seconds() {
    known("ball-in-cone", "removed constraint (paper)", 5.0);
}

fn largest_difference(found: &[DoubleDouble], right: &[DoubleDouble]) -> f64 {
    found.iter().zip(right).fold(0.0, |worst, (&a, &b)| worst.max((a - b).size()))
}

#[test]
fn the_sledges_closed_solution_is_met() {
    let scene = scene("sledge");
    let number = DoubleDouble::from_f64;
    let found = computed(&scene, "Chetaev", &times(10.0)).unwrap();
    let parameter = |i: usize| number(scene.system.parameters[i].value);
    let slope = parameter(0) * parameter(1).sin();
    let (v, phi0) = (&scene.start.v, number(scene.start.q[2]));
    let omega = number(v[2]);
    let (s0, c0) = phi0.sin_cos();
    // the nearest velocity along the blade
    let speed = number(v[0]) * c0 + number(v[1]) * s0;
    let half = DoubleDouble::from_ratio(1, 2);
    let mut worst = 0.0_f64;
    for (&t, point) in found.times.iter().zip(&found.points) {
        let turn = omega * number(t);
        let (s1, c1) = (phi0 + turn).sin_cos();
        let (c, s) = ((s1 - s0) / omega, (c0 - c1) / omega);
        let x = speed * c + half * slope * c * c;
        let y = speed * s + half * slope * (c * s + (turn - turn.sin()) / (omega * omega));
        worst = worst.max(largest_difference(&point.coordinates, &[x, y, phi0 + turn]));
        let reaction = omega * (speed + slope * c) + slope * s1;
        worst = worst.max(largest_difference(&point.multipliers, &[reaction]));
    }
    println!("sledge, Chetaev, against the closed solution: {worst:.1e}, the reference says {:.1e}", found.error());
    assert!(worst < 1e-24);
}

#[test]
fn the_particles_closed_solution_is_met() {
    let scene = scene("particle");
    let number = DoubleDouble::from_f64;
    let found = computed(&scene, "Chetaev", &times(10.0)).unwrap();
    let (y0, rate) = (number(scene.start.q[1]), number(scene.start.v[1]));
    let length = |y: DoubleDouble| (number(1.0) + y * y).sqrt();
    // y' and x' √(1 + y²) are constant
    let constant = number(scene.start.v[0]) * length(y0);
    let mut worst = 0.0_f64;
    for (&t, point) in found.times.iter().zip(&found.points) {
        let y = y0 + rate * number(t);
        let x = constant / rate * (y.asinh() - y0.asinh());
        let z = constant / rate * (length(y) - length(y0));
        worst = worst.max(largest_difference(&point.coordinates, &[x, y, z]));
    }
    println!("particle, Chetaev, against the closed solution: {worst:.1e}, the reference says {:.1e}", found.error());
    assert!(worst < 1e-24);
}

/// States from SymPy and MPFR, whose data are decimal fractions: what that changes is part of them.
#[test]
fn states_computed_with_42_digits_are_met() {
    let mut met = 0;
    for right in REFERENCES.iter() {
        let (name, constants) = match &right.motion {
            Motion::Chetaev => ("Chetaev", vec![]),
            Motion::Vakonomic { multipliers } => ("vakonomic", multipliers.to_vec()),
            Motion::Removed { .. } => continue,
        };
        let scene = scene(right.scene);
        let equations = derive(&scene.system, &choice(&scene, name)).unwrap();
        let question =
            Question { system: &scene.system, start: &scene.start, equations: &equations, constants: &constants };
        let found = reference(&question, &[right.t], 1e-18).unwrap();
        let size = right.q.iter().fold(1.0, |a: f64, q| a.max(q.abs()));
        let distance = found.distance(0, &right.q);
        // in a metric in which no coordinate weighs more than 2
        let limit = 10.0 * right.rounding + 4.0 * f64::EPSILON * size;
        assert!(distance < limit, "{} {name} {}: {distance:.1e} {limit:.1e}", right.scene, right.t);
        met += 1;
    }
    assert_eq!(met, 18);
}

#[test]
fn what_a_run_is_wrong_by_is_read_off() {
    let scene = scene("sledge");
    let found = computed(&scene, "vakonomic", &times(10.0)).unwrap();
    let mut errors = Vec::new();
    for tolerance in [1e-6, 1e-9] {
        let settings = Settings { tolerance, ..Settings::default() };
        let mut motion = motion::solve_choice(&scene, &choice(&scene, "vakonomic"), &settings).unwrap();
        let at = |i: usize| found.distance(i, &motion.at(found.times[i]).unwrap().coordinates);
        errors.push((0..10).map(at).fold(0.0, f64::max));
    }
    println!("sledge, vakonomic: a run is wrong by {:.1e} and {:.1e}", errors[0], errors[1]);
    assert!(errors[0] < 1e-4 && errors[1] < 1e-2 * errors[0] && errors[1] > 1e-15);
}

#[test]
fn what_cannot_be_computed_is_refused() {
    let scene = scene("sledge");
    // the chart breaks where the blade points across the slope
    let stopped = computed(&scene, "removed constraint (along-x)", &[10.0]).unwrap_err();
    assert!(matches!(stopped, ReferenceError::Stopped { time, .. } if time < 10.0), "{stopped}");
    let times = computed(&scene, "Chetaev", &[2.0, 1.0]).unwrap_err();
    assert!(matches!(times, ReferenceError::Times { time: 1.0, start: 0.0 }), "{times}");

    let (equations, _) = asked(&scene, "vakonomic");
    let question = Question { system: &scene.system, start: &scene.start, equations: &equations, constants: &[] };
    let constants = reference(&question, &[1.0], 1e-20).unwrap_err();
    assert!(matches!(constants, ReferenceError::Constants { found: 0, expected: 1 }), "{constants}");

    let question = Question { constants: &[0.0], ..question };
    let in_f64 = reference_in::<f64>(&question, &[1.0], 1e-11).unwrap();
    assert!(in_f64.error() <= 1e-11);
    let not_reached = reference_in::<f64>(&question, &[1.0], 1e-17).unwrap_err();
    assert!(matches!(not_reached, ReferenceError::NotReached { error, .. } if error > 1e-17), "{not_reached}");

    let mut twice = scene.system.clone();
    twice.constraints.push(twice.constraints[0]);
    let singular = reference(&Question { system: &twice, ..question }, &[1.0], 1e-20).unwrap_err();
    assert!(matches!(singular, ReferenceError::Singular { .. }), "{singular}");

    let mut unknown = equations.clone();
    unknown.states[0].rate = unknown.graph.variable(unknown.graph.symbol("nobody"));
    let compile = reference(&Question { equations: &unknown, ..question }, &[1.0], 1e-20).unwrap_err();
    assert!(matches!(compile, ReferenceError::Compile(_)), "{compile}");

    let (removed, constants) = asked(&scene, "removed constraint (arc-length)");
    let mut off = scene.start.clone();
    off.v[0] += 1.0; // across the blade
    let question = Question { system: &scene.system, start: &off, equations: &removed, constants: &constants };
    let start = reference(&question, &[1.0], 1e-20).unwrap_err();
    assert!(matches!(start, ReferenceError::Start(StartError::RemovalStart { .. })), "{start}");
}
