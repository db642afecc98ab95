//! Systems as a user of the crate meets them: one program, one module per subject.

mod integrability;
mod removal;
mod systems;
