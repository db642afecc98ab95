//! What several threads of Python share.

use std::sync::{Mutex, PoisonError};

use motion::caught;
use pyo3::prelude::*;

use crate::errors;

/// A value that one thread at a time works with, the only lock of this module beside Python's.
///
/// Who waits for the one while holding the other waits for ever, with everybody else. So Python's lock is
/// neither released nor taken by the work: `Send` keeps every reference to Python out of it, and errors that
/// need one are made afterwards. Work that takes long is done with Python's lock released.
#[derive(Default)]
pub(crate) struct Shared<T>(Mutex<T>);

impl<T> Shared<T> {
    pub(crate) fn new(value: T) -> Shared<T> {
        Shared(Mutex::new(value))
    }

    /// What the work gives; `FaultError` where it breaks.
    pub(crate) fn with<R: Send>(&self, work: impl FnOnce(&mut T) -> R + Send) -> PyResult<R> {
        let mut value = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        caught("shared", || work(&mut value)).map_err(|fault| errors::broken(&fault))
    }
}

impl<T: Clone + Send> Shared<T> {
    /// Its own copy for whoever asks.
    pub(crate) fn copy(&self) -> PyResult<T> {
        self.with(|value| value.clone())
    }
}
