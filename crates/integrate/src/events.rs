//! Sign changes of the event functions.

use crate::dense::{Basis, evaluate_segment};
use crate::root::find_root_between;
use crate::system::{Failure, System};

/// Each step is looked at in so many parts of equal length.
pub(crate) const PARTS: usize = 8;

/// A function with a pole where another is zero may change its sign before that and back behind it: it is
/// looked at so close before the zero, in parts of the way to it.
const BEFORE_ZERO: f64 = 1e-6;

/// The event functions' signs up to the time reached.
pub(crate) struct EventWatch {
    /// Values at the time reached; a function that has been zero since the start has the value 0.
    reached: Vec<f64>,
    previous: Vec<f64>,
    current: Vec<f64>,
    state: Vec<f64>,
    at_start: bool,
}

/// An event found within a step.
pub(crate) struct Found {
    pub(crate) index: usize,
    pub(crate) theta: f64,
}

/// One step's polynomial with its place in time.
pub(crate) struct Segment<'a> {
    pub(crate) basis: Basis,
    pub(crate) coefficients: &'a [f64],
    pub(crate) begin: f64,
    pub(crate) width: f64,
    /// The end time as it will be reported; `begin + width` up to round-off.
    pub(crate) end: f64,
}

impl Segment<'_> {
    pub(crate) fn time(&self, theta: f64) -> f64 {
        if theta >= 1.0 { self.end } else { self.begin + theta * self.width }
    }
}

impl EventWatch {
    pub(crate) fn new(system: &System, t: f64, y: &[f64]) -> Result<Self, Failure> {
        let events = system.events();
        let mut reached = vec![0.0; events];
        if events > 0 {
            system.event_values(t, y, &mut reached)?;
        }
        Ok(Self {
            previous: reached.clone(),
            current: reached.clone(),
            reached,
            state: vec![0.0; y.len()],
            at_start: true,
        })
    }

    /// The first event of the step, if there is one. The state of the watch changes only by `advance`.
    pub(crate) fn look(&mut self, system: &System, segment: &Segment) -> Result<Option<Found>, Failure> {
        self.previous.copy_from_slice(&self.reached);
        let mut theta = 0.0;
        for part in 1..=PARTS {
            let next = part as f64 / PARTS as f64;
            if let Some(found) = self.first_between(system, segment, theta, next)? {
                let close = found.theta - BEFORE_ZERO * (found.theta - theta);
                return Ok(Some(self.first_between(system, segment, theta, close)?.unwrap_or(found)));
            }
            std::mem::swap(&mut self.previous, &mut self.current);
            theta = next;
        }
        Ok(None)
    }

    /// The first event between `theta`, where the values are the previous ones, and `next`.
    fn first_between(
        &mut self,
        system: &System,
        segment: &Segment,
        theta: f64,
        next: f64,
    ) -> Result<Option<Found>, Failure> {
        evaluate_segment(segment.basis, segment.coefficients, next, &mut self.state);
        system.event_values(segment.time(next), &self.state, &mut self.current)?;
        let mut first: Option<Found> = None;
        for index in 0..self.current.len() {
            let (before, after) = (self.previous[index], self.current[index]);
            if before == 0.0 || before * after.signum() > 0.0 && after != 0.0 {
                continue;
            }
            let root = self.locate(system, segment, index, (theta, before), (next, after))?;
            // A zero within round-off of the start is the zero the integration started from.
            let resolution = 64.0 * f64::EPSILON * segment.begin.abs().max(segment.width.abs());
            if self.at_start && root * segment.width.abs() <= resolution {
                continue;
            }
            if first.as_ref().is_none_or(|found| root < found.theta) {
                first = Some(Found { index, theta: root });
            }
        }
        Ok(first)
    }

    /// The step has been taken.
    pub(crate) fn advance(&mut self) {
        self.reached.copy_from_slice(&self.previous);
        self.at_start = false;
    }

    fn locate(
        &mut self,
        system: &System,
        segment: &Segment,
        index: usize,
        a: (f64, f64),
        b: (f64, f64),
    ) -> Result<f64, Failure> {
        let mut values = vec![0.0; self.current.len()];
        let mut failure = None;
        let state = &mut self.state;
        let mut event = |theta: f64| {
            evaluate_segment(segment.basis, segment.coefficients, theta, state);
            match system.event_values(segment.time(theta), state, &mut values) {
                Ok(()) => values[index],
                Err(error) => {
                    failure = Some(error);
                    f64::NAN
                }
            }
        };
        let root = find_root_between(&mut event, a, b, 0.0);
        match (root, failure) {
            (Some(root), None) => Ok(root),
            (_, Some(failure)) => Err(failure),
            (None, None) => Ok(b.0),
        }
    }
}
