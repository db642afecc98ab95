//! Scene files as a user writes them: one program, one module per subject.

mod bodies;
mod bytes;
mod catalogue;
mod errors;
mod language;
mod names;
mod remarks;
mod snapshots;
mod start;
mod start_equations;
mod tables;
