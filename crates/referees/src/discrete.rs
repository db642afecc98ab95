//! Discrete variational principles as a referee: motions from `L`, `f` and `Q` alone, and how they tend to a given one.
//!
//! The principles and their steps are those of the crate `discrete`, which sees no formulation; the orders measured here are those of its base step.

mod convergence;
#[cfg(test)]
mod tests;

pub use convergence::{Convergence, convergence};
pub use discrete::{Discrete, DiscreteError, Ends, RemovedStart};
