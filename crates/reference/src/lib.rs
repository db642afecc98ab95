//! Reference trajectories with a known error.

mod double_double;
mod error;
mod extrapolation;
mod instant;
mod linear;
mod metric;
mod reference;
mod series;
mod start;
mod taylor;
mod trace;
mod wide;

pub use double_double::DoubleDouble;
pub use error::ReferenceError;
pub use instant::Point;
pub use reference::{Agreement, Distance, Question, Reference, reference, reference_in};
pub use wide::Wide;
