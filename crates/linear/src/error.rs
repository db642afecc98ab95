//! Why there is no linearization.

use deltaq::SolveError;
use equations::EvaluationFailure;
use scene::SceneErrorKind;

/// A linearization that there is not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// The equations cannot be derived or started, or there is no motion to the time asked for.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The equations cannot be evaluated.
    #[error("at t = {t}: {failure}")]
    Evaluation {
        /// The time.
        t: f64,
        /// What is wrong there.
        failure: EvaluationFailure,
    },
    /// Rates or their derivatives are infinite or NaN.
    #[error("at t = {t}: rates or their derivatives are not finite")]
    NotFinite {
        /// The time.
        t: f64,
    },
    /// Some rate does not vanish.
    #[error(
        "the start is no steady motion of {formulation}: {state}' = {rate:.6e}, where at most {limit:.1e} counts as none; \
         only what no rate depends on may move: {carried}"
    )]
    NotSteady {
        /// Name of the form of the formulation.
        formulation: String,
        /// The state that moves, of those that do the one most over its limit.
        state: String,
        /// Its rate.
        rate: f64,
        /// What counts as zero.
        limit: f64,
        /// The coordinates on which no rate depends.
        carried: String,
    },
    /// Rates contain the time.
    #[error(
        "the equations of {formulation} contain the time, so that no motion is steady; at a time they can be linearized"
    )]
    TimeDependent {
        /// Name of the form of the formulation.
        formulation: String,
    },
    /// The motion ends before.
    #[error("the motion ends at t = {end}, before t = {t}: {cause}")]
    NotReached {
        /// The time asked for.
        t: f64,
        /// The last time.
        end: f64,
        /// Why it ends.
        cause: String,
    },
    /// A time before the start.
    #[error("t = {t} is before the start, t = {start}")]
    BeforeStart {
        /// The time asked for.
        t: f64,
        /// That of the start.
        start: f64,
    },
    /// No coordinate of that name among the states.
    #[error("`{name}` is no coordinate among the states of {formulation}, which are {known}")]
    UnknownFree {
        /// The name.
        name: String,
        /// Name of the form of the formulation.
        formulation: String,
        /// Those that there are.
        known: String,
    },
    /// A coordinate that no rate depends on.
    #[error("no rate depends on `{name}`: it has no eigenvalue but zero")]
    CarriedFree {
        /// The coordinate.
        name: String,
    },
    /// The QR algorithm does not converge.
    #[error("the eigenvalues of a matrix of {size} rows were not found: the QR algorithm does not converge")]
    NoEigenvalues {
        /// Rows.
        size: usize,
    },
    /// No steady motion was found near the start.
    #[error(
        "no steady motion found near the start: after {iterations} iterations {state}' = {rate:.6e}, where at most {limit:.1e} counts as none"
    )]
    NotFound {
        /// Iterations made.
        iterations: usize,
        /// The state whose rate is most over its limit.
        state: String,
        /// Its rate.
        rate: f64,
        /// What counts as zero.
        limit: f64,
    },
    /// States that may leave the constraints.
    #[error("a steady motion is looked for where the constraints are linear in the velocities; these are not")]
    NotLinear,
    /// A scene that cannot start so.
    #[error("{0}")]
    Scene(Box<SceneErrorKind>),
    /// One value of a sweep.
    #[error("{name} = {value}: {error}")]
    At {
        /// What varies.
        name: String,
        /// Its value.
        value: f64,
        /// What is wrong there.
        error: Box<LinearError>,
    },
}
