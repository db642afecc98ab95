//! Tests between crates.
