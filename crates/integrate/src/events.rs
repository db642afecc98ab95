//! Locates zeros of event functions: changes of sign, and zeros that are touched.

use crate::dense::{Basis, evaluate_segment};
use crate::root::{find_root_between, least};
use crate::system::{Failure, System};

/// Number of equal parts in which each step is sampled.
pub const PARTS: usize = 8;

/// A function with a pole where another is zero may change its sign twice near that zero: it is sampled at
/// this distance before the zero, as a part of the way to it.
const BEFORE_ZERO: f64 = 1e-6;

/// A function that grows again after it came under these parts of the largest value it had has touched zero.
/// Steps that follow a kink there are as short at any tolerance: sums of squares come under 4e-19.
pub(crate) const TOUCH: f64 = 1e-17;

/// The event functions' signs up to the time reached.
pub(crate) struct EventWatch {
    /// Values at the time reached; a function that has been zero since the start has the value 0.
    reached: Vec<f64>,
    /// Those an eighth of the last step before.
    before: Vec<f64>,
    /// The largest value of each at the end of a step so far.
    largest: Vec<f64>,
    /// Values at the last three points looked at.
    older: Vec<f64>,
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

    pub(crate) fn state(&self, theta: f64, y: &mut [f64]) {
        evaluate_segment(self.basis, self.coefficients, theta, y);
    }

    /// The event functions at `theta`, by way of the state there.
    fn events(&self, system: &System, theta: f64, state: &mut [f64], values: &mut [f64]) -> Result<(), Failure> {
        self.state(theta, state);
        system.event_values(self.time(theta), state, values)
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
            before: reached.clone(),
            older: reached.clone(),
            previous: reached.clone(),
            current: reached.clone(),
            largest: reached.iter().map(|value| value.abs()).collect(),
            reached,
            state: vec![0.0; y.len()],
            at_start: true,
        })
    }

    /// The first event of the step, if there is one. The state of the watch changes only by `advance`.
    pub(crate) fn look(&mut self, system: &System, segment: &Segment) -> Result<Option<Found>, Failure> {
        self.older.copy_from_slice(&self.before);
        self.previous.copy_from_slice(&self.reached);
        let mut theta = 0.0;
        for part in 1..=PARTS {
            let next = part as f64 / PARTS as f64;
            if let Some(found) = self.first_between(system, segment, theta, next)? {
                let close = found.theta - BEFORE_ZERO * (found.theta - theta);
                return Ok(Some(self.first_between(system, segment, theta, close)?.unwrap_or(found)));
            }
            if let Some(found) = self.first_touch(system, segment, part)? {
                return Ok(Some(found));
            }
            std::mem::swap(&mut self.older, &mut self.previous);
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
        segment.events(system, next, &mut self.state, &mut self.current)?;
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

    /// The first function that touches zero near the beginning of this part, or in the last one: it is least
    /// there, and nearly zero at its minimum.
    fn first_touch(&self, system: &System, segment: &Segment, part: usize) -> Result<Option<Found>, Failure> {
        /// Parts of what it is to one side, at most, where it is least: 0.58 for the root of a distance.
        const DIPS: f64 = 0.6;
        /// Or so small that steps are shorter than the dip is wide.
        const SMALL: f64 = 1e-12;
        for index in 0..self.current.len() {
            let [older, before, after] = [&self.older, &self.previous, &self.current].map(|values| values[index].abs());
            let dips = before < DIPS * older.max(after) || before < SMALL * self.largest[index];
            if before <= older && before < after && dips {
                let range = [part.saturating_sub(2), part].map(|part| part as f64 / PARTS as f64);
                let (theta, least) = self.least(system, segment, index, range)?;
                if least < TOUCH * self.largest[index] {
                    return Ok(Some(Found { index, theta }));
                }
            }
            // a zero of a high order is as flat: before this step's end, and not within reach of the next one
            if part == PARTS && after < TOUCH * self.largest[index] {
                let (theta, least) = self.least(system, segment, index, [1.0 - 1.0 / PARTS as f64, 1.0])?;
                if least < 0.5 * after {
                    return Ok(Some(Found { index, theta }));
                }
            }
        }
        Ok(None)
    }

    /// Where a function is least in size within this range, and its size.
    fn least(&self, system: &System, segment: &Segment, index: usize, range: [f64; 2]) -> Result<(f64, f64), Failure> {
        let mut values = vec![0.0; self.current.len()];
        let mut state = self.state.clone();
        let size = |theta: f64| segment.events(system, theta, &mut state, &mut values).map(|()| values[index].abs());
        least(size, range)
    }

    /// The step has been taken.
    pub(crate) fn advance(&mut self) {
        self.before.copy_from_slice(&self.older);
        self.reached.copy_from_slice(&self.previous);
        self.largest.iter_mut().zip(&self.reached).for_each(|(largest, value)| *largest = largest.max(value.abs()));
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
        let mut event = |theta: f64| match segment.events(system, theta, state, &mut values) {
            Ok(()) => values[index],
            Err(error) => {
                failure = Some(error);
                f64::NAN
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
