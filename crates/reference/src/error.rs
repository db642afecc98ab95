//! What can go wrong.

use mechanics::StartError;
use symbolic::CompileError;

/// Why there is no reference.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ReferenceError {
    /// An expression has a symbol without a value.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A removal has no start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The equations have another number of free constants.
    #[error("{found} constants are given, the equations have {expected}")]
    Constants {
        /// How many were given.
        found: usize,
        /// How many there are.
        expected: usize,
    },
    /// Times are not finite, not in order, or before the start.
    #[error("time {time} is not finite, or comes after a later one, or before the start at {start}")]
    Times {
        /// The first such time.
        time: f64,
        /// `t₀`.
        start: f64,
    },
    /// Equations that are to be solved at one point are singular there.
    #[error("{what} cannot be solved at t = {time}: scaled pivot {pivot:.1e}")]
    Singular {
        /// What was solved.
        what: &'static str,
        /// Where.
        time: f64,
        /// Smallest scaled pivot.
        pivot: f64,
    },
    /// Newton's method did not converge at the start or at an instant.
    #[error("{what} not solved at t = {time}: last relative step {step:.1e}, limit {limit:.0e}")]
    NotConverged {
        /// What was solved.
        what: &'static str,
        /// Where.
        time: f64,
        /// Relative length of the last step.
        step: f64,
        /// Length at which the iteration ends.
        limit: f64,
    },
    /// The method's steps became too short, as they do before a singularity.
    #[error("{method} stops at t = {time}: step {step:.1e}")]
    Stopped {
        /// The method.
        method: &'static str,
        /// How far it came.
        time: f64,
        /// Length of the step that was not accepted.
        step: f64,
    },
    /// The methods do not agree as well as was asked.
    #[error("the methods agree to {error:.1e}, asked were {accuracy:.0e}; the number type has {epsilon:.0e}")]
    NotReached {
        /// Largest distance between two of the runs.
        error: f64,
        /// What was asked.
        accuracy: f64,
        /// Relative spacing of the number type.
        epsilon: f64,
    },
}
