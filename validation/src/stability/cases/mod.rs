//! The cases.

mod blow_up;
mod cone;
mod cylinders;
mod dependent;
mod mass;
mod sledge;
mod units;
mod viscous;

use deltaq::{Choice, choices, derive_at, formulation};
use mechanics::ConstantsRule;
use scene::{Scene, SceneError};

use super::question::{Case, Question, Subject};
use super::reference::Reference;

/// All cases, in the order of the page.
pub const CASES: &[Case] = &[
    viscous::CASE,
    mass::ADDED,
    mass::RATIO,
    sledge::GYRATION,
    sledge::LONG,
    cone::APEX,
    cone::CHART,
    cylinders::TURN,
    cylinders::HEADING,
    cylinders::ANGLE,
    dependent::CASE,
    units::LENGTH,
    units::TIME,
    units::MASS,
    blow_up::CASE,
    blow_up::MOVING,
];

/// What is known of the sledge of the scene, in a formulation.
pub(super) fn sledge_reference(formulation: &str) -> Reference {
    sledge::Sledge { k: sledge::RADIUS }.reference(formulation)
}

/// The formulations of a scene that has multipliers: two forms of the vakonomic one among them.
const FORMULATIONS: [&str; 4] = ["chetaev", "vakonomic", "vakonomic-costate", "removed-constraint"];

/// The first choice of a scene with that formulation, free constants zero where the scene gives none.
pub(super) fn choice(scene: &Scene, name: &str) -> Result<Choice, String> {
    let found = choices(scene).into_iter().find(|c| c.formulation == name);
    let mut choice = found.ok_or_else(|| format!("no formulation {name}"))?;
    if choice.removal.is_some() {
        choice.constants = ConstantsRule::Zero;
    }
    Ok(choice)
}

/// A scene in one formulation.
fn subject(scene: &Scene, choice: &Choice) -> Result<Subject, String> {
    let equations = derive_at(&scene.system, &scene.start, choice).map_err(|error| error.to_string())?;
    Ok(Subject {
        system: scene.system.clone(),
        start: scene.start.clone(),
        end: scene.start.t + scene.duration,
        equations,
        constants: choice.constants.clone(),
        measured: scene.system.clone(),
    })
}

/// One question a formulation in `names`; where the scene itself is refused, that is the answer.
fn questions(
    point: f64,
    scene: impl Fn() -> Result<Scene, SceneError> + Clone + Send + Sync + 'static,
    names: &[&'static str],
    reference: impl Fn(&'static str) -> Reference,
) -> Vec<Question> {
    let one = |&name: &&'static str| {
        let scene = scene.clone();
        let subject = move || {
            let scene = scene().map_err(|error| error.to_string())?;
            subject(&scene, &choice(&scene, name)?)
        };
        let title = formulation(name).map_or(name, |f| f.title);
        Question {
            point,
            formulation: title.into(),
            subject: Box::new(subject),
            reference: reference(name),
            compared: usize::MAX,
        }
    };
    names.iter().map(one).collect()
}

/// `10^from, 10^(from + step), …, 10^to`.
fn powers(from: i32, to: i32, step: usize) -> impl Iterator<Item = f64> {
    (from..=to).step_by(step).map(|k| 10.0_f64.powi(k))
}
