//! The paper audited: which of its equations hold, as printed or corrected, and what its constants are.

mod action;
mod along;
mod constants;
mod context;
mod examples;
mod geometry;
mod paper;
mod stationarity;

pub use action::{BUMPS, Jet, bump};
pub use constants::{Constants, HORIZONS};
pub use examples::{Example, cone, refusal};
pub use paper::{Finding, Form, Line, Paper, Variant, Verdict, Which};
pub use stationarity::{Reading, STATEMENT, Stationarity};
