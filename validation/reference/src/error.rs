//! Errors of a reference.

use equations::{EvaluationFailure, Real};
use mechanics::StartError;
use symbolic::CompileError;

/// Why there is no reference.
#[derive(Clone, Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum ReferenceError {
    /// An expression has a symbol without a value.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A removal has no start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The equations have another number of free constants.
    #[error("{found} constants are given, the equations have {expected}")]
    Constants { found: usize, expected: usize },
    /// Times are not finite, not in order, or before the start.
    #[error("time {time} is not finite, or comes after a later one, or before the start at {start}")]
    Times { time: f64, start: f64 },
    /// The equations of an instant cannot be solved.
    #[error("at t = {time}: {failure}")]
    Instant { time: f64, failure: EvaluationFailure },
    /// Equations that are to be solved at the start are singular there.
    #[error("{what} cannot be solved at t = {time}: scaled pivot {pivot:.1e}")]
    Singular { what: &'static str, time: f64, pivot: f64 },
    /// Newton's method did not converge at the start.
    #[error("{what} not solved at t = {time}: last relative step {step:.1e}, limit {limit:.0e}")]
    NotConverged { what: &'static str, time: f64, step: f64, limit: f64 },
    /// The method's steps became too short, as they do before a singularity.
    #[error("{method} stops at t = {time}: step {step:.1e}")]
    Stopped { method: &'static str, time: f64, step: f64 },
    /// The methods do not agree as well as was asked.
    #[error("the methods agree to {error:.1e}, asked were {accuracy:.0e}; the number type has {epsilon:.0e}")]
    NotReached {
        /// Largest distance between two of the runs.
        error: f64,
        accuracy: f64,
        epsilon: f64,
    },
}

impl ReferenceError {
    /// Of an instant at this time.
    pub(crate) fn at<T: Real>(time: T) -> impl FnOnce(EvaluationFailure) -> Self {
        move |failure| ReferenceError::Instant { time: time.to_f64(), failure }
    }
}
