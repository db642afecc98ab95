//! Where a removed motion starts.

use mechanics::{Removal, State, System, complete_removal_start};
use symbolic::Symbol;

use crate::DiscreteError;

/// Where a removed motion starts.
#[derive(Clone, Debug, PartialEq)]
pub struct RemovedStart {
    /// `t₀`.
    pub t: f64,
    /// `u₀`, length m.
    pub parameters: Vec<f64>,
    /// `u̇₀`, length m.
    pub rates: Vec<f64>,
    /// `w₀`, length k.
    pub memory: Vec<f64>,
    /// `P₀`, length k.
    pub costates: Vec<f64>,
}

impl RemovedStart {
    /// The values of `(u, u̇, w)` that belong to `state`, with `costates` one per memory variable.
    ///
    /// # Errors
    /// [`DiscreteError::Removal`].
    pub fn at(system: &System, removal: &Removal, state: &State, costates: &[f64]) -> Result<Self, DiscreteError> {
        let values = complete_removal_start(system, removal, state)?.values();
        let read = |symbols: &mut dyn Iterator<Item = Symbol>| -> Vec<f64> {
            symbols.map(|s| values.get(&s).copied().unwrap_or(f64::NAN)).collect()
        };
        Ok(RemovedStart {
            t: state.t,
            parameters: read(&mut removal.parameters.iter().map(|u| u.symbol)),
            rates: read(&mut removal.parameters.iter().map(|u| u.rate)),
            memory: read(&mut removal.memory.iter().map(|w| w.symbol)),
            costates: costates.to_vec(),
        })
    }
}
