//! Where a removed motion starts and what holds at its end.

use mechanics::{Removal, State, System, complete_removal_start};
use symbolic::Symbol;

use crate::DiscreteError;

/// What holds at the ends of a removed motion; the other motions know only the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// `P₀` as given.
    GivenStart,
    /// `w_N` is free: `P_N = 0`, and `P₀` follows from it.
    Natural,
}

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
    /// `P₀`, length k; with [`Ends::Natural`] a first guess.
    pub costates: Vec<f64>,
}

impl RemovedStart {
    /// The values of `(u, u̇, w)` that belong to `state`, with `costates` one a memory variable.
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
