//! Integration as a user of the crate meets it: one program, one module per subject.

mod boundary;
mod dense;
mod dop853;
mod events;
mod methods;
mod problems;
mod stops;
mod taylor;
