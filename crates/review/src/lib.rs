//! # What is wrong with these equations of motion?

mod atoms;
mod base;
mod case;
mod error;
mod frame;
mod laws;
mod number;
mod reading;
mod review;
pub mod substitution;
mod text;

use equations::Formulation;
use scene::Scene;

pub use error::ReviewError;
pub use laws::Law;
pub use review::{Difference, Numbers, Review, Verdict};
pub use substitution::SUBSTITUTION;

/// Reviews `text`, read from `file`.
///
/// # Errors
/// [`ReviewError`], with the place.
pub fn review(
    scene: &Scene,
    file: &str,
    text: &str,
    wheres: &[String],
    formulation: &'static Formulation,
) -> Result<Review, ReviewError> {
    review::review(scene, &text::lines(file, text), wheres, formulation)
}
