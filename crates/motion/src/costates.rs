//! Costates `P(t₀)` of the memory variables of a removal that vary over an ensemble.

use std::borrow::Cow;

use mechanics::{ConstantsRule, Removal};
use scene::Scene;

use crate::Choice;

/// Which numbers of a row are costates, and what the others are.
#[derive(Clone, Default)]
pub struct Costates {
    /// `P(t₀)`, one per memory variable, without those of a row.
    base: Vec<f64>,
    /// Place in a row and memory variable.
    varied: Vec<(usize, usize)>,
}

/// How the names of costates at the start begin.
const START: &str = "P0_";

/// The names of the costates at the start: `P0_w`.
pub fn costate_names(scene: &Scene, removal: &Removal) -> Vec<String> {
    removal.memory.iter().map(|w| format!("{START}{}", scene.system.graph.name(w.symbol))).collect()
}

/// The costates at the start of a choice, as far as it gives them: zero otherwise, until a search finds them.
pub fn given_costates(scene: &Scene, choice: &Choice) -> Vec<(String, f64)> {
    let names = choice.removal.as_ref().map_or(Vec::new(), |removal| costate_names(scene, removal));
    let values = match &choice.constants {
        ConstantsRule::Given(values) if values.len() == names.len() => values.clone(),
        _ => vec![0.0; names.len()],
    };
    names.into_iter().zip(values).collect()
}

/// Whether a name is that of a costate at the start.
pub fn is_costate(name: &str) -> bool {
    name.starts_with(START)
}

impl Costates {
    /// Those among `names`, and the other names. Costates that do not vary are zero, or as the choice gives
    /// them.
    pub fn among<'a>(names: &[&'a str], scene: &Scene, choice: &Choice) -> Result<(Costates, Vec<&'a str>), String> {
        let (known, base): (Vec<String>, Vec<f64>) = given_costates(scene, choice).into_iter().unzip();
        let (mut varied, mut others) = (Vec::new(), Vec::new());
        for (place, name) in names.iter().enumerate() {
            match known.iter().position(|known| known == name) {
                Some(memory) => varied.push((place, memory)),
                None if is_costate(name) && known.is_empty() => {
                    return Err(format!("`{name}` varies, and {} has no memory variables", choice.formulation.name));
                }
                None if is_costate(name) => {
                    return Err(format!("no costate `{name}` that could vary; there are {}", known.join(", ")));
                }
                None => others.push(*name),
            }
        }
        if varied.is_empty() {
            return Ok((Costates::default(), others));
        }
        Ok((Costates { base, varied }, others))
    }

    /// The choice whose equations have all costates that vary, for whatever value.
    pub fn choice(&self, choice: &Choice) -> Choice {
        let mut choice = choice.clone();
        if !self.varied.is_empty() {
            let mut values = self.base.clone();
            self.varied.iter().for_each(|(_, memory)| values[*memory] = 1.0);
            choice.constants = ConstantsRule::Given(values);
        }
        choice
    }

    /// The costates of a row, if some vary, and its other numbers.
    pub fn split<'a>(&self, row: &'a [f64]) -> (Option<Vec<f64>>, Cow<'a, [f64]>) {
        if self.varied.is_empty() {
            return (None, Cow::Borrowed(row));
        }
        let mut values = self.base.clone();
        for (place, memory) in &self.varied {
            values[*memory] = row[*place];
        }
        let is_costate = |place: usize| self.varied.iter().any(|(costate, _)| *costate == place);
        let others = (0..row.len()).filter(|place| !is_costate(*place)).map(|place| row[place]).collect();
        (Some(values), Cow::Owned(others))
    }
}
