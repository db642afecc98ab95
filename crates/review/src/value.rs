//! A review as JSON.

use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use crate::Review;

/// Whether equations of motion are right: `deltaq review --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "review/1")]
pub struct Reviewed<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Of the equations.
    pub file: &'a str,
    /// What was found.
    #[serde(flatten)]
    pub found: &'a Review,
}

pub(crate) fn named<S: Serializer>(numbers: &[(String, f64)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(numbers.iter().map(|(name, x)| (name, x)))
}
