//! Equations by a formulation.

use equations::{Equations, Formulation};
use mechanics::{ConstantsRule, Removal, System};
use motion::{Choice, SolveError, derive};

/// The equations of a formulation.
///
/// # Errors
/// [`SolveError`] where it has none for this system.
pub fn equations(
    system: &System,
    formulation: &'static Formulation,
    removal: Option<&Removal>,
) -> Result<Equations, SolveError> {
    let choice = Choice {
        label: formulation.title.into(),
        formulation,
        removal: removal.cloned(),
        constants: ConstantsRule::Zero,
    };
    derive(system, &choice)
}

/// The free constants of `equations` out of costates that are given one per memory variable.
pub fn free_constants(equations: &Equations, costates: &[f64]) -> Vec<f64> {
    equations.free_constants.iter().map(|c| c.memory.and_then(|i| costates.get(i)).copied().unwrap_or(0.0)).collect()
}
