//! What the referee says when it cannot answer.

use symbolic::CompileError;
use thiserror::Error;

/// The referee cannot answer.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum MaggiError {
    /// `L`, `f` or `Q` contains a name without a value, or something that is not finite.
    #[error("the system cannot be compiled: {0}")]
    Compile(#[from] CompileError),
    /// As many constraints as coordinates, or more: nothing is left to move.
    #[error("{found} constraints on {limit} coordinates leave no motion")]
    NoFreedom { found: usize, limit: usize },
    /// A slice has the wrong length.
    #[error("the {what} have {found} components, the system has {expected} coordinates")]
    Length { what: &'static str, found: usize, expected: usize },
    /// A quantity is NaN or infinite.
    #[error("{what} is {found} at t = {t}")]
    NotFinite { what: &'static str, found: f64, t: f64 },
    /// The rows of `A` are linearly dependent (or one is zero).
    #[error(
        "the constraints are dependent at t = {t}: smallest over largest pivot of their Jacobian {found}, limit {limit}"
    )]
    DependentConstraints {
        t: f64,
        /// Smallest over largest diagonal entry of the QR of `Aᵀ`, rows of length 1; 0 for a zero row.
        found: f64,
        limit: f64,
    },
    /// `[NᵀM; A]` is singular: `M` does not determine the motion along the directions left.
    #[error("the accelerations are not determined at t = {t}: smallest over largest pivot {found}, limit {limit}")]
    Singular {
        t: f64,
        /// Smallest over largest diagonal entry of the QR factorization; 0 where `M` is 0.
        found: f64,
        limit: f64,
    },
    /// The start is not on the constraint.
    #[error("the start is off the constraints by {found}, limit {limit}")]
    OffConstraint {
        /// [`super::Maggi::constraint_residual`] there.
        found: f64,
        limit: f64,
    },
    /// The integrator refuses the call.
    #[error(transparent)]
    Call(#[from] integrate::CallError),
    /// The motion is asked for a time that it does not have.
    #[error(transparent)]
    Dense(#[from] integrate::DenseError),
}
