//! The evidence: the paper's audit, scaling, stability, referees in Python, the reports.

pub mod audit;
pub mod benchmark;
pub mod casadi_job;
pub mod films;
pub mod integrals;
pub mod ivp;
pub mod report;
pub mod scaling;
pub mod stability;

use bench::KeptReferences;

/// Where [`kept_references`] stand, from the root of the project.
pub const REFERENCES: &str = "validation/references/error-vs-time.txt";

/// References of all scenes for error against run time, in double-double arithmetic, as they are the same
/// from run to run; a test computes a tenth of them anew.
///
/// # Errors
/// Where a digit of them was changed.
pub fn kept_references() -> anyhow::Result<KeptReferences> {
    KeptReferences::read(include_str!("../references/error-vs-time.txt"))
}
