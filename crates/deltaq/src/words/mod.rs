//! What is said of a comparison and of a decision, in sentences; numbers as readers like them.

mod decision;
mod headline;
mod numbers;

pub use decision::{decisions, how_far, sentence};
pub use headline::{Headline, rows, unseen};
pub use numbers::{enumerate, or_dash, precise, short};
