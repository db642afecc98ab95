//! Why there is no judgement.

use scene::TableError;
use symbolic::CompileError;

/// A judgement that there is not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
#[non_exhaustive]
pub enum JudgeError {
    /// The table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Rates are given of some coordinates only.
    #[error("{place}: there are rates of {given} of {of} coordinates: column `{missing}` is missing")]
    SomeRates { place: String, given: usize, of: usize, missing: String },
    /// There are too few samples for differences.
    #[error("there are {found} samples, and {needed} are needed")]
    TooFew { found: usize, needed: usize },
    /// There are more samples than memory is taken for.
    #[error(
        "there are {found} samples, and of this scene at most {limit} are judged at once: leave out samples, or judge \
         a part of the motion"
    )]
    TooMany { found: usize, limit: usize },
    /// The scene has no constraint.
    #[error("the scene has no constraint, so all laws are the same")]
    Unconstrained,
    /// The mass matrix is not positive definite, so that no length of a force is defined.
    #[error("at t = {t}: the mass matrix is not positive definite")]
    MassMatrix { t: f64 },
    /// Forces and accelerations do not stand out from what differences make of the samples.
    #[error(
        "forces and accelerations are {scale:.1e}, differences of the samples are sure to {noise:.1e}: every law has this motion"
    )]
    Rest {
        /// Forces and accelerations, rms, in `√E/T`.
        scale: f64,
        /// By how much two orders of differences differ.
        noise: f64,
    },
    /// Constraints are dependent.
    #[error("at t = {t}: the constraints are dependent")]
    Dependent { t: f64 },
    /// A force, a constraint or their squares are not finite numbers.
    #[error("at t = {t}: a force or a constraint of the scene, or its square, is not finite")]
    NotFinite { t: f64 },
    /// A number of the judgement is not a finite number.
    #[error("the motion is so large that {what} is not finite: judge it in other units")]
    TooLarge { what: String },
    /// The scene cannot be evaluated.
    #[error(transparent)]
    Compile(#[from] CompileError),
}
