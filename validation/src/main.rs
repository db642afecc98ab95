//! The `deltaq` command. Exit code 0 only where every trajectory can be trusted, 2 for bad input, 3 where an integration had to stop.

use std::process::ExitCode;

use anyhow::Result;
use clap::Parser;
use validation::cli::{Cli, Command};
use validation::{compare_command, main_job, show_command, solve_command};

fn main() -> ExitCode {
    match run(Cli::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("deltaq: {error}");
            for cause in error.chain().skip(1) {
                eprintln!("  {cause}");
            }
            ExitCode::from(2)
        }
    }
}

fn run(cli: Cli) -> Result<ExitCode> {
    match cli.command {
        None => main_job::run(&cli.job)?,
        Some(Command::List) => print!("{}", show_command::list()),
        Some(Command::Show(arguments)) => print!("{}", show_command::run(&arguments)?),
        Some(Command::Compare(arguments)) => compare_command::run(&arguments)?,
        Some(Command::Reports(arguments)) => main_job::check(&arguments)?,
        Some(Command::Solve(arguments)) => {
            let answer = solve_command::run(&arguments)?;
            print!("{}", answer.text);
            if let Some(complaint) = answer.complaint {
                eprintln!("deltaq: {complaint}");
                return Ok(ExitCode::from(3));
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}
