//! Every scene, and systems that nobody chose: discrete motions of order 8 come to the derived ones.

use discrete::{Composition, DiscreteError};
use integrate::Method;
use mechanics::ConstantsRule;
use motion::{
    Choice, Motion, REMOVED_CONSTRAINT, Settings, SolveError, Steps, VAKONOMIC, choices, solve_by_steps, solve_choice,
};
use random::{Case, Kind, draw_recipe};
use scene::Scene;
use scene::catalogue::{SCENES, find};

/// The horizon, s, at most, and the steps that the continuous motion may need for it: near the edge of a
/// chart (the ball in the cone after 0.4 s) time scales are a millisecond, which no grid knows.
const HORIZON: f64 = 0.5;
const OWN_STEPS: usize = 20;

/// Steps of a grid.
const GRIDS: [usize; 6] = [8, 16, 32, 64, 128, 256];

/// Times at which positions are compared; nodes of every grid.
const TIMES: usize = 8;

/// Largest difference over the size of the motion.
const LIMIT: f64 = 1e-12;

/// The seed of the systems (none of the other suites has it), and how many.
const SEED: u64 = 1788;
const SYSTEMS: u64 = 40;

/// Halves steps until the discrete motion is the given one; not so where its action is not of first order.
fn agrees(what: &str, scene: &Scene, choice: &Choice, motion: &mut Motion, limit: f64) -> bool {
    let own = motion.step_times();
    let span = own[OWN_STEPS.min(own.len() - 1)] - scene.start.t;
    let short = Scene { duration: span.clamp(-HORIZON, HORIZON), ..scene.clone() };
    let times: Vec<f64> = (1..=TIMES).map(|i| short.start.t + short.duration * i as f64 / TIMES as f64).collect();
    let mut nearest = f64::INFINITY;
    for count in GRIDS {
        let steps = Steps { step: short.duration.abs() / count as f64, composition: Composition::Eighth };
        let mut discrete = match solve_by_steps(&short, choice, steps, &Settings::default()) {
            Ok(discrete) if discrete.is_complete() => discrete,
            // forces are refused where the principle is a variational one
            Err(SolveError::Discrete(DiscreteError::Force { .. })) => return false,
            // the step is too long
            Ok(_) => continue,
            Err(SolveError::Discrete(DiscreteError::HighRate { .. })) => return false,
            Err(error) => panic!("{what}: {error}"),
        };
        let gap = times.iter().fold(0.0_f64, |worst, &t| {
            let [found, known] = [&mut discrete, &mut *motion].map(|m| m.at(t).unwrap().coordinates);
            found.iter().zip(&known).fold(worst, |worst, (a, b)| worst.max((a - b).abs() / b.abs().max(1.0)))
        });
        nearest = nearest.min(gap);
        if gap < limit {
            println!("{what:<72} {gap:.1e} with {count} steps, limit {limit:.0e}");
            return true;
        }
    }
    panic!("{what}: the discrete motion stays {nearest:.3e} away, limit {limit:.0e}");
}

fn given(choice: &Choice, constants: &[f64]) -> Choice {
    Choice { constants: ConstantsRule::Given(constants.to_vec()), ..choice.clone() }
}

#[test]
fn discrete_motions_come_to_those_of_every_scene() {
    let mut measured = 0;
    let back = ("sledge", -1.0);
    for (name, sign) in SCENES.iter().map(|(name, _)| (*name, 1.0)).chain([back]) {
        let found = find(name, &[]).unwrap();
        let scene = Scene { duration: sign * found.duration.min(HORIZON), ..found };
        let some: Vec<f64> = (0..scene.system.constraints.len()).map(|i| [0.4, -0.3, 0.2, -0.1][i % 4]).collect();
        let choices = choices(&scene).into_iter().flat_map(|choice| match choice.formulation {
            own if own == VAKONOMIC => vec![given(&choice, &some), choice],
            _ => vec![choice],
        });
        for choice in choices {
            let what = format!("{name}, {}, {:?}", choice.label, choice.constants);
            let settings = Settings { tolerance: 1e-12, method: Some(Method::Dop853), ..Settings::default() };
            // by-heading of appell-hamel and the paper's of the cylinders have no regular equations
            let Ok(mut motion) = solve_choice(&scene, &choice, &settings) else { continue };
            let choice = given(&choice, &motion.constants.clone());
            measured += usize::from(agrees(&what, &scene, &choice, &mut motion, LIMIT));
        }
    }
    assert!(measured >= 75, "{measured} motions");
}

#[test]
fn discrete_motions_come_to_those_of_random_systems() {
    let mut measured = 0;
    for index in 0..SYSTEMS {
        let recipe = draw_recipe(SEED, index, &Kind::ALL);
        let name = format!("random {index}, {}", recipe.kind);
        let Case { scene, floor, mut chetaev, mut vakonomic, removed, .. } =
            Case::new(recipe, &name).unwrap_or_else(|e| panic!("{name}: {e}"));
        let limit = (100.0 * floor).max(1e-10);
        let choices = choices(&scene);
        let mut check = |choice: &Choice, constants: &[f64], motion: &mut Motion| {
            let what = format!("{name}, {}", choice.label);
            measured += usize::from(agrees(&what, &scene, &given(choice, constants), motion, limit));
        };
        check(&choices[0], &[], &mut chetaev);
        check(&choices[1], &scene.multipliers, &mut vakonomic);
        for mut r in removed {
            let choice = Choice {
                label: r.removal.name.clone(),
                formulation: REMOVED_CONSTRAINT,
                removal: Some(r.removal),
                constants: ConstantsRule::Zero,
            };
            check(&choice, &r.motion.constants.clone(), &mut r.motion);
        }
    }
    assert!(measured >= 140, "{measured} motions");
}
