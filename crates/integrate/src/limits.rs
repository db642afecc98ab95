//! Limits that several modules ask for, each with the reason for its value.

/// Numbers are clamped to ± this, so that differences and squares stay finite.
pub(crate) const HUGE: f64 = 1e100;

/// Round-off of rates, at most, over what one rounding makes of their terms.
pub(crate) const ROUNDINGS: f64 = 16.0;
