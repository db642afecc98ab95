//! Tests between crates.

pub mod closed_forms;
pub mod references;
