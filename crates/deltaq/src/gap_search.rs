//! The free constants with which the largest gap to a motion is small: from many starts, in the norm that is
//! printed.
//!
//! ```text
//! minimize  max_k sqrt(Δqᵀ |M| Δq) ,   Δq = q(t_k; C) − q_target(t_k) ,   over C .
//! ```
//!
//! The function has many minima with kinks, so no minimum is called the least. Constants that meet the
//! beginning are followed as more and more of the motion is asked for; a sweep over several orders of
//! magnitude is followed by steps to the linearized minimum from the best of its values; what comes out is
//! swept again, along each constant and in a cloud around it, until that finds nothing closer; a population
//! goes on from there, and steps with fine differences end the search.

use equations::Equations;
use mechanics::ConstantsRule;

use crate::fit::Differences;
use crate::screening::Screening;
use crate::{Metric, Motion, Setting, Settings, SolveError, solve};

/// Instants at which gaps are looked at; in sweeps every fourth, elsewhere every second.
const INSTANTS: usize = 300;
pub(crate) const COARSE: usize = 4;
pub(crate) const FINE: usize = 2;

/// Values of the first sweep, and of each sweep around what was found: along one constant, and in the cloud.
const SWEEP: usize = 240;
const ALONG: usize = 48;
const CLOUD: usize = 96;

/// Values of a sweep from which steps are made.
const STARTS: usize = 4;

/// Sweeps around what was found, at most.
const ROUNDS: usize = 8;

/// A sweep has to gain this part of the gap.
pub(crate) const GAIN: f64 = 1e-3;

/// Derivatives by a constant are differences over this part of it, as the runs are coarse or fine.
const DIFFERENCE: [f64; 2] = [1e-4, 1e-7];

/// Steps of a run, over those of the best guess: others are far from it.
const LONGER: usize = 4;

/// Work of a search ([`Differences::work`]), a few seconds; half of it for the first sweep.
pub(crate) const WORK: usize = 60_000_000;

/// A sweep reaches from this to that many times the size of the constants, evenly in their logarithm.
const REACH: [f64; 2] = [1e-3, 4.0];

/// Parts of a motion after which a value is given up, if its gap is too large there.
const BEGINNINGS: [f64; 2] = [0.2, 0.5];

/// Steps are made from values whose gap is under this many times the best one.
pub(crate) const BEYOND: f64 = 1.5;

/// What a search came to.
pub(crate) struct Closest {
    /// The motion.
    pub motion: Motion,
    /// Values of the constants that were tried as starts.
    pub starts: usize,
}

/// Where a search begins, how it sweeps, and where it may end.
pub(crate) struct Aim<'a> {
    /// Constants to begin from.
    pub guesses: &'a [Vec<f64>],
    /// What sweeps go by; without, they go value by value.
    pub screening: Option<Screening>,
    /// Work up to which new values are tried ([`Differences::work`]).
    pub limit: usize,
    /// Whether some constants may leave no gap at all: then a small one that Gauss-Newton steps reach is
    /// taken for what round-off leaves of that.
    pub may_vanish: bool,
}

/// Searches from the guesses and many other values. `None` where no guess leads to a motion.
///
/// # Errors
/// [`SolveError`] where the motion cannot be started or `target` cannot be read off.
pub(crate) fn closest(
    setting: Setting,
    equations: &Equations,
    target: &mut Motion,
    aim: Aim,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Closest>, SolveError> {
    let end = target.end();
    let differences = Differences::new(setting, equations, target, INSTANTS, metric, settings)?;
    let Aim { guesses, screening, limit, may_vanish } = aim;
    let [part, finer] = DIFFERENCE;
    let mut search =
        Search { differences, screening, limit, part, sizes: Vec::new(), random: 0x9E37_79B9_7F4A_7C15, starts: 0 };
    let Some(mut found) = search.best_guess(guesses, settings) else { return Ok(None) };
    let is_close = search.differences.is_close(found.1);
    if is_close && !may_vanish {
        // lanes are as coarse as the first looks
        search.screening = None;
        search.differences.refine(settings);
        found.1 = search.gap(&found.0, FINE);
    }
    if !(is_close && may_vanish) {
        found = search.globally(found, may_vanish);
        // valleys may be narrower than coarse differences see
        search.differences.refine(settings);
        search.part = finer;
        search.limit = search.differences.work.saturating_add(limit / 4);
        found.1 = f64::INFINITY;
        loop {
            let before = found.1;
            found = search.descent(found, 1.0);
            if found.1 > (1.0 - GAIN) * before {
                break;
            }
        }
        if may_vanish
            && search.differences.is_close(found.1)
            && let Some(exact) = search.differences.squares(&found.0, settings)
        {
            found.0 = exact;
        }
    }
    let constants = found.0;
    let motion = solve(Setting { end, ..setting }, equations.clone(), &ConstantsRule::Given(constants), settings)?;
    Ok(Some(Closest { motion, starts: search.starts }))
}

/// Constants and the largest gap that they leave.
pub(crate) type Value = (Vec<f64>, f64);

pub(crate) struct Search {
    pub(crate) differences: Differences,
    screening: Option<Screening>,
    /// Work up to which new values are tried.
    pub(crate) limit: usize,
    /// Derivatives are differences over this part of a constant.
    pub(crate) part: f64,
    /// For each constant the change by which the first tenth of the motion changes as much as it is long.
    pub(crate) sizes: Vec<f64>,
    random: u64,
    pub(crate) starts: usize,
}

impl Search {
    /// The closest of the guesses, and of what the sum of squares has near it.
    fn best_guess(&mut self, guesses: &[Vec<f64>], settings: &Settings) -> Option<Value> {
        let mut all: Vec<Value> = guesses.iter().map(|guess| (guess.clone(), self.gap(guess, FINE))).collect();
        self.starts += all.len();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let first = all.first().filter(|value| value.1.is_finite())?.clone();
        self.differences.limit_steps(&first.0, LONGER);
        let by_squares = self.differences.squares(&first.0, settings);
        let by_squares = by_squares.map(|constants| (constants.clone(), self.gap(&constants, FINE)));
        Some(by_squares.filter(|value| value.1 < first.1).unwrap_or(first))
    }

    /// The best of what grows with the motion, of a sweep, of sweeps around the best of it, and of a
    /// population. Where constants are found that may leave no gap at all, no others are tried.
    fn globally(&mut self, mut best: Value, may_vanish: bool) -> Value {
        self.sizes = self.sizes_at(&best.0);
        let (n, whole, zero) = (self.sizes.len(), self.limit, vec![0.0; self.sizes.len()]);
        self.limit = whole / 2;
        for from in [best.0.clone(), zero.clone()] {
            let grown = self.grown(from);
            best = if grown.1 < best.1 { grown } else { best };
        }
        if may_vanish && self.differences.is_close(best.1) {
            return best;
        }
        let mut values: Vec<Vec<f64>> = if n == 1 { self.along(&zero, 0, SWEEP) } else { Vec::new() };
        while values.len() < SWEEP {
            let center = if values.len().is_multiple_of(2) { &zero } else { &best.0 };
            values.push(self.around(center));
        }
        best = self.descended(best, values, true);
        for _ in 0..ROUNDS {
            let mut values: Vec<Vec<f64>> = (0..n).flat_map(|j| self.along(&best.0, j, ALONG)).collect();
            if n > 1 {
                values.extend((0..CLOUD).map(|_| self.around(&best.0)));
            }
            let before = best.1;
            self.limit = whole;
            best = self.descended(best, values, false);
            if best.1 > (1.0 - GAIN) * before {
                self.limit = whole + whole / 3;
                best = self.evolved(best);
            }
            if best.1 > (1.0 - GAIN) * before {
                break;
            }
        }
        best
    }

    /// The best of `best` and of where the descents from the best of these values lead.
    fn descended(&mut self, best: Value, values: Vec<Vec<f64>>, first: bool) -> Value {
        let mut bound = best.1 * BEYOND;
        let mut all: Vec<Value> = Vec::new();
        let mut left = &values[..];
        while !left.is_empty() && self.differences.work <= self.limit {
            let (found, looked_at) = self.under(left, bound);
            left = &left[looked_at..];
            self.starts += looked_at;
            all.extend(found);
            all.sort_by(|a, b| a.1.total_cmp(&b.1));
            all.truncate(STARTS);
            bound = if all.len() == STARTS { bound.min(all[STARTS - 1].1) } else { bound };
        }
        let from = std::iter::once(best.clone()).filter(|_| first).chain(all);
        let ends: Vec<Value> = from.map(|value| self.descent(value, 1.0)).collect();
        ends.into_iter().fold(best, |best, end| if end.1 < best.1 { end } else { best })
    }

    /// Which of the first of these values leave a gap under `bound`, that gap, and how many were looked at.
    pub(crate) fn under(&mut self, values: &[Vec<f64>], bound: f64) -> (Vec<Value>, usize) {
        if let Some(screening) = &self.screening {
            return screening.under(&mut self.differences, values, bound, COARSE);
        }
        let gap = self.gap_under(&values[0], bound, 1.0, COARSE);
        let found = if gap < bound { vec![(values[0].clone(), gap)] } else { Vec::new() };
        (found, 1)
    }

    /// The largest gap of these constants at every `stride`-th instant; infinite without a motion.
    fn gap(&mut self, constants: &[f64], stride: usize) -> f64 {
        self.differences.largest(constants, 1.0, stride)
    }

    /// The same up to this part of the motion, and infinite where it is not under `bound`.
    pub(crate) fn gap_under(&mut self, constants: &[f64], bound: f64, part: f64, stride: usize) -> f64 {
        let is_over = |beginning: f64| self.differences.largest(constants, beginning * part, COARSE) >= bound;
        let is_far = BEGINNINGS.into_iter().any(is_over);
        if is_far { f64::INFINITY } else { self.differences.largest(constants, part, stride) }
    }

    /// For each constant the change by which the first tenth of the motion changes as much as it is long.
    fn sizes_at(&mut self, from: &[f64]) -> Vec<f64> {
        const PART: f64 = 0.1;
        let way = self.differences.way(PART, COARSE);
        let Some(at) = self.differences.at(from, PART, COARSE) else { return vec![1.0; from.len()] };
        let mut size = |j: usize| {
            let mut size = 1.0_f64;
            let (mut grown, mut shrunk) = (false, false);
            for _ in 0..30 {
                let mut moved = from.to_vec();
                moved[j] += size;
                let change = self.differences.at(&moved, PART, COARSE);
                let change = change.map_or(f64::INFINITY, |there| (there - &at).norm());
                (grown, shrunk) = (grown || change <= way, shrunk || change > way);
                if grown && shrunk {
                    break;
                }
                size *= if change > way { 0.25 } else { 4.0 };
            }
            size.max(from[j].abs())
        };
        (0..from.len()).map(&mut size).collect()
    }

    /// Values of the `j`-th constant on both sides of a center, dense near it.
    fn along(&self, center: &[f64], j: usize, count: usize) -> Vec<Vec<f64>> {
        let [from, to] = REACH;
        let half = count / 2;
        let offset = |i: usize| self.sizes[j] * from * (to / from).powf(i as f64 / (half - 1) as f64);
        let moved = |by: f64| {
            let mut value = center.to_vec();
            value[j] += by;
            value
        };
        (0..half).flat_map(|i| [moved(offset(i)), moved(-offset(i))]).collect()
    }

    /// A random value around a center, dense near it.
    fn around(&mut self, center: &[f64]) -> Vec<f64> {
        let [from, to] = REACH;
        let radius = from * (to / from).powf(self.number());
        let offset = |search: &mut Self, j: usize| radius * search.sizes[j] * (2.0 * search.number() - 1.0);
        center.iter().enumerate().map(|(j, c)| c + offset(self, j)).collect()
    }

    /// A random number in 0 … 1, the same in every search.
    pub(crate) fn number(&mut self) -> f64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 11) as f64 / (1_u64 << 53) as f64
    }
}
