//! Problem, start and result of an integration in lanes.

use crate::status::{ProjectionReport, Work};

/// Motions at a time.
pub const LANES: usize = 8;

/// A number for each of them.
pub type Lane = [f64; LANES];

/// A problem whose motions differ by their starts and by constants.
pub trait LaneProblem {
    /// Number of states.
    fn dimension(&self) -> usize;

    /// Number of event functions.
    fn events(&self) -> usize;

    /// Lane `lane` goes on with the motion `member`.
    fn load(&mut self, lane: usize, member: usize);

    /// Taylor coefficients as those of [`crate::Problem::taylor`]; whether they are to be trusted, by lane.
    fn taylor(&mut self, t: &Lane, y: &[Lane], unit: &Lane, coefficients: &mut [Lane]) -> [bool; LANES];

    /// `F(t, y)`, which may be NaN or infinite.
    fn rates(&mut self, t: &Lane, y: &[Lane], rates: &mut [Lane]);

    /// Moves the states onto the invariant manifold; returns the Euclidean length moved, NaN if impossible.
    fn project(&mut self, t: &Lane, y: &mut [Lane]) -> Lane;

    /// Values of the event functions.
    fn event_values(&mut self, t: &Lane, y: &[Lane], values: &mut [Lane]);

    /// Number of divisors that may vanish, as [`crate::Problem::divisors`].
    fn divisors(&self) -> usize {
        0
    }

    /// Their values.
    fn divided(&mut self, _t: &Lane, _y: &[Lane], _values: &mut [Lane]) {}

    /// As [`crate::Problem::rank`].
    fn rank(&self) -> (usize, usize) {
        (0, 0)
    }

    /// As [`crate::Problem::rows`].
    fn rows(&mut self, _t: &Lane, _y: &[Lane], _entries: &mut [Lane]) {}
}

/// Start and end of a motion.
#[derive(Clone, Debug)]
pub struct LaneStart {
    /// `t₀`.
    pub t: f64,
    /// `y(t₀)`.
    pub y: Vec<f64>,
    /// `t₁`, which is not `t₀`.
    pub end: f64,
    /// As [`crate::Options::sizes`], but never empty.
    pub sizes: Vec<f64>,
}

/// Why a motion has to be integrated alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Left {
    /// The problem does not trust its evaluation.
    #[error("the form of the equations is not to be trusted on the way")]
    Untrusted,
    /// A coefficient, a state or an event function is NaN or infinite.
    #[error("not finite on the way")]
    NotFinite,
    /// An event function changes its sign or may touch zero.
    #[error("an event on the way")]
    Event,
    /// A divisor changes its sign or comes near zero within a step.
    #[error("a divisor nearly vanishes on the way")]
    Divisor,
    /// Constraints lose rank or nearly so.
    #[error("constraints nearly lose rank on the way")]
    Rank,
    /// Steps are too short to change the time, stall, or are halved too often.
    #[error("steps too short on the way")]
    StepTooSmall,
    /// [`crate::Options::max_steps`].
    #[error("too many steps")]
    TooManySteps,
    /// [`crate::Options::interrupt`]: nothing is to be integrated any more.
    #[error("interrupted")]
    Interrupted,
}

/// A complete motion.
#[derive(Clone, Debug)]
pub struct LaneRun {
    /// The states at the times asked for, one after the other.
    pub states: Vec<f64>,
    /// Steps and evaluations.
    pub work: Work,
    /// How far the projections moved the states.
    pub projection: ProjectionReport,
    /// Ends of the shortest steps: where rates change most.
    pub shortest: Shortest,
}

/// Lengths, ends and states of the shortest steps of a run, in no order.
#[derive(Clone, Debug, Default)]
pub struct Shortest(Vec<(f64, f64, Vec<f64>)>);

impl Shortest {
    /// So many steps.
    pub const COUNT: usize = 8;

    /// Another step of this length ended there.
    pub fn add(&mut self, length: f64, t: f64, state: impl Iterator<Item = f64>) {
        if self.0.len() < Shortest::COUNT {
            self.0.push((length, t, state.collect()));
        } else if let Some(longest) = self.0.iter_mut().max_by(|a, b| a.0.total_cmp(&b.0))
            && length < longest.0
        {
            (longest.0, longest.1) = (length, t);
            longest.2.clear();
            longest.2.extend(state);
        }
    }

    /// Times and states.
    pub fn ends(self) -> Vec<(f64, Vec<f64>)> {
        self.0.into_iter().map(|(_, t, state)| (t, state)).collect()
    }
}
