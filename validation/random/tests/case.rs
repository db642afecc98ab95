//! Limits that all claims share.

use comparison::compare_motions;
use motion::{Metric, Settings, choices, solve_choice};
use random::judged::{floor, tolerances};
use random::{Case, Kind, Removed, Word, draw_recipe};
use scene::Scene;

/// A particle whose `y` is held, under a push.
fn particle(push: f64) -> Scene {
    let text = format!(
        "title = \"held\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\n\
         lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\nforces = {{ x = \"{push:?}\" }}\n\
         [start.velocities]\n\"x'\" = 1\n[run]\nduration = 2\n"
    );
    Scene::parse("held", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// `[1 0 0; 0 1 1; 0 1 0]` has the singular values 1, φ and 1/φ.
#[test]
fn the_floor_is_a_hundred_last_digits_times_the_condition() {
    let scene = particle(0.0);
    let ratio = 0.5 * (1.0 + 5_f64.sqrt());
    let known = 1e2 * f64::EPSILON * ratio * ratio;
    let found = floor(&scene.system, &scene.start, &scene.multipliers).expect("a floor");
    assert!((found / known - 1.0).abs() < 1e-12, "{found:e}, {known:e}");
}

/// Costates are eighths of what is drawn, zero where a memory variable has none.
#[test]
fn costates_at_the_start_are_those_of_the_recipe() {
    let mut used = 0;
    for index in 0..6 {
        let case = Case::new(draw_recipe(1, index, &[Kind::Linear]), "costates").unwrap_or_else(|e| panic!("{e}"));
        for Removed { removal, costates, motion } in &case.removed {
            assert_eq!(costates.len(), removal.memory.len());
            for (i, &costate) in costates.iter().enumerate() {
                let is_free = motion.equations.free_constants.iter().any(|c| c.memory == Some(i));
                let drawn = case.recipe.costates[i % case.recipe.costates.len()] as f64 / 8.0;
                assert_eq!(costate, if is_free { drawn } else { 0.0 }, "{}, {i}", removal.name);
                used += usize::from(is_free && drawn != 0.0);
            }
        }
    }
    assert!(used > 0);
}

/// A push `p` makes a gap of `p t²/2`: 2 p.
#[test]
fn gaps_count_over_the_floor_only() {
    let [mut one, mut other] = [0.0, 5e-7].map(|push| {
        let scene = particle(push);
        solve_choice(&scene, &choices(&scene)[0], &Settings::default()).expect("a motion")
    });
    let mut metric = Metric::new(&particle(0.0).system).expect("a metric");
    let gap = compare_motions(&mut one, &mut other, &mut metric).expect("a gap");
    let mut case = Case::new(draw_recipe(1, 0, &[Kind::Free]), "gaps").unwrap_or_else(|e| panic!("{e}"));
    for (floor, word) in [(0.0, Word::Fails), (0.5e-6, Word::Fails), (2e-6, Word::Holds)] {
        case.note(1, "same", &gap, floor);
        let found = case.found.findings.last().expect("a finding");
        assert_eq!(found.word, word, "{floor:e}: {found:?}");
        assert!((found.figure - 1e-6).abs() < 1e-10, "{found:?}");
    }
}

/// The kept run is a hundred times as sharp as its looser one, and no sharper than 10⁻⁶ of the floor.
#[test]
fn a_floor_asks_for_less_sharp_runs() {
    for (floor, sharpest) in [(0.5e-7, 1e-11), (2e-7, 1e-9), (2e-5, 1e-7), (1.0, 1e-7)] {
        assert_eq!(tolerances(floor).next(), Some(sharpest), "{floor:e}");
    }
}
