//! The `deltaq` command. Exit code 1 where the answer cannot be written, 2 for bad input; `solve` gives 0
//! only for a trajectory to trust, 3 where the integration had to stop or its error estimate is too large;
//! `ensemble` likewise, for any member; `prove` gives 3 without a certificate; 4 where results contradict
//! each other, which is a fault of the program.

mod answer;
mod bench_command;
mod cli;
mod columns;
mod compare_command;
mod ensemble_command;
mod explore_command;
mod linearize_command;
mod main_job;
mod prove_command;
mod random_command;
mod reports_command;
mod scene_commands;
mod schema;
mod sections;
mod show_command;
mod sink;
mod solve_command;
mod stability_command;
mod sweep_command;
mod watch;

use std::borrow::Cow;
use std::io::{self, ErrorKind, IsTerminal};
use std::process::ExitCode;

use anyhow::{Context, Error, Result};
use clap::{CommandFactory, Parser};

use answer::{Answer, Unwritten, complain, plain, print_as_is};
use cli::{Cli, Command};
use deltaq::Contradicted;
use random::parallel;

// derivations allocate much: an eighth of the time of a thousand random systems
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        // the help that was asked for is an answer, too
        Err(told) if !told.use_stderr() => {
            let help = told.render();
            let terminal = std::io::stdout().is_terminal();
            let help = if terminal { help.ansi().to_string() } else { help.to_string() };
            return print_as_is(&help).map_or_else(|error| failed(&error), |_| ExitCode::SUCCESS);
        }
        // it names what was asked for
        Err(error) if matches!(plain(&error.to_string()), Cow::Owned(_)) => {
            complain(error.to_string().trim_end());
            return ExitCode::from(2);
        }
        Err(error) => error.exit(),
    };
    match run(cli) {
        Ok(answer) => printed(&answer),
        Err(error) => failed(&error),
    }
}

fn printed(answer: &Answer) -> ExitCode {
    if let Err(error) = answer.print() {
        return failed(&error);
    }
    match &answer.complaint {
        None => ExitCode::SUCCESS,
        Some(complaint) => {
            complain(&format!("deltaq: {complaint}"));
            ExitCode::from(3)
        }
    }
}

/// The exit code of an error.
fn code(error: &Error) -> u8 {
    match () {
        () if error.is::<Unwritten>() || error.chain().any(is_full) => 1,
        () if error.is::<Contradicted>() => 4,
        () => 2,
    }
}

/// Whether there is no room for what is to be written.
fn is_full(cause: &(dyn std::error::Error + 'static)) -> bool {
    use ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull, WriteZero};
    let kind = cause.downcast_ref::<io::Error>().map(io::Error::kind);
    kind.is_some_and(|kind| matches!(kind, FileTooLarge | QuotaExceeded | StorageFull | WriteZero))
}

/// Says what went wrong, and why, unless nobody listens any more.
fn failed(error: &Error) -> ExitCode {
    let mut told = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !told.contains(&cause) {
            told += &format!("\n  {cause}");
        }
    }
    complain(&format!("deltaq: {told}"));
    ExitCode::from(code(error))
}

fn run(cli: Cli) -> Result<Answer> {
    let quiet = cli.quiet;
    if let Some(threads) = cli.threads {
        parallel::use_threads(threads.into());
    }
    let text = match cli.command {
        None => main_job::run(&cli.job, quiet)?,
        Some(Command::List(arguments)) => show_command::list(arguments.format)?,
        Some(Command::New(arguments)) => scene_commands::new(&arguments)?,
        Some(Command::Check(arguments)) => scene_commands::check(&arguments)?,
        Some(Command::Show(arguments)) => show_command::run(&arguments)?,
        Some(Command::Linearize(arguments)) => linearize_command::run(&arguments)?,
        Some(Command::Compare(arguments)) => compare_command::run(&arguments, quiet)?,
        Some(Command::Explore(arguments)) => explore_command::run(&arguments)?,
        Some(Command::Reports(arguments)) => reports_command::run(&arguments)?,
        Some(Command::Bench(arguments)) => bench_command::run(&arguments, quiet)?,
        Some(Command::Scaling(arguments)) => bench_command::scaling(&arguments, quiet)?,
        Some(Command::Completions { shell }) => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "deltaq", &mut text);
            String::from_utf8(text)?
        }
        Some(Command::Man { command }) => manual(command.as_deref())?,
        Some(Command::Prove(arguments)) => return prove_command::run(&arguments),
        Some(Command::Random(arguments)) => return random_command::run(&arguments, quiet),
        Some(Command::Stability(arguments)) => return stability_command::run(&arguments, quiet),
        Some(Command::Ensemble(arguments)) => return ensemble_command::run(&arguments, quiet),
        Some(Command::Solve(arguments)) => return solve_command::run(&arguments, quiet),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_error_has_its_exit_code() {
        let contradicted = || Error::from(Contradicted(vec!["scene: one, but another".into()]));
        let errors = [
            Error::msg("bad input"),
            Error::msg("full").context(Unwritten),
            contradicted(),
            contradicted().context("scene"),
        ];
        assert_eq!(errors.map(|error| code(&error)), [2, 1, 4, 4]);
    }
}
