//! Errors of wrong calls.

use thiserror::Error;

/// The call of [`crate::integrate`] makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum CallError {
    /// The start state has another length than the problem's dimension.
    #[error("the start state has {found} components, the problem has {expected} unknowns")]
    Dimension { expected: usize, found: usize },
    /// The problem has no unknowns.
    #[error("the problem has {found} unknowns, at least {limit} is needed")]
    NoUnknowns { found: usize, limit: usize },
    /// The relative tolerance is not a positive finite number below 1.
    #[error("the relative tolerance is {found:?}, it must be above 0 and below {limit}")]
    RelativeTolerance { found: f64, limit: f64 },
    /// The absolute tolerance is not a positive finite number.
    #[error("the absolute tolerance is {found:?}, it must be finite and above {limit}")]
    AbsoluteTolerance { found: f64, limit: f64 },
    /// Sizes were given, but not one per component.
    #[error("{found} sizes are given for {expected} unknowns")]
    Sizes { expected: usize, found: usize },
    /// A size is not a positive finite number.
    #[error("the size of component {component} is {found}, it must be finite and above {limit}")]
    Size {
        /// Which one, counted from 0.
        component: usize,
        found: f64,
        limit: f64,
    },
    /// A component of the start state is NaN or infinite.
    #[error("component {component} of the start state is {found}")]
    StartNotFinite {
        /// Which one, counted from 0.
        component: usize,
        found: f64,
    },
    /// The start time or the end time is NaN or infinite.
    #[error("the interval from {start:?} to {end:?} is not finite")]
    TimeNotFinite { start: f64, end: f64 },
    /// Start and end are the same, or too close for a step between them.
    #[error("the interval from {start:?} to {end:?} is shorter than the spacing {limit:?} needed between them")]
    EmptyInterval { start: f64, end: f64, limit: f64 },
    /// [`crate::Method::Taylor`] was asked for, and the problem has no Taylor series.
    #[error("the method needs Taylor series of the solution, which the problem does not have")]
    NoTaylor,
    /// The longest step is not above 0.
    #[error("the longest step is {found:?}, it must be above {limit}")]
    MaxStep { found: f64, limit: f64 },
    /// A time at which a step is to end is NaN or infinite.
    #[error("breakpoint {number} is {found}, it must be finite")]
    Breakpoint {
        /// Which one, counted from 1.
        number: usize,
        found: f64,
    },
    /// No step is allowed.
    #[error("at most {found} steps are allowed, at least {limit} is needed")]
    MaxSteps { found: usize, limit: usize },
}

/// A question the dense output cannot answer.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum DenseError {
    /// The time lies outside of what was integrated.
    #[error("the time {t:?} is outside of what was integrated, {start:?} to {end:?}")]
    OutsideRange { t: f64, start: f64, end: f64 },
    /// The run was made with [`crate::Dense::EndOnly`], or [`crate::Options::wanted`] has no time of the
    /// step.
    #[error("what was between {start:?} and {end:?} at {t:?} is not stored: only the ends and times asked for are")]
    NotStored { t: f64, start: f64, end: f64 },
    /// The output slice has another length than the state.
    #[error("the slice for the state has {found} components, the state has {expected}")]
    Dimension { expected: usize, found: usize },
}
