//! Why there is no discrete motion.

use mechanics::StartError;
use symbolic::CompileError;
use thiserror::Error;

/// There is no discrete motion, or it ends before its time.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum DiscreteError {
    /// `L`, `f`, `Q` or the removal contains a name without a value, or something that is not finite.
    #[error("the system cannot be compiled: {0}")]
    Compile(#[from] CompileError),
    /// There are no values of `(u, u̇, w)` for the state.
    #[error(transparent)]
    Removal(#[from] StartError),
    /// As many constraints as coordinates, or more: nothing is left to move.
    #[error("{found} constraints on {limit} coordinates leave no motion")]
    NoFreedom { found: usize, limit: usize },
    /// A slice has the wrong length.
    #[error("{what}: {found} numbers where {expected} are needed")]
    Length { what: &'static str, found: usize, expected: usize },
    /// A quantity is NaN or infinite.
    #[error("{what} is {found} at t = {t}")]
    NotFinite { what: &'static str, found: f64, t: f64 },
    /// A force acts: the discrete action here has none.
    #[error("a force acts on coordinate {number}, and these discrete equations are without forces")]
    Force {
        /// Which coordinate, counted from 1.
        number: usize,
    },
    /// The removal brings in a rate that a discrete action of first order does not have.
    #[error(
        "removal `{removal}`: {what} contains `{symbol}`; only removals of first order have a discrete action here"
    )]
    HighRate { removal: String, what: &'static str, symbol: String },
    /// The start is not on the constraint.
    #[error("the start is off the constraints by {found}, limit {limit}")]
    OffConstraint {
        /// Largest `|f_i| / (|A_i| (1 + |v|))`.
        found: f64,
        limit: f64,
    },
    /// The matrix of a step is singular.
    #[error("the step from t = {t} is not determined: its matrix is singular")]
    Singular { t: f64 },
    /// Newton's method does not settle, or not at once: the root may be another one, the step is too long.
    #[error(
        "the step from t = {t} is too long: its equations are not solved after {iterations} iterations; the last changed them by {found:.1e}, limit {limit:.0e}"
    )]
    NotConverged {
        t: f64,
        iterations: usize,
        /// Largest component of the last correction, relative to 1 + the largest unknown.
        found: f64,
        limit: f64,
    },
    /// Somebody ended it on the way ([`crate::Discrete::trajectory_until`]).
    #[error("{reason}")]
    Halted { reason: String },
    /// No step is asked for.
    #[error("at least one step is needed")]
    NoSteps,
}
