//! Systems as a user of the crate meets them: one program, one module a subject.

mod integrability;
mod removal;
mod systems;
