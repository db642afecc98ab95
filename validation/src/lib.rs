//! The harness: scenes, the paper's audit, benchmarks, stability, referees in Python, the reports.

pub mod audit;
pub mod bench;
pub mod casadi_job;
pub mod report;
pub mod scaling;
pub mod stability;
