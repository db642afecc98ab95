//! Where an event function may change its sign or touch zero within a step.

use super::{LANES, Lane, LaneProblem, Lanes};
use crate::events::{PARTS, TOUCH};
use crate::taylor_step::each;

/// A function that touches zero with a finite curvature is at most this part of what it is to one side, at
/// that of the places looked at where it is least: 1/9 where these are equally far apart.
const DIPS: f64 = 0.15;

/// The event functions up to the time reached, and the lanes in which none may vanish.
pub(super) struct Events {
    reached: Vec<Lane>,
    /// An eighth of the last step before.
    before: Vec<Lane>,
    /// Under this a function is nearly zero.
    least: Vec<Lane>,
    /// At the last three places looked at.
    older: Vec<Lane>,
    previous: Vec<Lane>,
    current: Vec<Lane>,
    pub(super) none: [bool; LANES],
}

impl Events {
    pub(super) fn new(count: usize) -> Self {
        let zeros = || vec![[0.0; LANES]; count];
        Events {
            reached: zeros(),
            before: zeros(),
            least: zeros(),
            older: zeros(),
            previous: zeros(),
            current: zeros(),
            none: [true; LANES],
        }
    }

    /// A motion begins in this lane.
    pub(super) fn board(&mut self, lane: usize) {
        self.least.iter_mut().for_each(|least| least[lane] = 0.0);
    }

    /// Whether a function may have vanished since the last place but one, in one lane after the other.
    fn judge(&mut self) {
        let values = self.older.iter().zip(&self.previous).zip(&self.current).zip(&self.least);
        for (((older, previous), current), least) in values {
            for l in 0..LANES {
                let [older, before, after] = [older[l].abs(), previous[l].abs(), current[l].abs()];
                let goes_on = previous[l] * current[l].signum() > 0.0 && after > least[l] && after.is_finite();
                let dips = before <= older && before < after && before < DIPS * older.max(after);
                self.none[l] &= goes_on && !dips;
            }
        }
    }
}

impl<P: LaneProblem> Lanes<'_, P> {
    /// Looks at event functions in parts of the step; a lane in which one may vanish is left to a single
    /// motion, which looks closer.
    pub(super) fn look_at_events(&mut self) {
        if self.events.reached.is_empty() {
            return;
        }
        let events = &mut self.events;
        events.none = [true; LANES];
        events.older.copy_from_slice(&events.before);
        events.previous.copy_from_slice(&events.reached);
        for part in 1..=PARTS {
            let theta = part as f64 / PARTS as f64;
            let t = if part == PARTS { self.taken_to } else { each(|l| self.t[l] + theta * self.taken[l]) };
            self.look_inside(&each(|l| theta * self.taken[l] / self.unit[l]));
            let last = theta.powi(self.orders as i32 - 1);
            for ((y, candidate), reached) in self.inner.iter_mut().zip(&self.candidate).zip(&self.reached) {
                *y = each(|l| y[l] + last * (candidate[l] - reached[l]));
            }
            let events = &mut self.events;
            self.problem.event_values(&t, &self.inner, &mut events.current);
            events.judge();
            std::mem::swap(&mut events.older, &mut events.previous);
            std::mem::swap(&mut events.previous, &mut events.current);
        }
    }

    /// Goes on from the ends of the steps of these lanes.
    pub(super) fn adopt_events(&mut self, lanes: &[bool; LANES]) {
        let events = &mut self.events;
        if events.reached.is_empty() {
            return;
        }
        self.problem.event_values(&self.taken_to, &self.candidate, &mut events.current);
        for (i, next) in events.current.iter().enumerate() {
            for l in (0..LANES).filter(|&l| lanes[l]) {
                // nothing is before the start of a motion
                events.before[i][l] = if self.taken[l] == 0.0 { next[l] } else { events.older[i][l] };
                events.reached[i][l] = next[l];
                events.least[i][l] = events.least[i][l].max(TOUCH * next[l].abs());
            }
        }
    }
}
