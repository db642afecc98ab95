//! What stays from question to question while a hand is on a slider: derived and compiled equations.

use std::collections::HashMap;

use mechanics::{ConstantsRule, Parameter};
use motion::{Choice, Settings, SolveError, Varying};
use scene::Scene;

use crate::question::Question;

/// Motions of one text, derived for all values of the parameters that are set.
#[derive(Default)]
pub(crate) struct Cache {
    text: String,
    /// Names of the parameters, in the order of the scene.
    parameters: Vec<String>,
    motions: HashMap<Key, Varying>,
}

/// What a derivation depends on besides: the label, and which constants are given that are not zero.
type Key = (String, Option<Vec<bool>>);

impl Cache {
    /// Forgets what does not belong to the text of the question and to the parameters that are set there.
    pub(crate) fn turn_to(&mut self, question: &Question, scene: &Scene) {
        let names = scene.system.parameters.iter().map(|p| scene.system.graph.name(p.symbol));
        let parameters: Vec<String> = names.filter(|name| question.set.contains_key(name)).collect();
        if self.text != question.text || self.parameters != parameters {
            *self = Cache { text: question.text.clone(), parameters, motions: HashMap::new() };
        }
    }

    fn varied<'a>(&self, scene: &'a Scene) -> impl Iterator<Item = &'a Parameter> {
        let g = &scene.system.graph;
        scene.system.parameters.iter().filter(|p| self.parameters.contains(&g.name(p.symbol)))
    }

    /// Values of the parameters that are set.
    pub(crate) fn values(&self, scene: &Scene) -> Vec<f64> {
        self.varied(scene).map(|p| p.value).collect()
    }

    /// What is kept of a motion, or else is derived now.
    pub(crate) fn take(&mut self, scene: &Scene, choice: &Choice, settings: &Settings) -> Result<Varying, SolveError> {
        let varied: Vec<_> = self.varied(scene).map(|p| p.symbol).collect();
        let kept = self.motions.remove(&key(choice));
        kept.map_or_else(|| Varying::new(scene, choice, &varied, settings), Ok)
    }

    /// Caches the compiled equations of a preview run.
    pub(crate) fn keep(&mut self, choice: &Choice, varying: Varying) {
        self.motions.insert(key(choice), varying);
    }
}

fn key(choice: &Choice) -> Key {
    let given = match &choice.constants {
        ConstantsRule::Given(values) => Some(values.iter().map(|x| *x != 0.0).collect()),
        ConstantsRule::Zero | ConstantsRule::Natural { .. } => None,
    };
    (choice.label.clone(), given)
}
