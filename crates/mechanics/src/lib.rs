//! Mechanical systems with velocity constraints: description, start data, and the form in which a formulation hands over
//! its equations of motion. Knows no formulation.

mod automatic_removal;
mod cheapest;
mod compiled;
mod definitions;
mod derivatives;
mod equations;
mod error;
mod form;
mod form_collection;
mod form_elimination;
mod form_pivots;
mod formulation;
mod frame;
mod instant;
mod integrability;
mod lanes;
pub mod linear;
pub mod newton;
mod projection;
mod quasi_velocities;
mod rank;
mod removal;
mod scene;
mod scene_error;
mod series;
mod start;
mod straight;
mod system;

pub use cheapest::{cheapest, matrix_moves};
pub use compiled::{Compiled, Cost, Outputs};
pub use definitions::Definitions;
pub use equations::{
    Block, ConstraintProjection, Equations, FreeConstant, LeftOut, Named, Role, StateVariable, Statement,
};
pub use error::RemovalError;
pub use form::Form;
pub use form_collection::Collected;
pub use formulation::{Derivation, DerivationError, Formulation, fresh_symbol, refuse_forces};
pub use frame::{Frame, FrameConstraint, FrameVelocity, Turning};
pub use instant::EvaluationFailure;
pub use integrability::{Integrability, integrability};
pub use lanes::LaneEquations;
pub use quasi_velocities::{Columns, DependentVelocity, EliminatedConstraint, QuasiVelocities, QuasiVelocity};
pub use rank::generic_rank;
pub use removal::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal};
pub use scene::{SIZE_LIMIT, Scene};
pub use scene_error::{NameFault, SceneError, SceneErrorKind, Unavailable};
pub use start::{
    Completion, Quantity, Recombination, RemovalStart, StartData, StartError, check_regularity, complete_removal_start,
    complete_start, project_velocity,
};
pub use system::{Coordinate, Parameter, State, System};
