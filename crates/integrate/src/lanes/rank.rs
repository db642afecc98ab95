//! Constraints that may lose rank within a step.

use std::array::from_fn;

use super::{LANES, Lane, LaneProblem, Lanes};
use crate::rank::{may_lose, orthonormal};
use crate::taylor_step::each;

/// A lane in which the minors have come under this part of the largest ones is left to a single motion.
const LOW: f64 = 0.05;

/// Minors of the constraints at the time reached and along the step, and the lanes in which they may vanish.
pub(super) struct Ranks {
    h: usize,
    entries: Vec<Lane>,
    reached: [Minors; LANES],
    end: [Minors; LANES],
    middle: Minors,
    largest: Lane,
    pub(super) suspected: [bool; LANES],
}

/// Size, and orthonormal rows.
#[derive(Clone, Default)]
struct Minors(f64, Vec<f64>);

impl Minors {
    fn set(&mut self, entries: &[Lane], lane: usize, h: usize) {
        self.1.clear();
        self.1.extend(entries.iter().map(|x| x[lane]));
        self.0 = orthonormal(&mut self.1, h);
    }
}

impl Ranks {
    pub(super) fn new((h, n): (usize, usize)) -> Self {
        let none = || from_fn(|_| Minors::default());
        Ranks {
            h,
            entries: vec![[0.0; LANES]; h * n],
            reached: none(),
            end: none(),
            middle: Minors::default(),
            largest: [0.0; LANES],
            suspected: [false; LANES],
        }
    }

    /// A motion begins in this lane.
    pub(super) fn board(&mut self, lane: usize) {
        self.largest[lane] = 0.0;
    }

    /// Goes on from the ends of the steps of these lanes.
    pub(super) fn adopt(&mut self, lanes: &[bool; LANES]) {
        for l in (0..LANES).filter(|&l| lanes[l]) {
            std::mem::swap(&mut self.reached[l], &mut self.end[l]);
            self.largest[l] = self.largest[l].max(self.reached[l].0);
        }
    }
}

impl<P: LaneProblem> Lanes<'_, P> {
    /// Whether constraints may lose rank between the time reached and the candidates.
    pub(super) fn look_at_rank(&mut self) {
        if self.ranks.h == 0 {
            return;
        }
        self.look_inside(&each(|l| 0.5 * self.taken[l] / self.unit[l]));
        let Ranks { h, entries, reached, end, middle, largest, suspected } = &mut self.ranks;
        self.problem.rows(&self.taken_to, &self.candidate, entries);
        for (l, end) in end.iter_mut().enumerate() {
            end.set(entries, l, *h);
        }
        let t: Lane = each(|l| self.t[l] + 0.5 * self.taken[l]);
        self.problem.rows(&t, &self.inner, entries);
        for l in 0..LANES {
            middle.set(entries, l, *h);
            let (Minors(begin, basis), Minors(size, last)) = (&reached[l], &end[l]);
            suspected[l] = basis.len() == last.len() && {
                let is_low = size.is_nan() || *size < LOW * largest[l];
                is_low || may_lose([*begin, middle.0, *size], [&basis[..], &middle.1, last], *h)
            };
        }
    }
}
