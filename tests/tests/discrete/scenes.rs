//! The built-in scenes.

use deltaq::{Choice, Motion, Settings, choices, solve_choice};
use mechanics::ConstantsRule;
use referees::discrete::{Discrete, Ends, RemovedStart};
use scene::Scene;
use validation::catalogue::{SCENES, find};

use super::support::{HORIZON, Tally, agrees, costates, measure, removed, short};

/// What the extrapolated motion may differ by.
const LIMIT: f64 = 1e-12;

/// The same, where `P(t₀)` is itself found by shooting.
const NATURAL_LIMIT: f64 = 1e-11;

/// `t₁ − t₀` with `P(t₁) = 0`, s.
const NATURAL_HORIZON: f64 = 0.1;

fn scenes() -> Vec<Scene> {
    let found = SCENES.iter().map(|(name, _)| find(name, &[]).unwrap_or_else(|e| panic!("{e}")));
    found.map(|scene| Scene { duration: scene.duration.min(HORIZON), ..scene }).collect()
}

/// The motion of a choice up to the end.
fn motion(scene: &Scene, choice: &Choice) -> Motion {
    let settings = Settings { tolerance: 1e-12, ..Settings::default() };
    let motion = solve_choice(scene, choice, &settings).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
    assert!(motion.is_complete(), "{}: {:?}", scene.name, motion.ending);
    motion
}

fn choice(scene: &Scene, formulation: &str) -> Choice {
    let found = choices(scene).into_iter().find(|c| c.formulation == formulation);
    found.unwrap_or_else(|| panic!("{} has no {formulation}", scene.name))
}

#[test]
fn discrete_lagrange_dalembert_tends_to_chetaev() {
    let mut tally = Tally::default();
    for scene in scenes() {
        let mut motion = motion(&scene, &choice(&scene, "chetaev"));
        let discrete = Discrete::chetaev(&scene.system, &scene.start, short(&motion));
        let found = measure(&scene.name, discrete, &mut motion);
        agrees(&scene.name, &found, LIMIT, &mut tally);
    }
    tally.say("Chetaev, scenes");
    assert!(tally.measured() >= 9);
}

#[test]
fn stationary_discrete_action_tends_to_the_vakonomic_motion() {
    let mut tally = Tally::default();
    for scene in scenes() {
        let some = (0..scene.system.constraints.len()).map(|i| [0.4, -0.3, 0.2, -0.1][i % 4]).collect();
        for multipliers in [scene.multipliers.clone(), some] {
            let constants = ConstantsRule::Given(multipliers.clone());
            let mut motion = motion(&scene, &Choice { constants, ..choice(&scene, "vakonomic") });
            let discrete = Discrete::vakonomic(&scene.system, &scene.start, &multipliers, short(&motion));
            let what = format!("{}, μ₀ = {multipliers:?}", scene.name);
            let found = measure(&what, discrete, &mut motion);
            agrees(&what, &found, LIMIT, &mut tally);
        }
    }
    tally.say("vakonomic, scenes");
    assert!(tally.measured() >= 18);
}

#[test]
fn stationary_discrete_action_of_a_removal_tends_to_the_removed_motion() {
    let (mut tally, mut refused) = (Tally::default(), Vec::new());
    for scene in scenes() {
        for choice in choices(&scene).into_iter().filter(|c| c.formulation == "removed-constraint") {
            let Some(removal) = choice.removal.clone() else { continue };
            let what = format!("{}, {}", scene.name, removal.name);
            let settings = Settings { tolerance: 1e-12, ..Settings::default() };
            // by-heading of appell-hamel and the paper's of the cylinders have no regular equations
            let Ok(mut motion) = solve_choice(&scene, &choice, &settings) else {
                refused.push(what);
                continue;
            };
            let costates = costates(&motion, &removal);
            let Some(discrete) = removed(&scene.system, &removal, &scene.start, &costates, short(&motion)) else {
                refused.push(what);
                continue;
            };
            let found = measure(&what, discrete, &mut motion);
            agrees(&what, &found, LIMIT, &mut tally);
        }
    }
    tally.say("removed constraint, scenes");
    println!("without: {refused:?}");
    assert!(tally.measured() >= 15 && refused.len() <= 2, "{refused:?}");
}

#[test]
fn natural_ends_are_those_of_the_boundary_value_problem() {
    let mut tally = Tally::default();
    for scene in scenes() {
        for choice in choices(&scene).into_iter().filter(|c| c.formulation == "removed-constraint") {
            let Some(removal) = choice.removal.clone() else { continue };
            let what = format!("{}, {}, P(t₁) = 0", scene.name, removal.name);
            let horizon = scene.start.t + NATURAL_HORIZON;
            let choice = Choice { constants: ConstantsRule::Natural { horizon }, ..choice };
            let settings = Settings { tolerance: 1e-12, ..Settings::default() };
            let scene = Scene { duration: NATURAL_HORIZON, ..scene.clone() };
            let Ok(mut motion) = solve_choice(&scene, &choice, &settings) else { continue };
            let guess = costates(&motion, &removal);
            if guess.iter().all(|&p| p == 0.0) {
                continue;
            }
            // from another guess than the answer
            let guess: Vec<f64> = guess.iter().map(|p| 0.5 * p).collect();
            let start = RemovedStart::at(&scene.system, &removal, &scene.start, &guess);
            let discrete =
                start.and_then(|start| Discrete::removed(&scene.system, &removal, &start, horizon, Ends::Natural));
            let found = measure(&what, discrete, &mut motion);
            agrees(&what, &found, NATURAL_LIMIT, &mut tally);
        }
    }
    tally.say("removed constraint with natural ends, scenes");
    assert!(tally.measured() >= 15);
}
