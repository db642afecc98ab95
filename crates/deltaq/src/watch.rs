//! Progress line, and the partial result that is printed on Ctrl-C.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use anyhow::{Context, Result};
use indicatif::ProgressBar;

use program::parallel;
use program::{complain, plain, print};

/// Exit code of a program ended by SIGINT, to a shell.
const INTERRUPTED: i32 = 130;

/// How often the line on the terminal is drawn.
const TICK: Duration = Duration::from_millis(200);

/// A line on the terminal that says what is done; on Ctrl-C what there is so far is printed.
pub(crate) struct Watch {
    line: ProgressBar,
    so_far: Arc<Mutex<SoFar>>,
}

#[derive(Default)]
struct SoFar {
    answer: String,
    doing: String,
}

impl Watch {
    /// Watches from now on; no line where `quiet` or without a terminal.
    pub(crate) fn begin(quiet: bool) -> Result<Watch> {
        let watch = Watch { line: parallel::spinner(quiet), so_far: Arc::default() };
        watch.line.enable_steady_tick(TICK);
        let (line, so_far) = (watch.line.clone(), watch.so_far.clone());
        let interrupted = move || {
            line.finish_and_clear();
            let so_far = so_far.lock().unwrap_or_else(PoisonError::into_inner);
            // nothing can be done about an answer that cannot be written: it ends here
            let _ = print(&so_far.answer);
            complain(&format!("deltaq: interrupted: {}", so_far.doing));
            std::process::exit(INTERRUPTED);
        };
        ctrlc::set_handler(interrupted).context("cannot listen to Ctrl-C")?;
        Ok(watch)
    }

    /// Says what is done next, and what there is until then.
    pub(crate) fn tell(&self, doing: &str, answer: String) {
        self.line.set_message(plain(doing).into_owned());
        *self.so_far.lock().unwrap_or_else(PoisonError::into_inner) = SoFar { answer, doing: doing.to_owned() };
    }

    /// Does what writes to the terminal.
    pub(crate) fn suspended<T>(&self, work: impl FnOnce() -> T) -> T {
        self.line.suspend(work)
    }

    /// Clears the line.
    pub(crate) fn end(&self) {
        self.line.finish_and_clear();
    }
}
