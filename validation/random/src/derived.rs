//! Equations by the name of a formulation.

use deltaq::{Choice, SolveError, derive, formulation};
use equations::Equations;
use mechanics::{ConstantsRule, Removal, System};

/// The equations of a formulation of the table.
///
/// # Errors
/// [`SolveError`] where it has none for this system.
pub fn equations(system: &System, name: &str, removal: Option<&Removal>) -> Result<Equations, SolveError> {
    let entry = formulation(name).unwrap_or(&deltaq::FORMULATIONS[0]);
    let choice = Choice {
        label: entry.title.into(),
        formulation: entry.name,
        removal: removal.cloned(),
        constants: ConstantsRule::Zero,
    };
    derive(system, &choice)
}

/// The free constants of `equations` out of costates that are given one per memory variable.
pub fn free_constants(equations: &Equations, costates: &[f64]) -> Vec<f64> {
    equations.free_constants.iter().map(|c| c.memory.and_then(|i| costates.get(i)).copied().unwrap_or(0.0)).collect()
}
