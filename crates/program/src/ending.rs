//! How a program begins and ends.

use std::borrow::Cow;
use std::io::{self, ErrorKind};
use std::process::ExitCode;
#[cfg(unix)]
use std::sync::{Arc, atomic::AtomicBool};

use anyhow::{Error, Result};
use clap::Parser;
use comparison::Contradicted;
use motion::{Broken, caught};

use crate::answer::{Answer, Unwritten, complain, plain, print};

/// Result of parsing the command line.
///
/// # Errors
/// The exit code, once the help is printed or the fault is said.
pub fn parse<Asked: Parser>() -> Result<Asked, ExitCode> {
    Asked::try_parse().map_err(|told| {
        // the help that was asked for is an answer, too
        if !told.use_stderr() {
            return print(&told.to_string()).map_or_else(|error| failed(&error), |_| ExitCode::SUCCESS);
        }
        // it names what was asked for
        if matches!(plain(&told.to_string()), Cow::Owned(_)) {
            complain(told.to_string().trim_end());
            return ExitCode::from(2);
        }
        told.exit()
    })
}

/// Does the work, prints the answer, or says what went wrong, and returns the exit code.
pub fn finish(work: impl FnOnce() -> Result<Answer>) -> ExitCode {
    #[cfg(unix)]
    expect_aborts();
    let answer = caught("program", work).unwrap_or_else(|broken| Err(broken.into()));
    answer.map_or_else(|error| failed(&error), |answer| printed(&answer))
}

/// From now on an abort ends with the code of [`Broken`], as where there is no memory, which is said by then.
#[cfg(unix)]
fn expect_aborts() {
    use signal_hook::{consts::SIGABRT, flag::register_conditional_shutdown};
    // where it cannot be registered an abort ends as it does
    let _ = register_conditional_shutdown(SIGABRT, BROKEN.into(), Arc::new(AtomicBool::new(true)));
}

fn printed(answer: &Answer) -> ExitCode {
    if let Err(error) = answer.print() {
        return failed(&error);
    }
    match &answer.complaint {
        None => ExitCode::from(u8::from(answer.is_no)),
        Some(complaint) => {
            complain(&format!("deltaq: {complaint}"));
            ExitCode::from(3)
        }
    }
}

/// The exit code where a computation breaks off.
const BROKEN: u8 = 5;

/// The exit code of an error.
pub fn exit_code(error: &Error) -> u8 {
    match () {
        () if error.is::<Unwritten>() || error.chain().any(is_full) => 1,
        () if error.is::<Contradicted>() => 4,
        () if error.is::<Broken>() => BROKEN,
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
    ExitCode::from(exit_code(error))
}
