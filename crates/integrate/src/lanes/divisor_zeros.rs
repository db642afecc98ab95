//! Divisors that may vanish within a step.

use super::{LANES, Lane, LaneProblem, Lanes};
use crate::divisor_zeros::may_vanish;
use crate::taylor_step::each;

/// Divisors at the time reached and along the step, and the lanes in which one may vanish.
pub(super) struct LaneDivisorZeros {
    reached: Vec<Lane>,
    middle: Vec<Lane>,
    end: Vec<Lane>,
    pub(super) suspected: [bool; LANES],
}

impl LaneDivisorZeros {
    pub(super) fn new(count: usize) -> Self {
        let zeros = vec![[0.0; LANES]; count];
        LaneDivisorZeros { reached: zeros.clone(), middle: zeros.clone(), end: zeros, suspected: [false; LANES] }
    }

    /// Goes on from the ends of the steps of these lanes.
    pub(super) fn adopt(&mut self, lanes: &[bool; LANES]) {
        for (reached, end) in self.reached.iter_mut().zip(&self.end) {
            *reached = each(|l| if lanes[l] { end[l] } else { reached[l] });
        }
    }
}

impl<P: LaneProblem> Lanes<'_, P> {
    /// Whether a divisor may vanish between the time reached and the candidates; a lane in which one does is
    /// left to a single motion, which looks closer.
    pub(super) fn look_at_divisors(&mut self) {
        if self.poles.reached.is_empty() {
            return;
        }
        let t: Lane = each(|l| self.t[l] + 0.5 * self.taken[l]);
        self.look_inside(&each(|l| 0.5 * self.taken[l] / self.unit[l]));
        let LaneDivisorZeros { reached, middle, end, suspected } = &mut self.poles;
        self.problem.divided(&t, &self.inner, middle);
        self.problem.divided(&self.taken_to, &self.candidate, end);
        for (l, suspected) in suspected.iter_mut().enumerate() {
            let values = reached.iter().zip(&*middle).zip(&*end).map(|((a, b), c)| [a[l], b[l], c[l]]);
            *suspected = values.into_iter().any(may_vanish);
        }
    }
}
