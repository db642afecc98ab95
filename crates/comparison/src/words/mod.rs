//! Sentences about comparisons and decisions, and numbers in a readable form.

mod decision;
mod headline;

pub use decision::{by_half, decisions, how_far, reached, sentence};
pub use headline::{Headline, rows, unseen};
pub use motion::numbers::{at_most, enumerate, or_dash, precise, short};
