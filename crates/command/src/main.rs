//! The `deltaq` command. Exit code 2 for bad input; `solve` ends with 0 only where its trajectory can be trusted, and with 3 where the
//! integration had to stop or its error estimate is too large; `ensemble` likewise, for any of its members.

mod bench_command;
mod cli;
mod compare_command;
mod ensemble_command;
mod main_job;
mod random_command;
mod scaling_command;
mod show_command;
mod solve_command;
mod stability_command;

use std::io::Write;
use std::process::ExitCode;

use anyhow::Result;
use clap::Parser;

use cli::{Cli, Command};
use solve_command::Answer;

// derivations allocate much: an eighth of the time of a thousand random systems
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let answer = match run(Cli::parse()) {
        Ok(answer) => answer,
        Err(error) => {
            let mut told = error.to_string();
            for cause in error.chain().skip(1).map(ToString::to_string) {
                if !told.contains(&cause) {
                    told += &format!("\n  {cause}");
                }
            }
            eprintln!("deltaq: {told}");
            return ExitCode::from(2);
        }
    };
    // a reader that has seen enough closes the pipe; that is no error
    let _ = std::io::stdout().write_all(answer.text.as_bytes());
    match answer.complaint {
        None => ExitCode::SUCCESS,
        Some(complaint) => {
            eprintln!("deltaq: {complaint}");
            ExitCode::from(3)
        }
    }
}

fn run(cli: Cli) -> Result<Answer> {
    let text = match cli.command {
        None => main_job::run(&cli.job)?,
        Some(Command::List) => show_command::list(),
        Some(Command::Show(arguments)) => show_command::run(&arguments)?,
        Some(Command::Compare(arguments)) => compare_command::run(&arguments)?,
        Some(Command::Reports(arguments)) => main_job::check(&arguments)?,
        Some(Command::Bench(arguments)) => bench_command::run(&arguments)?,
        Some(Command::Scaling(arguments)) => scaling_command::run(&arguments)?,
        Some(Command::Random(arguments)) => return random_command::run(&arguments),
        Some(Command::Stability(arguments)) => return stability_command::run(&arguments),
        Some(Command::Ensemble(arguments)) => return ensemble_command::run(&arguments),
        Some(Command::Solve(arguments)) => return solve_command::run(&arguments),
    };
    Ok(Answer { text, complaint: None })
}
