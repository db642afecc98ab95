//! Why a motion could not be computed.

use decision::DecisionError;
use discrete::DiscreteError;
use equations::{DerivationError, EvaluationFailure};
use integrate::{BoundaryError, CallError, DenseError, StopCause};
use mechanics::{RemovalError, StartError};
use scene::SceneError;
use symbolic::{Broken, CompileError, ParseError};

/// A motion that could not be started. How a motion that was started ended is [`crate::Ending`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum SolveError {
    /// The formulation has no equations for this system.
    #[error(transparent)]
    Derivation(#[from] DerivationError),
    /// The removal does not fit the system.
    #[error(transparent)]
    Removal(#[from] RemovalError),
    /// Start values of the formulation's own states could not be found.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Whether a motion is one of another formulation could not be decided.
    #[error(transparent)]
    Decision(#[from] DecisionError),
    /// The derived equations contain an unknown symbol.
    #[error("the derived equations cannot be compiled: {0}")]
    Compile(#[from] CompileError),
    /// Code is asked for where the equations of the instant take Newton's method.
    #[error(
        "{formulation}: the equations for {unknowns} are not linear in them, and are not written as code; ask for another form or \
         formulation"
    )]
    NotLinear { formulation: String, unknowns: String },
    /// The start is where a formula, as it was written, has no value.
    #[error("at the start {expression} is {value:?}: a root or logarithm of it that was written has no value")]
    OutsideDomain { expression: String, value: f64 },
    /// The equations cannot be evaluated at the start.
    #[error("at the start: {0}")]
    AtStart(EvaluationFailure),
    /// The equations cannot be evaluated at a time at which outputs are wanted.
    #[error("at t = {t:?}: {failure}")]
    Reading { t: f64, failure: EvaluationFailure },
    /// The motion was not kept at this time.
    #[error(transparent)]
    Dense(#[from] DenseError),
    /// A wrong number of free constants.
    #[error(
        "{formulation} has {expected} free constants ({names}); {found} were given (the costate of a memory variable that L does not \
         need is zero; it is not a free constant)"
    )]
    ConstantCount { formulation: String, expected: usize, names: String, found: usize },
    /// A free constant is NaN or infinite.
    #[error("{formulation}: a free constant is {value}; it must be finite")]
    ConstantNotFinite { formulation: String, value: f64 },
    /// A natural boundary condition where the formulation has none.
    #[error("{formulation} has no natural boundary condition for its free constants")]
    NoNaturalCondition { formulation: String },
    /// The horizon is not after the start.
    #[error("the horizon {horizon:?} is not after the start {start:?}")]
    Horizon { horizon: f64, start: f64 },
    /// No free constants satisfy the natural boundary condition at the horizon, as far as was found.
    #[error("natural boundary condition at the horizon {horizon:?}: {error}")]
    Boundary { horizon: f64, error: BoundaryError },
    /// The search for free constants that satisfy the natural boundary condition takes too many steps.
    #[error(
        "natural boundary condition at the horizon {horizon:?}: given up after {steps} steps in all; the search has come to motions that take far more steps \
         than the one it started from, as beside a singularity: a shorter horizon, another removal or constants that are given may help"
    )]
    Search { horizon: f64, steps: usize },
    /// The search for free constants was ended.
    #[error("natural boundary condition at the horizon {horizon:?}: not found, {cause}")]
    Ended { horizon: f64, cause: StopCause },
    /// There is no discrete motion, or it cannot be read off.
    #[error(transparent)]
    Discrete(#[from] DiscreteError),
    /// The formulation has no discrete principle.
    #[error("{formulation} has no discrete principle to step by")]
    NoPrinciple { formulation: String },
    /// The length of a step makes no sense.
    #[error(
        "a step of {step:?} over a time of {length:?}: it must be above 0 and at most that time; at most {limit} steps are possible"
    )]
    Step { step: f64, length: f64, limit: usize },
    /// No step of those of equal length ends at a breakpoint.
    #[error("no step ends at the breakpoint {t:?}: equal steps of {step:?} do not lead there")]
    Breakpoint { t: f64, step: f64 },
    /// No run can have this tolerance.
    #[error("{}", tolerance_words(*tolerance, *least))]
    Tolerance {
        tolerance: f64,
        /// The least that can be given; the limit above is 1.
        least: f64,
    },
    /// Something that is to vary is not in the scene.
    #[error(transparent)]
    Scene(Box<SceneError>),
    /// A formula cannot be read.
    #[error(transparent)]
    Formula(Box<ParseError>),
    /// A number cannot vary in an ensemble or a sweep, or a motion cannot be a member.
    #[error("{reason}")]
    Member { reason: String },
    /// A two-point problem makes no sense.
    #[error("{reason}")]
    TwoPoint { reason: String },
    /// A search was ended from outside.
    #[error("the search was ended: {cause}")]
    Interrupted { cause: StopCause },
    /// A fault of the program.
    #[error(transparent)]
    Broken(#[from] Broken),
    /// The time integrator was called wrongly.
    #[error(transparent)]
    Call(#[from] CallError),
}

fn tolerance_words(tolerance: f64, least: f64) -> String {
    match tolerance > 0.0 && tolerance < least {
        true => format!("the tolerance {tolerance:e} is below round-off; the least is {least:e}"),
        false => format!("the tolerance is {tolerance:?}; it must be above 0 and below 1"),
    }
}
