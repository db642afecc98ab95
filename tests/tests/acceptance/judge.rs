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
    for ((name, part, ..), start) in SECRETS.into_iter().flat_map(|scene| [0.0, 1.0].map(|start| (scene, start))) {
        // a small ball moves violently
        let start = if ["sledge", "sleigh"].contains(&name) { 0.37 * start } else { 0.01 * start };
        let scene = scene(name, &[("mu0_1", start)]);
        let choice = by_formulation(&scene, "vakonomic");
        let found = judged(&scene, &film(&scene, &choice, 0.5 * part));
        let Law::Vakonomic(mu) = &found.law else { panic!("{name}: {:?}", found.law) };
        for (mu, secret) in mu.iter().zip(&scene.multipliers) {
            assert!((mu - secret).abs() < 0.01 * secret.abs().max(0.01), "{name}: {mu} for {secret}");
        }
    }
}

/// A mass on a slope of direction x, a blade at it, unit mass and inertia: `L = (x'² + y'² + φ'²)/2 + x`.
fn scene_text() -> String {
    "title = \"Blade\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nphi = { start = 0.3 }\n\
                [system]\nlagrangian = \"(x'^2 + y'^2 + phi'^2)/2 + x\"\nconstraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n\
                [start.velocities]\n\"x'\" = \"cos(phi)/2\"\n\"phi'\" = 0.7\n[run]\nduration = 2\n"
        .into()
}

fn blade() -> Scene {
    Scene::parse("blade", &scene_text()).unwrap()
}

/// Its film by 4th-order steps of `(x, y, φ, x', y', φ')` with these accelerations.
fn stepped(accelerations: impl Fn(&[f64; 6]) -> [f64; 3]) -> String {
    let rates = |y: &[f64; 6]| {
        let a = accelerations(y);
        [y[3], y[4], y[5], a[0], a[1], a[2]]
    };
    let moved = |y: &[f64; 6], k: &[f64; 6], h: f64| -> [f64; 6] { std::array::from_fn(|i| y[i] + h * k[i]) };
    let (mut y, h) = ([0.0, 0.0, 0.3, 0.5 * 0.3_f64.cos(), 0.5 * 0.3_f64.sin(), 0.7], 0.0005);
    let mut text = String::from("t,x,y,phi\n");
    for step in 0..=4000 {
        if step % 10 == 0 {
            text += &format!("{:?},{:?},{:?},{:?}\n", h * f64::from(step), y[0], y[1], y[2]);
        }
        let k1 = rates(&y);
        let k2 = rates(&moved(&y, &k1, h / 2.0));
        let k3 = rates(&moved(&y, &k2, h / 2.0));
        let k4 = rates(&moved(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    text
}

/// `A = (−sin φ, cos φ, 0)`; `λ` from `A a = −part · Ȧ v − stiffness f`.
fn with(part: f64, pulled: f64, drag: f64) -> impl Fn(&[f64; 6]) -> [f64; 3] {
    move |&[_, _, phi, vx, vy, turn]| {
        let (s, c) = phi.sin_cos();
        let (f, moved) = (vy * c - vx * s, -turn * (vy * s + vx * c));
        let free = [1.0 - drag * vx, -drag * vy, -drag * turn];
        let lambda = -part * moved - pulled * f - (free[1] * c - free[0] * s);
        [free[0] - lambda * s, free[1] + lambda * c, free[2]]
    }
}

#[test]
fn drag_and_what_a_program_leaves_out_are_found() {
    let scene = blade();
    let found = judged(&scene, &stepped(with(1.0, 0.0, 0.0)));
    assert_eq!((&found.law, found.constraint), (&Law::Chetaev, Constraint::Kept));
    for drag in [0.037, -0.004] {
        let found = judged(&scene, &stepped(with(1.0, 0.0, drag)));
        assert_eq!((&found.law, found.constraint), (&Law::FirstOrder, Constraint::Kept));
        within("drag", found.drag.value, drag, 0.01);
        assert!(!found.epsilon.is_seen(5.0) || found.epsilon.value.abs() < 1e-9, "{:?}", found.epsilon);
    }
    // A a = 0
    let found = judged(&scene, &stepped(with(0.0, 0.0, 0.0)));
    assert_eq!((&found.law, found.constraint), (&Law::Chetaev, Constraint::LeftOut));
    within("b", found.moved[0].value, 1.0, 1e-6);
    // and pulled back, as Baumgarte has it
    let found = judged(&scene, &stepped(with(0.0, 5.0, 0.0)));
    assert_eq!(found.constraint, Constraint::LeftOut);
    within("alpha", found.moved[1].value, 5.0, 1e-4);
}

#[test]
fn a_constraint_put_into_the_lagrangian_is_named() {
    let scene = blade();
    for (name, eliminated) in [("x", "y'"), ("y", "x'")] {
        let (other, by) = if name == "x" { ("y", "x'*tan(phi)") } else { ("x", "y'/tan(phi)") };
        let text = format!("[removal.only]\nparameters = [\"{name}\", \"phi\"]\nrates = {{ {other} = \"{by}\" }}\n");
        let with_removal = Scene::parse("blade", &(scene_text() + &text)).unwrap();
        let removal = with_removal.removals[0].clone();
        let choice = Choice { removal: Some(removal), ..by_formulation(&with_removal, "removed-constraint") };
        let choice = Choice { formulation: &substitution::SUBSTITUTION, ..choice };
        let found = judged(&scene, &film(&with_removal, &choice, 0.4));
        assert_eq!(found.law, Law::Substitution(vec![eliminated.into()]));
    }
}

#[test]
fn films_that_are_none_are_refused_with_their_line() {
    let system = blade().system;
    let refused = |text: &str| Film::read(text, &system).err().map(|e| e.to_string()).unwrap_or_default();
    assert_eq!(refused("t,x,y\n"), "line 1: no column is called `phi`: the columns are t, x, y");
    assert_eq!(refused("t,x,y,phi\n0,0,0,oops\n"), "line 2: `oops` in column phi is no number");
    assert_eq!(refused("t,x,y,phi\n0,0,0,0\n0,0,0,0\n"), "line 3: t = 0 does not come after 0");
    assert_eq!(refused("t,x,y,phi\n0,0,0,0\n"), "line 2: 1 samples, 18 are needed");
}
