//! # The decision

mod curve;
mod decide;
mod error;
mod family;
mod lift;
mod program;
mod transport;

pub use curve::{Curve, Flow, Known, Point};
pub use decide::{AffineSet, Decision, DecisionSettings, Verdict, decide, decide_flow};
pub use error::DecisionError;
pub use family::Family;
