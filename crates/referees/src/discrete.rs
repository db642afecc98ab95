//! Discrete variational principles as a referee: motions from `L`, `f`, `Q`, tending to a given one.
//!
//! Principles and steps are those of `discrete`, which sees no formulation; orders, of its base step.

mod convergence;
#[cfg(test)]
mod tests;

pub use convergence::{Convergence, convergence};
pub use discrete::{Discrete, DiscreteError, Ends, RemovedStart};
