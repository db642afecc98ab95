//! Long work beside Python: on a thread of its own, without the lock, ended by Ctrl-C.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use integrate::Interrupt;
use motion::caught;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use symbolic::{cancellable, work_on, worked_on};

use crate::errors;

/// Runs `work`, which is short, while other threads of Python go on.
pub(crate) fn apart<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| whole(work))
}

/// Runs `work`, which may hold Python's lock; `FaultError` where it breaks.
pub(crate) fn whole<T>(work: impl FnOnce() -> T) -> PyResult<T> {
    caught("call", work).map_err(|fault| errors::broken(&fault))
}

/// How often signals are looked at.
const POLL: Duration = Duration::from_millis(50);

/// Stack of the thread: that of a main thread, for formulas that are deep.
const STACK: usize = 16 << 20;

/// Runs `work` while other threads of Python go on. A signal handler that raises, as Ctrl-C does, raises
/// `interrupt`, which ends derivations and integrations; then the exception is handed on.
pub(crate) fn run<T: Send>(py: Python<'_>, interrupt: &Interrupt, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let (sender, mut receiver) = channel();
    scope(|threads| {
        let unwanted = interrupt.clone();
        let about = worked_on();
        let body = move || {
            work_on(about);
            let result = cancellable(move || unwanted.is_raised(), || caught("work", work));
            // The receiver is gone only after this thread is.
            let _ = sender.send(());
            result
        };
        let worker = Builder::new().stack_size(STACK).spawn_scoped(threads, body);
        let worker = worker.map_err(|error| PyRuntimeError::new_err(format!("no thread for the work: {error}")))?;
        let mut signal = Ok(());
        loop {
            let receiver = &mut receiver;
            match py.detach(move || receiver.recv_timeout(POLL)) {
                Err(RecvTimeoutError::Timeout) if signal.is_ok() => {
                    signal = py.check_signals().inspect_err(|_| interrupt.raise());
                }
                Err(RecvTimeoutError::Timeout) => {}
                Ok(()) | Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        let result = py.detach(|| worker.join()).unwrap_or_else(|panic| resume_unwind(panic));
        signal?;
        let result = result.ok_or_else(|| PyRuntimeError::new_err("the work was ended"))?;
        result.map_err(|fault| errors::broken(&fault))
    })
}
