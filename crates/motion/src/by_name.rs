//! A motion whose numbers are set by their names in the scene.

use mechanics::{ConstantsRule, State};
use scene::{Scene, SceneErrorKind, Start, Starts};
use symbolic::Symbol;

use crate::costates::Costates;
use crate::{Choice, Settings, SolveError, Varying};

/// [`Varying`] by the names that [`Scene::starts`] knows, and `P0_w` for the costate of the memory variable
/// `w` of a removal.
#[derive(Clone)]
pub struct ByName {
    names: Vec<String>,
    varying: Varying,
    choice: Choice,
    starts: Starts,
    costates: Costates,
}

/// The start of a motion with given numbers.
pub(crate) struct Beginning {
    pub(crate) state: State,
    pub(crate) parameters: Vec<f64>,
    pub(crate) constants: ConstantsRule,
}

impl ByName {
    /// Derives and compiles `choice` of `scene` for all numbers of these names.
    ///
    /// # Errors
    /// As [`Varying::new`]; [`SolveError::Scene`] where the scene has no such name; [`SolveError::Member`]
    /// where a name comes twice, where multipliers or costates are named that the formulation does not start
    /// from.
    pub fn new(scene: &Scene, choice: &Choice, names: &[&str], settings: &Settings) -> Result<Self, SolveError> {
        let refused = |reason: String| Err(SolveError::Member { reason });
        if let Some(i) = (1..names.len()).find(|&i| names[..i].contains(&names[i])) {
            return refused(format!("`{}` is named twice", names[i]));
        }
        let own = names.iter().map(|name| name.to_string()).collect();
        let (costates, names) =
            Costates::among(names, scene, choice).map_err(|reason| SolveError::Member { reason })?;
        let choice = costates.choice(choice);
        let starts = scene.starts(&names).map_err(|error| SolveError::Scene(Box::new(error)))?;
        if starts.vary_multipliers() && !choice.formulation.starts_multipliers {
            return refused(format!("multipliers vary, and {} does not start from them", choice.formulation.name));
        }
        let varying = Varying::new(scene, &choice, &starts.parameters(), settings)?;
        Ok(ByName { names: own, varying, choice, starts, costates })
    }

    /// The start of the motion with the numbers of a row, one per name.
    ///
    /// # Panics
    /// If there are not as many numbers as names.
    pub(crate) fn beginning(&mut self, row: &[f64]) -> Result<Beginning, SceneErrorKind> {
        let (given, row) = self.costates.split(row);
        let Start { state, parameters, multipliers } = self.starts.at(&row)?;
        let constants = match (given, self.starts.vary_multipliers()) {
            (Some(costates), _) => ConstantsRule::Given(costates),
            (None, true) => ConstantsRule::Given(multipliers),
            (None, false) => self.choice.constants.clone(),
        };
        Ok(Beginning { state, parameters, constants })
    }

    /// Sets the numbers of a row, one per name; the free constants as `rule` says, or as the row and the
    /// choice do.
    ///
    /// # Errors
    /// [`SolveError`] without a start.
    ///
    /// # Panics
    /// If there are not as many numbers as names.
    pub fn set(&mut self, row: &[f64], rule: Option<&ConstantsRule>) -> Result<(), SolveError> {
        let found = self.beginning(row).map_err(|fault| SolveError::Member { reason: fault.to_string() })?;
        self.varying.set(&found.state, &found.parameters, rule.unwrap_or(&found.constants), false)
    }

    /// The names.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The parameters that vary, in the order of the scene.
    pub fn parameters(&self) -> Vec<Symbol> {
        self.starts.parameters()
    }

    /// The choice, with all costates that are named.
    pub fn choice(&self) -> &Choice {
        &self.choice
    }

    /// The equations with these numbers.
    pub fn varying(&self) -> &Varying {
        &self.varying
    }

    /// The same, to be set otherwise or integrated.
    pub fn varying_mut(&mut self) -> &mut Varying {
        &mut self.varying
    }
}
