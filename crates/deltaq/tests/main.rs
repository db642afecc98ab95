//! The program as a person meets it, run as a process: one program, one module per subject.

mod bad_scenes;
mod bombs;
mod borders;
mod columns;
mod commands;
mod compare_command;
mod connect_command;
mod documents;
mod ensemble_command;
mod examples;
mod explore_command;
mod fit_command;
mod grammar;
mod integrals_command;
mod judge_command;
mod killed;
mod kills;
mod linearize_command;
mod members;
mod memory;
mod output;
mod patience;
mod prove_command;
mod read_back;
mod review_command;
mod shell;
mod singularities;
mod smallest;
mod support;
mod sweep;
mod tutorials;
mod unusual;

const PROGRAM: &str = env!("CARGO_BIN_EXE_deltaq");
