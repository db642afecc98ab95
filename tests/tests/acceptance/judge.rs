//! Films with secret numbers: motions of each law, made by the formulations and by steppers written here, and
//! what the judge says of them. It shares with the formulations the curvature `C` and no equation of motion.

use deltaq::{Choice, Settings, choices, setting, solve_choice};
use judge::{Constraint, Film, Judgement, Law, judge};
use scene::Scene;

use super::support::scene;

/// Samples of a film.
const SAMPLES: usize = 601;

/// The film of a motion, the first part of a scene's run.
fn film(scene: &Scene, choice: &Choice, part: f64) -> String {
    let settings = Settings { tolerance: 1e-12, ..Settings::default() };
    let mut motion = solve_choice(scene, choice, &settings).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    let names: Vec<&str> = scene.system.coordinates.iter().map(|c| &c.name[..]).collect();
    let mut text = format!("t,{}\n", names.join(","));
    for k in 0..SAMPLES {
        let t = motion.start() + part * (motion.end() - motion.start()) * k as f64 / (SAMPLES - 1) as f64;
        let q: Vec<String> = motion.at(t).unwrap().coordinates.iter().map(|x| format!("{x:?}")).collect();
        text += &format!("{t:?},{}\n", q.join(","));
    }
    text
}

fn judged(scene: &Scene, text: &str) -> Judgement {
    let film = Film::read(text, &scene.system).unwrap_or_else(|e| panic!("{e}"));
    let found = judge(&scene.system, &film).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    println!("{}: {found:?}", scene.name);
    found
}

fn by_formulation(scene: &Scene, name: &str) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation.name == name).unwrap_or_else(|| panic!("no {name}"))
}

#[track_caller]
fn within(what: &str, found: f64, secret: f64, part: f64) {
    assert!((found - secret).abs() <= part * secret.abs(), "{what}: {found:e} for {secret:e}");
}

/// Scenes, parts of their runs, and secret numbers of the size that they show in.
const SECRETS: [(&str, f64, f64, f64); 5] = [
    ("sledge", 0.3, 0.013, 0.0021),
    ("turntable", 0.4, 0.0017, 0.00031),
    ("sleigh", 0.3, 0.007, 0.0011),
    ("ball-on-incline", 0.4, 0.004, 0.0009),
    ("trailer", 0.2, 0.003, 0.0007),
];

#[test]
fn chetaev_is_named_and_no_number_is_seen() {
    for (name, part, ..) in SECRETS {
        let scene = scene(name, &[]);
        let found = judged(&scene, &film(&scene, &by_formulation(&scene, "chetaev"), part));
        assert_eq!((&found.law, found.constraint), (&Law::Chetaev, Constraint::Kept), "{name}");
    }
}

#[test]
fn epsilon_and_slip_are_found_to_a_hundredth() {
    for (name, part, epsilon, slip) in SECRETS {
        for (epsilon, slip) in [(epsilon, 0.0), (0.0, slip), (-epsilon, slip)] {
            let scene = scene(name, &[("epsilon", epsilon), ("slip", slip)]);
            let found = judged(&scene, &film(&scene, &by_formulation(&scene, "first-order"), part));
            if epsilon != 0.0 {
                assert_eq!(found.law, Law::FirstOrder, "{name}");
                within(&format!("{name}, epsilon"), found.epsilon.value, epsilon, 0.01);
            } else {
                assert_eq!(found.law, Law::Chetaev, "{name}");
            }
            if slip != 0.0 {
                assert_eq!(found.constraint, Constraint::Creeps, "{name}");
                within(&format!("{name}, slip"), found.slip.value, slip, 0.01);
            } else {
                assert_eq!(found.constraint, Constraint::Kept, "{name}");
            }
        }
    }
}

#[test]
fn a_vakonomic_motion_is_named_with_its_multipliers() {
    for (name, part, ..) in SECRETS {
        let scene = scene(name, &[]);
        let choice = by_formulation(&scene, "vakonomic");
        let found = judged(&scene, &film(&scene, &choice, 0.5 * part));
        let Law::Vakonomic(mu) = &found.law else { panic!("{name}: {:?}", found.law) };
        for (mu, secret) in mu.iter().zip(&scene.multipliers) {
            assert!((mu - secret).abs() < 0.01 * secret.abs().max(0.01), "{name}: {mu} for {secret}");
        }
    }
}
