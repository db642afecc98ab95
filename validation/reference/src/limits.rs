//! Limits that several modules ask for, each with the reason for its value.

/// The relative step after which one more leaves round-off only.
pub(crate) const SMALL: f64 = 1e-18;

/// Shortest step, relative to the time.
pub(crate) const SHORTEST: f64 = 1e-12;
