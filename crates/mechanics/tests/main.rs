//! Systems as a user of the crate meets them: one program, one module per subject.

mod factors;
mod growth;
mod integrability;
mod newton;
mod removal;
mod singular_values;
mod systems;
