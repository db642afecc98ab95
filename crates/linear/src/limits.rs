//! Limits that several modules ask for, each with the reason for its value.

/// Round-off of a sum or of what was halved as often, over its last digit.
pub(crate) const ROUNDINGS: f64 = 64.0;
