//! The `deltaq` command.
//!
//! Exit codes: 0 for an answer that can be trusted; 1 if it cannot be written, or `review` finds equations
//! wrong; 2 for bad input. 3 for a trajectory that stops early or whose error estimate is too large (`solve`,
//! any member of `ensemble`), without a certificate (`prove`), without a law or formulation that fits
//! (`judge`, `fit`), or if nothing can be told (`review`). 4 if results contradict each other, 5 if a
//! computation breaks off: both are faults of the program.

mod cli;
mod columns;
mod compare_command;
mod connect_command;
mod design_command;
mod ensemble_command;
mod explore_command;
mod fit_command;
mod fit_pictures;
mod grid;
mod integrals_command;
mod judge_command;
mod linearize_command;
mod prove_command;
mod review_command;
mod scene_commands;
mod schema;
mod show_command;
mod solve_command;
mod sweep_command;
mod watch;

use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, Result};
use clap::CommandFactory;

use cli::{Cli, Command};
use program::Answer;

fn main() -> ExitCode {
    program::parse::<Cli>().map_or_else(|code| code, |cli| program::finish(|| run(cli)))
}

fn run(cli: Cli) -> Result<Answer> {
    cli.common.use_threads();
    symbolic::be_patient((cli.patience > 0).then(|| Duration::from_secs(cli.patience.into())));
    let quiet = cli.common.quiet;
    let text = match cli.command {
        Command::List(arguments) => show_command::list(arguments.format)?,
        Command::New(arguments) => scene_commands::new(&arguments)?,
        Command::Check(arguments) => scene_commands::check(&arguments)?,
        Command::Show(arguments) => show_command::run(&arguments)?,
        Command::Linearize(arguments) => linearize_command::run(&arguments)?,
        Command::Compare(arguments) => compare_command::run(&arguments, quiet)?,
        Command::Explore(arguments) => explore_command::run(&arguments)?,
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "deltaq", &mut text);
            String::from_utf8(text)?
        }
        Command::Schema { kind } => schema::of_answer(kind.as_deref())?,
        Command::Man { command } => manual(command.as_deref())?,
        Command::Integrals(arguments) => return integrals_command::run(&arguments, quiet),
        Command::Design(arguments) => return design_command::run(&arguments),
        Command::Fit(arguments) => return fit_command::run(&arguments),
        Command::Judge(arguments) => return judge_command::run(&arguments),
        Command::Review(arguments) => return review_command::run(&arguments),
        Command::Prove(arguments) => return prove_command::run(&arguments),
        Command::Connect(arguments) => return connect_command::run(&arguments),
        Command::Ensemble(arguments) => return ensemble_command::run(&arguments, quiet),
        Command::Solve(arguments) => return solve_command::run(&arguments, quiet),
    };
    Ok(text.into())
}

/// The page of the manual about the program, or about one of its commands.
fn manual(command: Option<&str>) -> Result<String> {
    let mut program = Cli::command();
    program.build();
    let about = match command {
        None => &program,
        Some(name) => program.find_subcommand(name).with_context(|| format!("there is no command `{name}`"))?,
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(about.clone()).render(&mut text)?;
    Ok(String::from_utf8(text)?)
}
