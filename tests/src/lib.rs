//! Tests between crates.

pub mod closed_forms;
