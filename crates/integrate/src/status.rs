//! Status and work of an integration.

use thiserror::Error;

use crate::dense::DenseOutput;
use crate::problem::Start;
use crate::stall_detector::StallDetector;

/// The result of an integration.
#[derive(Clone, Debug)]
pub struct Solution {
    /// How it ended. Whatever the status, `dense` is valid up to its end.
    pub status: Status,
    /// The solution as a function of time.
    pub dense: DenseOutput,
    /// Steps and evaluations, including those of previous runs ([`Before`]).
    pub work: Work,
    /// Moves of the states by projections, including those of previous runs.
    pub projection: ProjectionReport,
    pub(crate) stall: StallDetector,
}

impl Solution {
    /// Counters for a run that continues this one: [`crate::Options::before`].
    pub fn done(&self) -> Before {
        Before { work: self.work, projection: self.projection, stall: self.stall.clone() }
    }

    /// Where it ended.
    pub(crate) fn last(&self) -> Start {
        Start { t: self.dense.end(), y: self.dense.end_state().to_vec() }
    }

    /// Goes on with what begins where this ended, after what was [`Solution::done`].
    pub(crate) fn append(&mut self, next: Solution) {
        self.dense.append(next.dense);
        (self.status, self.work, self.projection, self.stall) = (next.status, next.work, next.projection, next.stall);
    }
}

/// Counters of the runs that a run continues: limits and step counts apply to all of them together.
#[derive(Clone, Debug, PartialEq)]
pub struct Before {
    pub(crate) work: Work,
    pub(crate) projection: ProjectionReport,
    pub(crate) stall: StallDetector,
}

/// How an integration ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// The end was reached, exactly.
    Completed,
    /// The integration ended before: the dense output reaches from the start to `t`.
    Stopped {
        /// Where it stopped.
        t: f64,
        /// Why.
        cause: StopCause,
    },
}

/// Why an integration stopped before its end.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum StopCause {
    /// An event function changed sign, or reached or touched zero.
    #[error("event {index}")]
    Event {
        /// Which one, counted from 0.
        index: usize,
    },
    /// The matrix of [`crate::Problem::rows`] loses rank here.
    #[error("the constraints lose rank")]
    LosesRank,
    /// F could not be evaluated however small the step.
    #[error("the rates cannot be evaluated: {reason}")]
    Evaluation { reason: String },
    /// A rate or a state became NaN or infinite however small the step.
    #[error("component {component} of the state or of its rates is NaN or infinite")]
    NotFinite {
        /// Which one, counted from 0.
        component: usize,
    },
    /// The rates at the end of a step were not those of the Taylor series there, however small the step.
    #[error(
        "component {component} of the rates leaves its Taylor series however short the step: it is not smooth here"
    )]
    NotSmooth {
        /// Which one, counted from 0.
        component: usize,
    },
    /// A projection moved the end of a step farther than errors of steps are, however small the step.
    #[error(
        "the projection moves component {component} of the state by more than 100 tolerances however short the step: the \
         constraint is not kept by these rates"
    )]
    OffConstraint {
        /// Which one, counted from 0.
        component: usize,
    },
    /// The error estimate asked for a step that no longer moves the time.
    #[error("a step of length {step:e} is asked for, the shortest possible is {limit:e}")]
    StepTooSmall { step: f64, limit: f64 },
    /// The limit on attempted steps was reached.
    #[error("more than {limit} steps")]
    TooManySteps { limit: usize },
    /// The run stalled: many steps hardly changed the time, at a singularity, or because the motion is too
    /// fast for the length of the run.
    #[error("the last {steps} steps moved time by {moved:.1e} only: steps became too short to come to the end")]
    Creeping {
        steps: usize,
        /// Time they took together.
        moved: f64,
    },
    /// The rest needs more attempts than [`crate::Options::patience`] allows.
    #[error("{ahead:.0e} steps are ahead, where the last ones moved time by {moved:.1e}")]
    Slow {
        /// Their number, at the stall of the last ones.
        ahead: f64,
        /// Time that the last stretch of attempts took.
        moved: f64,
    },
    /// There is no memory for the polynomials of more steps.
    #[error("the steps so far take {} MB, and there is no memory for more: end earlier, or ask for fewer times",
            bytes / 1_000_000)]
    Memory { bytes: usize },
    /// [`crate::Options::interrupt`] was raised.
    #[error("interrupted")]
    Interrupted,
    /// The time that [`crate::Interrupt::within`] allows is over.
    #[error("the time limit of {seconds:?} s is over")]
    TimeLimit { seconds: f64 },
    /// The library behind the method gave up.
    #[error("the solver gave up: {reason}")]
    Solver { reason: String },
}

/// Steps and evaluations of an integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Accepted steps.
    pub steps: usize,
    /// Attempts thrown away: error too large, or evaluation impossible.
    pub rejected: usize,
    /// Evaluations of F, all of them: stages, starting step, dense output, those that failed.
    pub evaluations: usize,
    /// Evaluations of ∂F/∂y.
    pub jacobians: usize,
    /// Orders of Taylor series: one order is the coefficients of one power of time, for all components. Each
    /// series also counts as one evaluation (its order 0).
    pub orders: usize,
}

/// How far the projections moved the states (Euclidean lengths).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProjectionReport {
    /// Number of projections of accepted steps.
    pub projections: usize,
    /// The longest move.
    pub largest: f64,
    /// The sum of the moves' lengths.
    pub total: f64,
}

impl ProjectionReport {
    pub(crate) fn record(&mut self, moved: f64) {
        self.projections += 1;
        self.largest = self.largest.max(moved);
        self.total += moved;
    }
}
