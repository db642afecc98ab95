//! Scene files as a user writes them: one program, one module per subject.

mod bytes;
mod catalogue;
mod errors;
mod language;
mod names;
mod snapshots;
mod start;
mod start_equations;
mod tables;
