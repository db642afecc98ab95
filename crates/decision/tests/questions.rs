//! Scenes as questions.

use std::path::Path;

use decision::{Decision, DecisionSettings, ExactStart, Family, Flow, Proof, Question, Section, decide_flow};
use equations::{Derivation, Equations};
use mechanics::Removal;
use scene::{Number, Scene};

/// A built-in scene with other numbers.
pub(crate) fn built_in(name: &str, overrides: &[(&str, f64)]) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../crates/scene/scenes/{name}.toml"));
    let overrides: Vec<(String, f64)> = overrides.iter().map(|&(name, value)| (name.into(), value)).collect();
    Scene::load_with(&file, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// A built-in scene with other numbers, as they are written.
pub(crate) fn as_written(name: &str, overrides: &[(&str, &str)]) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../crates/scene/scenes/{name}.toml"));
    let number = |text: &str| text.parse::<Number>().expect("a number");
    let overrides: Vec<_> = overrides.iter().map(|&(name, text)| (name.to_owned(), number(text))).collect();
    Scene::load_with(&file, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// A system of the literature.
pub(crate) fn beside(name: &str) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../crates/scene/classics/{name}.toml"));
    Scene::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

/// A scene from its text, with other numbers.
pub(crate) fn written(text: &str, overrides: &[(&str, f64)]) -> Scene {
    let overrides: Vec<(String, f64)> = overrides.iter().map(|&(name, value)| (name.into(), value)).collect();
    Scene::parse_with("written", text, &overrides).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn chetaev_equations(scene: &Scene) -> Equations {
    chetaev::derive(&scene.system, &Derivation::default()).expect("equations")
}

pub(crate) fn vakonomic_equations(scene: &Scene) -> Equations {
    vakonomic::derive(&scene.system, &Derivation::default()).expect("equations")
}

pub(crate) fn flow(scene: &Scene, equations: &Equations, constants: &[f64]) -> Flow {
    let end = scene.start.t + scene.duration;
    Flow::new(&scene.system, equations, &scene.start, constants, end).expect("a curve")
}

pub(crate) fn chetaev(scene: &Scene) -> Flow {
    flow(scene, &chetaev_equations(scene), &[])
}

pub(crate) fn vakonomic(scene: &Scene) -> Family {
    Family::new(&scene.system, &vakonomic_equations(scene)).expect("a family")
}

pub(crate) fn removed_equations(scene: &Scene, removal: &Removal) -> Equations {
    let derivation = Derivation { removal: Some(removal), ..Derivation::default() };
    removed_constraint::derive(&scene.system, &derivation).expect("equations")
}

pub(crate) fn removed(scene: &Scene, removal: &Removal) -> Family {
    Family::new(&scene.system, &removed_equations(scene, removal)).expect("a family")
}

pub(crate) fn decided(family: &Family, flow: &Flow) -> Decision {
    decide_flow(family, flow, &DecisionSettings::default()).expect("a decision")
}

/// Is Chetaev's motion of the scene vakonomic?
pub(crate) fn is_vakonomic(scene: &Scene) -> Decision {
    decided(&vakonomic(scene), &chetaev(scene))
}

pub(crate) fn exact_start(scene: &Scene) -> ExactStart {
    ExactStart::new(&scene.system, &scene.start, &scene.completion, scene.removals.first()).expect("a start")
}

/// What is proved about the motion of `equations` with `constants` as one of `family`.
pub(crate) fn proved_in(
    scene: &Scene,
    equations: &Equations,
    constants: &[f64],
    family: &Family,
) -> (Proof, Option<Section>) {
    let question = Question::new(&scene.system, equations, constants, family).expect("a question");
    let start = exact_start(scene);
    let section = question.section(&scene.system, &start, &scene.start).expect("a search");
    (question.prove(&start), section)
}

/// What is proved about Chetaev's motion as a vakonomic one, and the section of the set over all starts.
pub(crate) fn proved(scene: &Scene) -> (Proof, Option<Section>) {
    proved_in(scene, &chetaev_equations(scene), &[], &vakonomic(scene))
}

/// The exponent and the coefficient of the leading difference, and whether that is exact.
pub(crate) fn leading(scene: &Scene, multipliers: &[f64], exact: bool) -> Option<(usize, Vec<f64>, bool)> {
    let family = vakonomic(scene);
    let question = Question::new(&scene.system, &chetaev_equations(scene), &[], &family).expect("a question");
    let start = exact.then(|| exact_start(scene));
    let found = question.leading_difference(&scene.system, &scene.start, start.as_ref(), multipliers)?;
    Some((found.exponent, found.coefficient, found.exact))
}

/// The least mismatch by Taylor series, up to the end of the run.
pub(crate) fn least_by_series(scene: &Scene) -> f64 {
    let family = vakonomic(scene);
    let question = Question::new(&scene.system, &chetaev_equations(scene), &[], &family).expect("a question");
    question.least_by_series(&scene.system, &scene.start, scene.duration).expect("series")
}
