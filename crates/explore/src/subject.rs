//! What a question is about: a scene, and its motions with their free constants.

use mechanics::ConstantsRule;
use motion::{Choice, choices, given_costates, is_costate};
use scene::{Scene, SceneError, SceneErrorKind};

use crate::question::{Ask, Question};

/// A scene with the numbers of a question in it, and its motions.
pub(crate) struct Subject {
    pub(crate) scene: Scene,
    /// Every motion, or those asked for in their order.
    pub(crate) choices: Vec<Choice>,
    /// Numbers of the question that nothing in the text has a name for.
    pub(crate) unknown: Vec<String>,
}

/// The name of a costate at the start in one motion only: `P0_w` is that of all removals that have a `w`.
pub(crate) fn costate_of(choice: &Choice, name: &str) -> String {
    format!("{name}@{}", choice.label)
}

impl Subject {
    /// Reads the scene and sets the costates.
    pub(crate) fn of(question: &Question) -> Result<Subject, SceneError> {
        let (costates, overrides): (Vec<_>, Vec<_>) =
            question.set.iter().map(|(name, x)| (name.clone(), *x)).partition(|(name, _)| is_costate(name));
        let (scene, unknown) = known(question, overrides)?;
        let mut choices = choices(&scene);
        if !question.motions.is_empty() {
            let asked = question.motions.iter();
            choices = asked.filter_map(|label| choices.iter().find(|c| c.label == *label).cloned()).collect();
        }
        for choice in &mut choices {
            let named = |name: &str| costates.iter().find(|(known, _)| known == name).map(|(_, x)| *x);
            let given = |name: &String| named(&costate_of(choice, name)).or_else(|| named(name));
            let before = given_costates(&scene, choice);
            if before.iter().any(|(name, _)| given(name).is_some()) {
                let values = before.iter().map(|(name, before)| given(name).unwrap_or(*before)).collect();
                choice.constants = ConstantsRule::Given(values);
            }
        }
        Ok(Subject { scene, choices, unknown })
    }
}

/// The scene with the numbers that it has names for, and the other names where the scene itself is asked
/// about: a text that is being written may have had them before.
fn known(question: &Question, mut overrides: Vec<(String, f64)>) -> Result<(Scene, Vec<String>), SceneError> {
    let mut unknown = Vec::new();
    loop {
        let error = match Scene::parse_with(&question.name, &question.text, &overrides) {
            Ok(scene) => return Ok((scene, unknown)),
            Err(error) => error,
        };
        let place = match &*error.kind {
            SceneErrorKind::UnknownName { name, .. } if error.line == 0 && matches!(question.ask, Ask::Scene) => {
                overrides.iter().position(|(set, _)| set == name)
            }
            _ => None,
        };
        let Some(place) = place else { return Err(error) };
        unknown.push(overrides.remove(place).0);
    }
}
