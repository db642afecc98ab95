//! The paper audited: which of its equations hold, as printed or corrected, and what its constants are.

mod context;
mod geometry;
mod paper;

pub use context::Context;
pub use paper::{Finding, Form, Line, Paper, Variant, Verdict, Which};
