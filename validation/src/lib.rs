//! The harness behind the `deltaq` command: scenes, the control formulation, the commands, the reports.

pub mod audit;
pub mod bench;
pub mod bench_command;
pub mod casadi_job;
pub mod catalogue;
pub mod cli;
pub mod compare_command;
pub mod ensemble_command;
pub mod main_job;
pub mod parallel;
pub mod picture;
pub mod python_environment;
pub mod random;
pub mod random_command;
pub mod realization;
pub mod report;
pub mod scaling;
pub mod scaling_command;
pub mod show_command;
pub mod solve_command;
pub mod stability;
pub mod stability_command;
pub mod substitution;
pub mod trailer;
