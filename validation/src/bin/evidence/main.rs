//! The evidence: the main job, which derives, integrates and compares every scene and writes the reports;
//! random systems; stiff cases; cost over size. Exit codes are those of [`program`].

mod bench_command;
mod benchmark_command;
mod cli;
mod films_command;
mod integrals_command;
mod ivp_command;
mod main_job;
mod random_command;
mod reports_command;
mod scaling_command;
mod sections;
mod stability_command;

use std::process::ExitCode;

use anyhow::Result;

use cli::{Cli, Command};
use program::Answer;

// derivations allocate much: an eighth of the time of a thousand random systems
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    program::parse::<Cli>().map_or_else(|code| code, |cli| program::finish(|| run(cli)))
}

fn run(cli: Cli) -> Result<Answer> {
    cli.common.use_threads();
    let quiet = cli.common.quiet;
    match cli.command {
        None => main_job::run(&cli.job, quiet).map(Answer::from),
        Some(Command::Bench(arguments)) => bench_command::run(&arguments, quiet).map(Answer::from),
        Some(Command::Benchmark(arguments)) => benchmark_command::run(&arguments, quiet).map(Answer::from),
        Some(Command::Films(arguments)) => films_command::run(&arguments, quiet).map(Answer::from),
        Some(Command::Integrals(arguments)) => integrals_command::run(&arguments, quiet).map(Answer::from),
        Some(Command::Ivp(arguments)) => ivp_command::run(&arguments, quiet).map(Answer::from),
        Some(Command::Reports(arguments)) => reports_command::run(&arguments).map(Answer::from),
        Some(Command::Scaling(arguments)) => scaling_command::run(&arguments, quiet).map(Answer::from),
        Some(Command::Random(arguments)) => random_command::run(&arguments, quiet),
        Some(Command::Stability(arguments)) => stability_command::run(&arguments, quiet),
    }
}
