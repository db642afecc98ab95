//! Reference trajectories with a known error.
//!
//! [`reference()`] integrates [`equations::Equations`] in double-double arithmetic by two unrelated methods,
//! one of them at two tolerances, and returns the largest difference.
//!
//! - *Extrapolation* (Gragg, Bulirsch & Stoer): values of `F(t, y)`, each with a linear solve for unknowns.
//! - *Taylor series* in time: [`symbolic::SeriesTape`] gives coefficients of any order, and the unknowns'
//!   coefficients follow from the residuals of the instant.
//!
//! Runs in `f64` take the same series tape, extrapolation none: where both agree, that tape is right.

mod cache;
mod double_double;
mod error;
mod extrapolation;
mod limits;
mod metric;
mod reference;
mod start;
mod taylor;

pub use cache::{CachedReference, digest};
pub use double_double::DoubleDouble;
pub use error::ReferenceError;
pub use mechanics::linear::Entry;
pub use metric::Point;
pub use reference::{Agreement, Question, Reference, reference, reference_in};
