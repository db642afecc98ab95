//! Mechanical systems with velocity constraints: description, start data, and the form in which a formulation hands over
//! its equations of motion. Knows no formulation.

mod error;
mod removal;
mod system;

pub use error::RemovalError;
pub use removal::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal};
pub use system::{Coordinate, Parameter, State, System};
