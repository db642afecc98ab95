//! The interface of a method to the time loop.

use crate::dense::Basis;
use crate::status::StopCause;
use crate::system::Failure;

/// The next step over the one that would just do: estimates are right to some ten per cent.
pub(crate) const SAFETY: f64 = 0.9;

/// A time-stepping method at a point `(t, y)` of its way.
///
/// The loop calls `attempt`; on a candidate it may move the candidate's state (projection), then calls
/// `finish` and then `advance`. Until `advance` the step can be taken back with `shrink`.
pub trait Stepper {
    /// Degree of the polynomials written by `finish`.
    fn degree(&self) -> usize;

    /// What the coefficients of these polynomials belong to.
    fn basis(&self) -> Basis {
        Basis::Nested
    }

    /// The time reached.
    fn time(&self) -> f64;

    /// Tries one step from the point reached, with the method's own step control. Never goes past the end.
    fn attempt(&mut self) -> Attempt;

    /// The candidate's state.
    fn candidate(&mut self) -> &mut [f64];

    /// Completes the candidate, whose state may have moved; writes the coefficients of its polynomial.
    ///
    /// # Errors
    /// Why the step cannot be taken.
    fn finish(&mut self, moved: bool, segment: Option<&mut [f64]>) -> Result<(), Failure>;

    /// Makes the candidate the point reached.
    ///
    /// # Errors
    /// Why the run cannot go on from there.
    fn advance(&mut self) -> Result<(), StopCause>;

    /// Drops the candidate; the next attempt is to be half as long.
    ///
    /// # Errors
    /// Why it cannot be.
    fn shrink(&mut self) -> Result<(), StopCause>;
}

/// What came of an attempt.
pub enum Attempt {
    /// A step whose error is within the tolerance.
    Candidate {
        /// Where it ends.
        t: f64,
        /// Attempts that were thrown away inside the method.
        rejected: usize,
    },
    /// The error was too large; the step has been shortened.
    Rejected,
    /// Not possible; a shorter step may be.
    Failed(Failure),
    /// Not possible at all.
    GaveUp(StopCause),
}

/// Length and end of the next step of a method that wants to go `step` (of either sign) from `t`, and no
/// farther than `longest`; a last step up to `stretch` times as long is better than a tiny one after it.
pub(crate) fn next_step((t, end): (f64, f64), step: f64, stretch: f64, longest: f64) -> Result<(f64, f64), StopCause> {
    let (remaining, step) = (end - t, step.clamp(-longest, longest));
    if (stretch * step.abs()).min(longest) >= remaining.abs() {
        return Ok((remaining, end));
    }
    let limit = shortest_step(t);
    if step.abs() <= limit {
        return Err(StopCause::StepTooSmall { step: step.abs(), limit });
    }
    // what is taken is what lies between two times that are numbers
    let to = t + step;
    Ok((to - t, to))
}

/// The shortest step that still moves the time `t` by more than its own round-off.
pub fn shortest_step(t: f64) -> f64 {
    (10.0 * f64::EPSILON * t.abs()).max(1e-300)
}
