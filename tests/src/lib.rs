//! Tests between crates.

pub mod references;
