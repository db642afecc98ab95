//! Integrals and measures of systems whose answers are known.

mod backwards;
mod in_an_ansatz;
mod known;
mod leaves;
mod multiplier;
mod other_units;
mod questions;
