//! Why there is no linearization.

use equations::EvaluationFailure;
use motion::SolveError;
use motion::numbers::short;
use scene::SceneErrorKind;

/// A linearization that there is not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum LinearError {
    /// The equations cannot be derived or started, or there is no motion to the time asked for.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The equations cannot be evaluated.
    #[error("at t = {t}: {failure}")]
    Evaluation { t: f64, failure: EvaluationFailure },
    /// Rates or their derivatives are infinite or NaN.
    #[error("at t = {t}: rates or their derivatives are not finite")]
    NotFinite { t: f64 },
    /// Some rate does not vanish.
    #[error(
        "the start is not a steady motion of {formulation}: {state}' = {} (tolerance {}); \
         only these may move, because no rate depends on them: {carried}",
        short(*.rate), short(*.limit)
    )]
    NotSteady {
        formulation: String,
        /// The state that moves, of those that do the one most over its limit.
        state: String,
        rate: f64,
        limit: f64,
        carried: String,
    },
    /// Rates contain the time.
    #[error(
        "the equations of {formulation} contain the time, so that no motion is steady; linearize them at a time (--at)"
    )]
    TimeDependent { formulation: String },
    /// The motion ends before.
    #[error("the motion ends at t = {end}, before t = {t}: {cause}")]
    NotReached { t: f64, end: f64, cause: String },
    /// A time before the start.
    #[error("t = {t} is before the start, t = {start}")]
    BeforeStart { t: f64, start: f64 },
    /// No coordinate of that name among the states.
    #[error("`{name}` is not a coordinate among the states of {formulation}, which are {known}")]
    UnknownFree { name: String, formulation: String, known: String },
    /// A coordinate that no rate depends on.
    #[error("no rate depends on `{name}`: it has no eigenvalue but zero")]
    CarriedFree { name: String },
    /// The QR algorithm does not converge.
    #[error("the eigenvalues of a matrix of {size} rows were not found: the QR algorithm does not converge")]
    NoEigenvalues { size: usize },
    /// The eigenvalues and their errors take longer than a question may.
    #[error("the eigenvalues stay open: {0}")]
    Stopped(#[from] symbolic::Stopped),
    /// No steady motion was found near the start.
    #[error(
        "no steady motion found near the start: after {iterations} iterations {state}' = {} (tolerance {})",
        short(*.rate), short(*.limit)
    )]
    NotFound { iterations: usize, state: String, rate: f64, limit: f64 },
    /// States that may leave the constraints.
    #[error("--find needs constraints that are linear in the velocities; these are not")]
    NotLinear,
    /// A scene that cannot start so.
    #[error("{0}")]
    Scene(Box<SceneErrorKind>),
    /// One value of a sweep.
    #[error("{name} = {value}: {error}")]
    At { name: String, value: f64, error: Box<LinearError> },
}
