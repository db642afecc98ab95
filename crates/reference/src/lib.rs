//! Reference trajectories with a known error.
//!
//! [`reference()`] computes a motion from [`equations::Equations`] in double-double arithmetic by two methods that step time differently, each at two
//! tolerances, and says how far they are apart.
//!
//! - *Extrapolation* (Gragg, Bulirsch & Stoer): values of `F(t, y)` only, each with a linear solve for the unknowns of the instant.
//! - *Taylor series* in time: the tapes are evaluated once in a number type that records operations; the trace gives coefficients of any
//!   order, and the unknowns' coefficients follow from the residuals of the instant.
//!
//! The series engine here is slow, small, and shares no recurrence with any other: it is a referee of that, too.

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
pub use metric::Distance;
pub use reference::{Agreement, Question, Reference, reference, reference_in};
pub use wide::Wide;
