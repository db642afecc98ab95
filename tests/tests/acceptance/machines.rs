//! Built-in scenes of bodies against formulas that were written by hand.

use comparison::{Beyond, beyond_contacts};
use mechanics::{ConstantsRule, State};
use motion::{CHETAEV, REMOVED_CONSTRAINT, Settings, VAKONOMIC, solve_choice};
use nalgebra::{DMatrix, DVector};
use scene::Scene;
use symbolic::SplitMix;

use super::support::{choice, gap, must, tight, values};

macro_rules! by_hand {
    ($($name:literal)*) => { [$(($name, include_str!(concat!("../scenes/by-hand/", $name, ".toml")))),*] };
}

/// Built-in scenes of bodies, and their definitions and `[system]` by hand.
const MACHINES: [(&str, &str); 30] = by_hand!(
    "ball-in-cone" "ball-in-cylinder" "ball-on-incline" "bicycle" "bowl" "chaplygin-sphere" "coin-on-incline" "disc"
    "falling-disc" "mobile-robot" "one-motor-robot" "parallel-velocities" "planar-body" "roller-racer" "routh-sphere"
    "rubber-ball" "rubber-chaplygin-sphere" "rudder-skate" "servo-pendulum" "sledge" "sledge-with-friction" "sleigh"
    "snakeboard" "suslov" "trailer" "turning-knife-edge" "turntable" "unicycle-in-potential"
    "velocity-pendulum" "veselova"
);

/// A built-in scene with formulas by hand instead of its bodies and picture.
pub(crate) fn with_formulas(name: &str, by_hand: &str) -> String {
    const BODIES: [&str; 8] = ["definitions", "system", "view", "body", "contact", "spring", "damper", "motor"];
    let mut kept = String::new();
    let mut skips = false;
    for line in source(name).lines() {
        if let Some(header) = line.strip_prefix('[') {
            skips = BODIES.iter().any(|section| header.starts_with(section));
        }
        if !skips && !line.starts_with("gravity") {
            // formulas by hand have rates of what bodies constrain, and supply no coordinate
            kept += &format!("{}\n", line.replace("guess = 0 }", "start = 0 }"));
        }
    }
    format!("{kept}{by_hand}")
}

fn source(name: &str) -> String {
    scene::catalogue::source(name).unwrap_or_else(|e| panic!("{e}"))
}

pub(crate) fn parsed(text: &str) -> Scene {
    Scene::parse("bodies", text).unwrap_or_else(|e| panic!("{e}"))
}

/// A state near that of the start, on no constraint.
fn random_state(scene: &Scene, random: &mut SplitMix) -> State {
    let mut near = |x: &f64| x + 0.4 * (random.unit() - 0.5);
    let q = scene.start.q.iter().map(&mut near).collect();
    let v = scene.start.v.iter().map(&mut near).collect();
    let mut state = State { t: scene.start.t + near(&0.5), q, v };
    // formulas by hand use that constraints on positions hold
    let (g, watched) = (&scene.system.graph, scene.system.watched.iter());
    let positions = watched.filter(|w| w.name.starts_with("constraint ")).map(|w| w.expression).collect::<Vec<_>>();
    for _ in 0..if positions.is_empty() { 0 } else { 40 } {
        let jacobian = g.jacobian(&positions, &scene.system.positions());
        let jacobian = DMatrix::from_row_slice(positions.len(), state.q.len(), &of(scene, &state, jacobian.entries()));
        let inverse = jacobian.pseudo_inverse(1e-9).unwrap_or_else(|e| panic!("{e}"));
        let step = inverse * DVector::from(of(scene, &state, &positions));
        state.q.iter_mut().zip(step.iter()).for_each(|(q, step)| *q -= step);
    }
    state
}

fn of(scene: &Scene, state: &State, expressions: &[symbolic::Expr]) -> Vec<f64> {
    let (g, values) = (&scene.system.graph, values(&scene.system, state));
    expressions.iter().map(|&e| g.evaluate(e, &values).unwrap_or_else(|e| panic!("{e}"))).collect()
}

/// `∂f/∂v`, a row per constraint.
fn rows(scene: &Scene, state: &State) -> DMatrix<f64> {
    let g = &scene.system.graph;
    let matrix = g.jacobian(&scene.system.constraints, &scene.system.velocities());
    DMatrix::from_row_slice(matrix.rows(), matrix.columns(), &of(scene, state, matrix.entries()))
}

/// L up to a constant, `f` up to an invertible matrix, Q: all that any formulation is given.
#[track_caller]
pub(crate) fn same_system(title: &str, by_hand: &Scene, scene: &Scene) {
    assert_eq!(by_hand.start.q, scene.start.q, "{title}");
    let random = &mut SplitMix::new(76);
    let at_start = |scene: &Scene| of(scene, &by_hand.start, &[scene.system.lagrangian])[0];
    let shift = at_start(scene) - at_start(by_hand);
    let (mut of_l, mut of_f, mut of_q) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..20 {
        let state = random_state(scene, random);
        let l = [by_hand, scene].map(|scene| of(scene, &state, &[scene.system.lagrangian])[0]);
        of_l = of_l.max((l[1] - l[0] - shift).abs() / l[0].abs().max(1.0));
        let q = [by_hand, scene].map(|scene| of(scene, &state, &scene.system.forces));
        of_q = q[0].iter().zip(&q[1]).map(|(a, b)| (a - b).abs()).fold(of_q, f64::max);
        let [a, b] = [by_hand, scene].map(|scene| rows(scene, &state).transpose());
        assert_eq!(a.ncols(), b.ncols(), "{title}: constraints");
        if a.ncols() == 0 {
            continue;
        }
        let f = [by_hand, scene].map(|scene| DVector::from(of(scene, &state, &scene.system.constraints)));
        let matrix = (b.transpose() * &b).lu().solve(&(b.transpose() * &a)).unwrap_or_else(|| panic!("{title}: rank"));
        assert!(matrix.determinant().abs() > 1e-6, "{title}: not the same rank");
        let size = a.amax().max(1.0);
        of_f = of_f.max((&b * &matrix - a).amax() / size).max((matrix.transpose() * &f[1] - &f[0]).amax() / size);
    }
    must(&format!("{title}: L at random states"), of_l, 1e-12);
    must(&format!("{title}: f at random states"), of_f, 1e-12);
    must(&format!("{title}: Q at random states"), of_q, 1e-12);
}

#[test]
fn bodies_give_lagrangian_and_constraints_by_hand() {
    for (name, by_hand) in MACHINES {
        let scene = parsed(&source(name));
        assert!(scene.meant.is_some(), "{name} has no bodies");
        same_system(name, &parsed(&with_formulas(name, by_hand)), &scene);
    }
}

#[test]
fn the_scene_of_formulas_is_the_same_system() {
    for (name, _) in MACHINES {
        let scene = parsed(&source(name));
        let formulas = scene.meant.as_ref().map(|meant| meant.formulas.clone()).unwrap_or_default();
        assert!(!formulas.contains("[body"), "{name}");
        let again = parsed(&formulas);
        assert!(again.meant.is_none(), "{name}");
        let plain = |s: &Scene| {
            let all = [&[s.system.lagrangian], &s.system.constraints[..], &s.system.forces].concat();
            all.iter().map(|&e| s.system.graph.plain(e)).collect::<Vec<_>>()
        };
        assert_eq!(plain(&again), plain(&scene), "{name}");
        assert_eq!(again.start, scene.start, "{name}");
        assert_eq!(again.view.bodies.len(), scene.view.bodies.len(), "{name}");
    }
}

#[test]
fn bodies_move_as_formulas_by_hand_in_every_formulation() {
    let settings = Settings { max_steps: 40_000, ..tight() };
    for (name, by_hand) in MACHINES {
        let set = [("duration".to_string(), 0.3)];
        let read = |text: &str| Scene::parse_with("scene", text, &set).unwrap_or_else(|e| panic!("{name}: {e}"));
        let by_hand = read(&with_formulas(name, by_hand));
        let scene = read(&source(name));
        let h = by_hand.system.constraints.len();
        // multipliers belong to constraints as they are written: μ₀ = 0 says the same of both
        let mut choices = vec![
            choice(CHETAEV, None, ConstantsRule::Given(Vec::new())),
            choice(VAKONOMIC, None, ConstantsRule::Given(vec![0.0; h])),
        ];
        let removals = by_hand.removals.iter();
        choices.extend(removals.map(|r| choice(REMOVED_CONSTRAINT, Some(r), r.constants.clone())));
        for (k, by_hand_choice) in choices.iter().enumerate() {
            let mut own = by_hand_choice.clone();
            own.removal = k.checked_sub(2).map(|r| scene.removals[r].clone());
            let [mut one, mut two] = [(&by_hand, by_hand_choice), (&scene, &own)].map(|(scene, choice)| {
                let motion = solve_choice(scene, choice, &settings).unwrap_or_else(|e| panic!("{name}: {e}"));
                assert!(motion.is_complete(), "{name}: {:?}", motion.ending);
                motion
            });
            let (apart, end) = gap(&mut one, &mut two);
            must(&format!("{name}, {}, over {end} s", own.label), apart, 1e-11);
        }
    }
}

#[test]
fn built_in_scenes_are_not_remarkable() {
    for (name, text) in scene::catalogue::GROUPS.into_iter().flat_map(|(_, group)| group) {
        let (_, remarks) = Scene::remarks::<f64>(name, text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let slips = |remark: &scene::SceneError| remark.to_string().contains("the contact of `ball` slips on `cone`");
        match *name {
            "ball-in-cone-as-printed" => assert!(remarks.len() == 1 && slips(&remarks[0]), "{remarks:?}"),
            _ => assert!(remarks.is_empty(), "{remarks:?}"),
        }
    }
}

/// Multipliers are forces of contacts: Newton's and Euler's equations by hand, with the reaction as unknown.
#[test]
fn multipliers_are_the_forces_of_the_ground() {
    let reactions = |name: &str, set: &[(&str, f64)]| -> (State, Vec<f64>) {
        let set: Vec<_> = set.iter().chain(&[("duration", 0.1)]).map(|&(name, x)| (name.to_string(), x)).collect();
        let scene = Scene::parse_with("scene", &source(name), &set).unwrap_or_else(|e| panic!("{e}"));
        let rows = scene.meant.as_ref().map(|meant| meant.constraints.len()).unwrap_or_default();
        let chetaev = choice(CHETAEV, None, ConstantsRule::Given(Vec::new()));
        let mut motion = solve_choice(&scene, &chetaev, &tight()).unwrap_or_else(|e| panic!("{e}"));
        let now = motion.at(scene.start.t).unwrap_or_else(|e| panic!("{e}"));
        (scene.start, now.multipliers.into_iter().take(rows).collect())
    };
    let near = |what: &str, found: &[f64], expected: &[f64]| {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        must(&format!("{what}: force of the contact"), off / size, 1e-12);
    };
    // a homogeneous ball on an incline is held back by 2/7 of its weight's pull
    let (_, found) = reactions("ball-on-incline", &[("m", 1.4)]);
    near("ball on incline", &found, &[-2.0 / 7.0 * 1.4 * 9.81 * 0.3, 0.0]);
    let (pull, normal) = (found[0].hypot(found[1]), 1.4 * 9.81 * 0.3_f64.asin().cos());
    must("ball on incline: friction needed", (pull / normal - 2.0 / 7.0 * 0.3_f64.asin().tan()).abs(), 1e-12);
    // the bicycle stands upright: moments of its weights about where the rear wheel touches
    let (_, found) = reactions("bicycle", &[("v", 0.0)]);
    near("bicycle", &found[4..], &[9.81 * (85.0 * 0.3 + 4.0 * 0.9 + 3.0 * 1.02) / 1.02]);
    // a rattleback at rest in its equilibrium carries its weight
    let (_, found) = reactions("rattleback", &[("psi'", 0.0), ("alpha'", 0.0), ("beta'", 0.0)]);
    near("rattleback", &found, &[0.0, 0.0, 9.81]);
    // the centre of the upright disc runs on a circle: m v phi' across, along x and y
    let (State { q, v, .. }, found) = reactions("disc", &[]);
    let across = 0.5 * v[2] * v[3];
    near("disc", &found, &[-across * q[3].sin(), across * q[3].cos()]);
    // on an incline the pull across is held, and (m + I/R²) v' = m g s cos(phi) along
    let (State { q, v, .. }, found) = reactions("coin-on-incline", &[]);
    let pull = 9.81 * 0.6;
    let (along, across) = (-pull * q[3].cos() / 3.0, 0.5 * v[2] * v[3] + pull * q[3].sin());
    let (sin, cos) = q[3].sin_cos();
    near("coin on incline", &found, &[along * cos - across * sin, along * sin + across * cos]);
    let (State { q, v, .. }, found) = reactions("sledge", &[]);
    near("sledge", &found, &[v[0].hypot(v[1]) * v[2] + 9.81 * 0.4_f64.sin() * q[2].sin()]);
    // (I + m a²) phi'' = -m a v phi', and m (v phi' + a phi'') across
    let (State { q, v, .. }, found) = reactions("sleigh", &[]);
    let speed = v[0] * q[2].cos() + v[1] * q[2].sin();
    near("sleigh", &found, &[speed * v[2] * (1.0 - 0.16 / 0.46)]);
    let (State { q, v, .. }, found) = reactions("unicycle-in-potential", &[]);
    let across = 0.9 * (q[1] * q[2].cos() - q[0] * q[2].sin());
    near("unicycle", &found, &[v[0].hypot(v[1]) * v[2] + across]);
    // a circle at 2/7 of the table's rate
    let (_, found) = reactions("turntable", &[]);
    near("turntable", &found, &[-(0.2_f64).powi(2) * 0.6, 0.0]);
}

/// What turns a vakonomic disc and sledge is `C μ`, and no contact has it; Chetaev's reactions are forces of
/// contacts.
#[test]
fn vakonomic_torques_are_none_of_contacts() {
    for (name, coordinate) in [("disc", "psi"), ("sledge", "phi")] {
        let scene = Scene::parse_with("scene", &source(name), &[("duration".to_string(), 1.0)]);
        let scene = scene.unwrap_or_else(|e| panic!("{e}"));
        let h = scene.system.constraints.len();
        let motion = |formulation, constants| {
            let motion = solve_choice(&scene, &choice(formulation, None, ConstantsRule::Given(constants)), &tight());
            motion.unwrap_or_else(|e| panic!("{e}"))
        };
        let chetaev = beyond_contacts(&scene, &mut motion(CHETAEV, Vec::new()));
        assert_eq!(chetaev.unwrap_or_else(|e| panic!("{e}")), None, "{name}");
        let mut vakonomic = motion(VAKONOMIC, vec![0.3; h]);
        let found = beyond_contacts(&scene, &mut vakonomic).unwrap_or_else(|e| panic!("{e}"));
        let Beyond { coordinate: along, force, t } = found.unwrap_or_else(|| panic!("{name}: nothing"));
        assert_eq!(along, coordinate, "{name}");
        // across: f = -x' sin(phi) + y' cos(phi); C couples the turn with what is along, by f's multiplier
        let now = vakonomic.at(t).unwrap_or_else(|e| panic!("{e}"));
        let rate = match name {
            "disc" => 0.5 * now.velocities[3],
            _ => now.velocities[0].hypot(now.velocities[1]),
        };
        let across = match name {
            "disc" => now.multipliers[1] * now.coordinates[3].cos() - now.multipliers[0] * now.coordinates[3].sin(),
            _ => now.multipliers[0],
        };
        let torque = (across * rate).abs();
        must(&format!("{name}: torque of {torque:.3} at {t:.2}"), (force.abs() - torque).abs() / torque, 1e-8);
    }
}
