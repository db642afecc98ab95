//! The evidence: the paper's audit, scaling, stability, referees in Python, the reports.

pub mod audit;
pub mod benchmark;
pub mod casadi_job;
pub mod films;
pub mod integrals;
pub mod report;
pub mod scaling;
pub mod stability;
