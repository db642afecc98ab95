//! Sentences about comparisons and decisions, and numbers in a readable form.

mod decision;
mod headline;
mod numbers;

pub use decision::{decisions, how_far, sentence};
pub use headline::{Headline, rows, unseen};
pub use numbers::{enumerate, or_dash, precise, short};
