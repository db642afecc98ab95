//! Grids of times at which motions are sampled.

use crate::Motion;
use crate::equidistant::equidistant;
use crate::wanted::kept_before;

impl Motion {
    /// `samples + 1` equidistant times from start to end; of a motion that was kept at some times only, the
    /// last of these before each, which may be fewer.
    pub fn grid(&self, samples: usize) -> Vec<f64> {
        let times = equidistant(self.start(), self.end(), samples + 1).map(|t| self.kept_before(t));
        let mut times: Vec<f64> = times.collect();
        if self.wanted.is_some() {
            times.dedup();
        }
        times
    }

    /// `t`, or where steps were dropped the last time before that was wanted.
    pub(crate) fn kept_before(&self, t: f64) -> f64 {
        match &self.wanted {
            Some(wanted) if t != self.end() => kept_before(wanted, self.end() >= self.start(), t),
            _ => t,
        }
    }
}
