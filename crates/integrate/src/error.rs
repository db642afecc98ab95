//! Bad calls.

use thiserror::Error;

/// The call of [`crate::integrate`] makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CallError {
    /// The start state has another length than the problem's dimension.
    #[error("the start state has {found} components, the problem has {expected} unknowns")]
    Dimension {
        /// [`crate::Problem::dimension`].
        expected: usize,
        /// Length of the start state.
        found: usize,
    },
    /// The problem has no unknowns.
    #[error("the problem has {found} unknowns, at least {limit} is needed")]
    NoUnknowns {
        /// [`crate::Problem::dimension`], which is 0.
        found: usize,
        /// 1.
        limit: usize,
    },
    /// The relative tolerance is not a positive finite number below 1.
    #[error("the relative tolerance is {found:?}, it must be above 0 and below {limit}")]
    RelativeTolerance {
        /// What was given.
        found: f64,
        /// 1.
        limit: f64,
    },
    /// The absolute tolerance is not a positive finite number.
    #[error("the absolute tolerance is {found:?}, it must be finite and above {limit}")]
    AbsoluteTolerance {
        /// What was given.
        found: f64,
        /// 0.
        limit: f64,
    },
    /// Sizes were given, but not one per component.
    #[error("{found} sizes are given for {expected} unknowns")]
    Sizes {
        /// [`crate::Problem::dimension`].
        expected: usize,
        /// Length of [`crate::Options::sizes`].
        found: usize,
    },
    /// A size is not a positive finite number.
    #[error("the size of component {component} is {found}, it must be finite and above {limit}")]
    Size {
        /// Which one, counted from 0.
        component: usize,
        /// What was given.
        found: f64,
        /// 0.
        limit: f64,
    },
    /// A component of the start state is NaN or infinite.
    #[error("component {component} of the start state is {found}")]
    StartNotFinite {
        /// Which one, counted from 0.
        component: usize,
        /// Its value.
        found: f64,
    },
    /// The start time or the end time is NaN or infinite.
    #[error("the interval from {start:?} to {end:?} is not finite")]
    TimeNotFinite {
        /// Start time.
        start: f64,
        /// End time.
        end: f64,
    },
    /// Start and end are the same, or too close for a step between them.
    #[error("the interval from {start:?} to {end:?} is shorter than the spacing {limit:?} needed between them")]
    EmptyInterval {
        /// Start time.
        start: f64,
        /// End time.
        end: f64,
        /// The shortest length allowed there.
        limit: f64,
    },
    /// [`crate::Method::Taylor`] was asked for, and the problem has no Taylor series.
    #[error("the method needs Taylor series of the solution, which the problem does not have")]
    NoTaylor,
    /// The method is one of a library that was not built in ([`crate::Method::feature`]).
    #[error("the method {method} is not built in: it needs the feature `{feature}`")]
    NotBuiltIn {
        /// [`crate::Method::name`].
        method: &'static str,
        /// The feature that builds it in.
        feature: &'static str,
    },
    /// The longest step is not above 0.
    #[error("the longest step is {found:?}, it must be above {limit}")]
    MaxStep {
        /// [`crate::Options::max_step`].
        found: f64,
        /// 0.
        limit: f64,
    },
    /// A time at which a step is to end is NaN or infinite.
    #[error("breakpoint {number} is {found}, it must be finite")]
    Breakpoint {
        /// Which one, counted from 1.
        number: usize,
        /// What was given.
        found: f64,
    },
    /// No step is allowed.
    #[error("at most {found} steps are allowed, at least {limit} is needed")]
    MaxSteps {
        /// [`crate::Options::max_steps`], which is 0.
        found: usize,
        /// 1.
        limit: usize,
    },
}

/// A question the dense output cannot answer.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DenseError {
    /// The time lies outside of what was integrated.
    #[error("the time {t:?} is outside of what was integrated, {start:?} to {end:?}")]
    OutsideRange {
        /// The time asked for.
        t: f64,
        /// Start of what was integrated.
        start: f64,
        /// End of what was integrated.
        end: f64,
    },
    /// The run was made with [`crate::Dense::EndOnly`], or [`crate::Options::wanted`] has no time of the
    /// step.
    #[error("what was between {start:?} and {end:?} at {t:?} is not stored: only the ends and times asked for are")]
    NotStored {
        /// The time asked for.
        t: f64,
        /// Start of what was integrated.
        start: f64,
        /// End of what was integrated.
        end: f64,
    },
    /// The output slice has another length than the state.
    #[error("the slice for the state has {found} components, the state has {expected}")]
    Dimension {
        /// Length of the state.
        expected: usize,
        /// Length of the slice.
        found: usize,
    },
}
