//! What a question is about: a scene, and its motions with their free constants.

use deltaq::{Choice, choices, costate_names};
use mechanics::ConstantsRule;
use scene::{Scene, SceneError};

use crate::question::Question;

/// What the names of costates at the start begin with.
const COSTATE: &str = "P0_";

/// A scene with the numbers of a question in it, and its motions.
pub(crate) struct Subject {
    pub(crate) scene: Scene,
    /// Every motion, or those asked for in their order.
    pub(crate) choices: Vec<Choice>,
}

impl Subject {
    /// Reads the scene and sets the costates.
    pub(crate) fn of(question: &Question) -> Result<Subject, SceneError> {
        let (costates, overrides): (Vec<_>, Vec<_>) =
            question.set.iter().map(|(name, x)| (name.clone(), *x)).partition(|(name, _)| name.starts_with(COSTATE));
        let scene = Scene::parse_with(&question.name, &question.text, &overrides)?;
        let mut choices = choices(&scene);
        if !question.motions.is_empty() {
            let asked = question.motions.iter();
            choices = asked.filter_map(|label| choices.iter().find(|c| c.label == *label).cloned()).collect();
        }
        for choice in &mut choices {
            let Some(removal) = &choice.removal else { continue };
            let names = costate_names(&scene, removal);
            let given = |name: &String| costates.iter().find(|(known, _)| known == name).map(|(_, x)| *x);
            if names.iter().any(|name| given(name).is_some()) {
                let before = match &choice.constants {
                    ConstantsRule::Given(values) if values.len() == names.len() => values.clone(),
                    _ => vec![0.0; names.len()],
                };
                let values = names.iter().zip(before).map(|(name, before)| given(name).unwrap_or(before));
                choice.constants = ConstantsRule::Given(values.collect());
            }
        }
        Ok(Subject { scene, choices })
    }
}
