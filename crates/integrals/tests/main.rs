//! Integrals and measures of systems whose answers are known.

mod backwards;
mod in_an_ansatz;
mod known;
mod multiplier;
mod other_units;
mod questions;
