//! Start data: velocities from the constraints, projection onto the constraint, start values of a removal.
//!
//! A scene gives some velocities; the others solve `f(q₀, v, t₀) = 0`. Too few given ones and contradictory
//! ones are errors that say by how much.

mod complete;
mod configurations;
mod data;
mod error;
mod numeric;
mod project;
mod recombination;
mod regularity;
mod removal_start;
mod velocities;

pub use complete::{StartProgram, complete_start};
pub use configurations::Configurations;
pub use data::{Completion, StartData, StartNumbers, StartShape};
pub use error::{Quantity, StartError};
pub use project::project_velocity;
pub use recombination::Recombination;
pub use regularity::{check_reactions, check_regularity};
pub use removal_start::{RemovalProgram, RemovalStart, complete_removal_start};
