//! What the reports rest on: one program, one module per subject.

mod audit;
mod batches;
mod bench;
mod benchmark;
mod casadi;
mod changed_pages;
mod committed;
mod contradictions;
mod control;
mod environment;
mod equivalence;
mod hamilton;
mod headlines;
mod integrals;
mod ivp;
#[path = "../../crates/deltaq/tests/killed.rs"]
mod killed;
mod literature;
mod markdown;
mod mutations;
mod pages;
mod pictures;
mod program;
mod random_command;
mod realizations;
mod scaling;
mod scenery;
mod stability;
mod stamps;
#[path = "../../crates/deltaq/tests/support.rs"]
mod support;
mod trains;
mod widths;

const PROGRAM: &str = env!("CARGO_BIN_EXE_evidence");
