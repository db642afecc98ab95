//! Motions by the project's own integrator, which knows no regression: the law is named, its numbers found.

use deltaq::{Choice, FIRST_ORDER, Motion, Settings, VAKONOMIC, choices, solve_choice};
use judge::{Judgement, Law, Number, Samples, judge};
use mechanics::Parameter;
use scene::Scene;

const SCENES: [&str; 4] = ["sledge", "disc", "turntable", "sleigh"];

fn scene(name: &str) -> Scene {
    let mut scene = catalogue::find(name, &[]).unwrap();
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
        system.parameters.push(Parameter { symbol, value });
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
