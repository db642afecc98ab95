//! Motions by the project's own integrator, which knows no regression: the law is named, its numbers found.

use judge::{Judgement, Law, Number, Samples, judge};
use mechanics::Parameter;
use motion::{CHETAEV, Choice, FIRST_ORDER, Motion, Settings, VAKONOMIC, choices, solve_choice};
use scene::Scene;

const SCENES: [&str; 4] = ["sledge", "disc", "turntable", "sleigh"];

fn scene(name: &str) -> Scene {
    let mut scene = scene::catalogue::find(name, &[]).unwrap();
    scene.duration = 4.0;
    scene
}

fn samples(motion: &mut Motion, until: f64) -> Samples {
    let t: Vec<f64> = (0..=400).map(|i| f64::from(i) / 400.0 * until).collect();
    let rows: Vec<_> = t.iter().map(|&t| motion.at(t).unwrap()).collect();
    let q = rows.iter().map(|r| r.coordinates.clone()).collect();
    Samples { t, q, v: Some(rows.into_iter().map(|r| r.velocities).collect()) }
}

/// A motion by the law of first order, with a drag that the judge's scene does not have.
fn first_order(name: &str, epsilon: f64, slip: f64, drag: f64) -> Judgement {
    let plain = scene(name);
    let mut made = plain.clone();
    let system = &mut made.system;
    for (name, value) in [("epsilon", epsilon), ("slip", slip)] {
        let symbol = system.graph.symbol(name);
        system.parameters.push(Parameter { symbol, value, formula: None });
    }
    let (g, v) = (system.graph.clone(), system.velocities());
    let momenta = g.mat_vec(&system.velocity_hessian(), &g.variables(&v));
    for (force, p) in system.forces.iter_mut().zip(momenta) {
        *force = g.sub(*force, g.mul(g.number(drag), p));
    }
    system.graph = g;
    let choice = chosen(&made, FIRST_ORDER);
    let mut motion = solve_choice(&made, &choice, &Settings::default()).unwrap();
    judge(&plain, &samples(&mut motion, 4.0), 0.01).unwrap()
}

fn chosen(scene: &Scene, formulation: &'static equations::Formulation) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation == formulation).unwrap()
}

/// Within one percent, or three errors of zero.
fn close(what: &str, secret: f64, found: Option<Number>) {
    let found = found.unwrap_or_else(|| panic!("{what}: nothing found"));
    println!("{what}: secret {secret:.6e}, found {:.6e} ± {:.1e}", found.value, found.error);
    let limit = if secret == 0.0 { 3.0 * found.error + 1e-12 } else { 0.01 * secret.abs() };
    assert!((found.value - secret).abs() <= limit, "{what}: {found:?} for {secret}");
}

#[test]
fn numbers_of_sixteen_motions_of_first_order_are_found_within_one_percent() {
    let secrets = [(0.0, 0.0, 0.0), (3.1e-3, 0.0, 0.0), (0.0, 7.3e-3, 0.021), (-2.3e-3, 4.1e-3, 0.013)];
    for name in SCENES {
        for (epsilon, slip, drag) in secrets {
            let found = first_order(name, epsilon, slip, drag);
            println!("{name}: {:?}, of {:?}, noise {:.1e}", found.fitting, found.laws, found.noise);
            assert_eq!(found.law(), Some(Law::Chetaev), "{name} {epsilon} {slip} {drag}");
            close(&format!("{name} slip"), slip, found.slip);
            close(&format!("{name} epsilon"), epsilon, found.epsilon);
            close(&format!("{name} drag"), drag, found.drag);
        }
    }
}

#[test]
fn vakonomic_motions_are_named() {
    for name in SCENES {
        let mut scene = scene(name);
        scene.duration = 2.0;
        scene.multipliers = scene.multipliers.iter().enumerate().map(|(i, _)| 0.3 + 0.2 * i as f64).collect();
        let mut motion = solve_choice(&scene, &chosen(&scene, VAKONOMIC), &Settings::default()).unwrap();
        let found = judge(&scene, &samples(&mut motion, 2.0), 0.01).unwrap();
        println!("{name}: {:?}, of {:?}, noise {:.1e}", found.fitting, found.laws, found.noise);
        assert_eq!(found.fitting, [Law::Vakonomic], "{name}");
    }
}

#[test]
fn a_constraint_put_into_the_lagrangian_is_named() {
    // the fall line is across the parameter x, so that L contains the memory variable y
    for slope in [0.7, -1.3] {
        let text = format!(
            r#"
            title = "Sledge across"
            [coordinates]
            x = {{ unit = "m", start = 0 }}
            y = {{ unit = "m", start = 0 }}
            phi = {{ unit = "rad", start = 0.3 }}
            [system]
            lagrangian = "(x'^2 + y'^2 + phi'^2)/2 + {slope}*y"
            constraints = ["y'*cos(phi) - x'*sin(phi)"]
            [start]
            velocities = {{ "x'" = 0.5, "phi'" = 0.4 }}
            [removal.along-x]
            parameters = ["x", "phi"]
            rates = {{ y = "x'*tan(phi)" }}
            constants = "zero"
            [run]
            duration = 1
            "#
        );
        let scene = Scene::parse("across", &text).unwrap();
        let run = review::substitution::run(&scene, &choices(&scene), &Settings::default()).unwrap();
        let found = judge(&scene, &samples(&mut run.outcome.unwrap(), 1.0), 0.01).unwrap();
        println!("{:?}, of {:?}, noise {:.1e}", found.fitting, found.laws, found.noise);
        assert_eq!(found.fitting, [Law::Substitution]);
    }
}

#[test]
fn where_the_lagrangian_has_no_memory_variable_substitution_is_a_vakonomic_motion() {
    let mut scene = scene("sleigh");
    scene.duration = 0.4;
    let all: Vec<Choice> = choices(&scene)
        .into_iter()
        .filter(|c| {
            let plain = |r: &mechanics::Removal| r.parameters.iter().all(|u| u.coordinate.is_some());
            c.removal.as_ref().is_some_and(plain)
        })
        .collect();
    let run = review::substitution::run(&scene, &all, &Settings::default()).unwrap();
    let found = judge(&scene, &samples(&mut run.outcome.unwrap(), 0.4), 0.01).unwrap();
    assert_eq!(found.fitting, [Law::Vakonomic, Law::Substitution], "{:?}", found.laws);
}

/// Chetaev's motions of twelve scenes with one number 5 % off: the number is named, or no number of a law is.
#[test]
fn a_number_that_is_off_is_named_and_gives_no_number_of_a_law() {
    let (mut asked, mut named) = (0, 0);
    for (name, number) in [
        ("sledge", "g"),
        ("sledge", "alpha"),
        ("sledge", "k"),
        ("disc", "m"),
        ("disc", "I"),
        ("disc", "J"),
        ("turntable", "Omega"),
        ("turntable", "k2"),
        ("sleigh", "a"),
        ("sleigh", "I"),
        ("sleigh", "J"),
        ("sleigh", "m"),
        ("velocity-pendulum", "g"),
        ("nonholonomic-oscillator", "k"),
        ("unicycle-in-potential", "k"),
        ("turning-knife-edge", "Omega"),
    ] {
        let Ok(plain) = scene::catalogue::find(name, &[]) else { continue };
        let g = &plain.system.graph;
        let mut made = plain.clone();
        made.duration = 4.0;
        let Some(p) = made.system.parameters.iter_mut().find(|p| g.name(p.symbol) == number && p.value != 0.0) else {
            continue;
        };
        p.value *= 1.05;
        let Ok(mut motion) = solve_choice(&made, &chosen(&made, CHETAEV), &Settings::default()) else { continue };
        let Ok(found) = judge(&plain, &samples(&mut motion, 4.0), 0.01) else { continue };
        asked += 1;
        println!(
            "{name} {number}: {:?}, misfits {:?}, ε {:?}, drag {:?}",
            found.fitting, found.misfits, found.epsilon, found.drag
        );
        for n in [found.epsilon, found.drag].into_iter().flatten() {
            assert!(n.value.abs() <= 3.0 * n.error + 1e-9, "{name} {number}: {n:?}");
        }
        named += usize::from(found.misfits.iter().any(|m| m.name == number && (m.by.value - 0.05).abs() < 3e-3));
    }
    assert!(asked >= 12 && named >= 6, "{named} of {asked}");
}

/// `mu0` is that of the first sample.
#[test]
fn multipliers_are_those_of_the_start() {
    let mut scene = scene("sledge");
    scene.multipliers = vec![0.5];
    let mut motion = solve_choice(&scene, &chosen(&scene, VAKONOMIC), &Settings::default()).unwrap();
    let samples = samples(&mut motion, 2.0);
    let coarse: Vec<usize> = (0..samples.t.len()).step_by(4).collect();
    let of = |rows: &[Vec<f64>]| coarse.iter().map(|&i| rows[i].clone()).collect();
    let t = coarse.iter().map(|&i| samples.t[i]).collect();
    let samples = Samples { t, q: of(&samples.q), v: samples.v.as_ref().map(|v| of(v)) };
    let found = judge(&scene, &samples, 0.01).unwrap();
    let with = &found.laws.iter().find(|l| l.law == Law::Vakonomic).unwrap().with;
    let mu: f64 = with.trim_start_matches("mu0_1 = ").parse().unwrap();
    assert!((mu - 0.5).abs() < 1e-4, "{with}");
}
