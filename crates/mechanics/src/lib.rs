//! Mechanical systems with velocity constraints: description, start data, and the form in which a formulation hands over
//! its equations of motion. Knows no formulation.

mod automatic_removal;
mod compiled;
mod equations;
mod error;
mod formulation;
mod integrability;
mod linear;
mod projection;
mod rank;
mod removal;
mod system;

pub use compiled::{Compiled, EvaluationFailure, Outputs};
pub use equations::{Block, ConstraintProjection, Equations, FreeConstant, Named, Role, StateVariable, Statement};
pub use error::RemovalError;
pub use formulation::{Derivation, DerivationError, Formulation, fresh_symbol, refuse_forces};
pub use integrability::{Integrability, integrability};
pub use rank::generic_rank;
pub use removal::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal};
pub use system::{Coordinate, Parameter, State, System};
