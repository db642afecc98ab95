//! Scenes as questions.

use std::path::Path;

use decision::{Decision, DecisionSettings, Family, Flow, decide_flow};
use mechanics::{Derivation, Removal, Scene, System};

/// A built-in scene with other numbers.
pub(crate) fn built_in(name: &str, overrides: &[(&str, f64)]) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../validation/scenes/{name}.toml"));
    let overrides: Vec<(String, f64)> = overrides.iter().map(|&(name, value)| (name.into(), value)).collect();
    Scene::load_with(&file, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// The system with no force, from which a variational principle is derived.
fn without_forces(system: &System) -> System {
    System { forces: vec![system.graph.zero(); system.dimension()], ..system.clone() }
}

pub(crate) fn chetaev(scene: &Scene) -> Flow {
    let equations = chetaev::derive(&scene.system, &Derivation::default()).expect("equations");
    let end = scene.start.t + scene.duration;
    Flow::new(&scene.system, &equations, &scene.start, &[], end).expect("a curve")
}

pub(crate) fn vakonomic(scene: &Scene) -> Family {
    let equations = vakonomic::derive(&without_forces(&scene.system), &Derivation::default()).expect("equations");
    Family::new(&scene.system, &equations, false).expect("a family")
}

pub(crate) fn removed(scene: &Scene, removal: &Removal) -> Family {
    let derivation = Derivation { removal: Some(removal), start: None };
    let equations = removed_constraint::derive(&without_forces(&scene.system), &derivation).expect("equations");
    Family::new(&scene.system, &equations, false).expect("a family")
}

/// Is Chetaev's motion of the scene vakonomic?
pub(crate) fn is_vakonomic(scene: &Scene) -> Decision {
    decide_flow(&vakonomic(scene), &chetaev(scene), &DecisionSettings::default()).expect("a decision")
}
