//! The free constants with which the largest gap to a motion is small: from many starts, in the norm that is
//! printed.
//!
//! ```text
//! minimize  max_k sqrt(Δqᵀ |M| Δq) ,   Δq = q(t_k; C) − q_target(t_k) ,   over C .
//! ```
//!
//! The function has many minima with kinks, so no minimum is called the least. A sweep over several orders
//! of magnitude is followed by steps to the linearized minimum from the best of its values; what comes out is
//! swept again, along each constant and in a cloud around it, until that finds nothing closer.

use equations::Equations;
use mechanics::ConstantsRule;
use nalgebra::{DMatrix, DVector};

use crate::fit::Differences;
use crate::screening::Screening;
use crate::{Metric, Motion, Setting, Settings, SolveError, solve};

/// Instants at which gaps are looked at; in sweeps every fourth, elsewhere every second.
const INSTANTS: usize = 300;
const COARSE: usize = 4;
const FINE: usize = 2;

/// Values of the first sweep, and of each sweep around what was found: along one constant, and in the cloud.
const SWEEP: usize = 240;
const ALONG: usize = 48;
const CLOUD: usize = 96;

/// Values of a sweep from which steps are made.
const STARTS: usize = 4;

/// Sweeps around what was found, at most.
const ROUNDS: usize = 8;

/// Steps of a descent, at most, and the part of the gap that one has to gain.
const STEPS: usize = 10;
const GAIN: f64 = 1e-3;

/// Steps of a run, over those of the best guess: others are far from it.
const LONGER: usize = 4;

/// Work of a search ([`Differences::work`]), a few seconds; half of it for the first sweep.
pub(crate) const WORK: usize = 60_000_000;

/// A sweep reaches from this to that many times the size of the constants, evenly in their logarithm.
const REACH: [f64; 2] = [1e-3, 4.0];

/// Parts of a motion after which a value is given up, if its gap is too large there.
const BEGINNINGS: [f64; 2] = [0.2, 0.5];

/// Steps are made from values whose gap is under this many times the best one.
const BEYOND: f64 = 1.5;

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
    let mut search = Search { differences, screening, limit, random: 0x9E37_79B9_7F4A_7C15, starts: 0 };
    let Some(mut found) = search.best_guess(guesses, settings) else { return Ok(None) };
    let is_close = search.differences.is_close(found.1);
    if is_close && !may_vanish {
        // lanes are as coarse as the first looks
        search.screening = None;
        search.differences.refine(settings);
        found.1 = search.gap(&found.0, FINE);
    }
    if !(is_close && may_vanish) {
        found = search.globally(found);
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
type Value = (Vec<f64>, f64);

struct Search {
    differences: Differences,
    screening: Option<Screening>,
    /// Work up to which new values are tried.
    limit: usize,
    random: u64,
    starts: usize,
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

    fn globally(&mut self, first: Value) -> Value {
        let sizes = self.sizes(&first.0);
        let zero = vec![0.0; sizes.len()];
        let mut values: Vec<Vec<f64>> = if sizes.len() == 1 { self.along(&zero, &sizes, 0, SWEEP) } else { Vec::new() };
        while values.len() < SWEEP {
            let center = if values.len().is_multiple_of(2) { &zero } else { &first.0 };
            values.push(self.around(center, &sizes));
        }
        let whole = self.limit;
        self.limit = whole / 2;
        let mut best = self.descended(first, values, true);
        self.limit = whole;
        for _ in 0..ROUNDS {
            let mut values: Vec<Vec<f64>> =
                (0..sizes.len()).flat_map(|j| self.along(&best.0, &sizes, j, ALONG)).collect();
            if sizes.len() > 1 {
                values.extend((0..CLOUD).map(|_| self.around(&best.0, &sizes)));
            }
            let before = best.1;
            best = self.descended(best, values, false);
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
        let ends: Vec<Value> = from.map(|value| self.descent(value)).collect();
        ends.into_iter().fold(best, |best, end| if end.1 < best.1 { end } else { best })
    }

    /// Which of the first of these values leave a gap under `bound`, that gap, and how many were looked at.
    fn under(&mut self, values: &[Vec<f64>], bound: f64) -> (Vec<Value>, usize) {
        if let Some(screening) = &self.screening {
            return screening.under(&mut self.differences, values, bound, COARSE);
        }
        let gap = self.gap_under(&values[0], bound, COARSE);
        let found = if gap < bound { vec![(values[0].clone(), gap)] } else { Vec::new() };
        (found, 1)
    }

    /// The largest gap of these constants at every `stride`-th instant; infinite without a motion.
    fn gap(&mut self, constants: &[f64], stride: usize) -> f64 {
        self.differences.largest(constants, 1.0, stride)
    }

    /// The same, and infinite where it is not under `bound`.
    fn gap_under(&mut self, constants: &[f64], bound: f64, stride: usize) -> f64 {
        let is_over = |part: f64| self.differences.largest(constants, part, COARSE) >= bound;
        if BEGINNINGS.into_iter().any(is_over) { f64::INFINITY } else { self.gap(constants, stride) }
    }

    /// For each constant the change by which the first tenth of the motion changes as much as it is long.
    fn sizes(&mut self, from: &[f64]) -> Vec<f64> {
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
    fn along(&self, center: &[f64], sizes: &[f64], j: usize, count: usize) -> Vec<Vec<f64>> {
        let [from, to] = REACH;
        let half = count / 2;
        let offset = |i: usize| sizes[j] * from * (to / from).powf(i as f64 / (half - 1) as f64);
        let moved = |by: f64| {
            let mut value = center.to_vec();
            value[j] += by;
            value
        };
        (0..half).flat_map(|i| [moved(offset(i)), moved(-offset(i))]).collect()
    }

    /// A random value around a center, dense near it.
    fn around(&mut self, center: &[f64], sizes: &[f64]) -> Vec<f64> {
        let [from, to] = REACH;
        let radius = from * (to / from).powf(self.number());
        center.iter().zip(sizes).map(|(c, size)| c + radius * size * (2.0 * self.number() - 1.0)).collect()
    }

    /// A random number in 0 … 1, the same in every search.
    fn number(&mut self) -> f64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Steps to the least largest gap of the linearized motion, as long as they gain something.
    fn descent(&mut self, start: Value) -> Value {
        let fine = self.gap(&start.0, FINE);
        let mut best = (start.0, fine);
        for _ in 0..STEPS {
            if self.differences.work > self.limit {
                break;
            }
            let Some(step) = self.linearized_step(&best.0) else { break };
            let before = best.1;
            for part in [1.0, 0.5, 0.25, 0.1, 0.03, 0.01] {
                let value: Vec<f64> = best.0.iter().zip(&step).map(|(c, s)| c + part * s).collect();
                let gap = self.gap_under(&value, best.1, FINE);
                if gap < best.1 {
                    best = (value, gap);
                    break;
                }
            }
            if best.1 > (1.0 - GAIN) * before {
                break;
            }
        }
        best
    }

    /// `δ` with the least `max_k |r_k + J_k δ|`, by Lawson's weights.
    fn linearized_step(&mut self, at: &[f64]) -> Option<DVector<f64>> {
        const STEP: f64 = 1e-4;
        const WEIGHTINGS: usize = 40;
        let rest = self.differences.at(at, 1.0, COARSE)?;
        let largest = at.iter().fold(0.0, |a: f64, c| a.max(c.abs()));
        let mut jacobian = DMatrix::zeros(rest.len(), at.len());
        for j in 0..at.len() {
            let h = STEP * at[j].abs().max(1e-2 * largest).max(f64::MIN_POSITIVE.sqrt());
            let mut moved = at.to_vec();
            moved[j] += h;
            jacobian.set_column(j, &((self.differences.at(&moved, 1.0, COARSE)? - &rest) / h));
        }
        let n = self.differences.dimension();
        let instants = rest.len() / n;
        let mut weights = vec![1.0 / instants as f64; instants];
        let mut step = DVector::zeros(at.len());
        for _ in 0..WEIGHTINGS {
            let root = DVector::from_fn(rest.len(), |i, _| weights[i / n].sqrt());
            let weighted = DMatrix::from_fn(rest.len(), at.len(), |i, j| root[i] * jacobian[(i, j)]);
            let goal = rest.component_mul(&root);
            let inverse = (weighted.transpose() * &weighted).cholesky()?;
            step = -inverse.solve(&(weighted.transpose() * goal));
            let left = &rest + &jacobian * &step;
            let lengths = left.as_slice().chunks_exact(n).map(|d| d.iter().map(|x| x * x).sum::<f64>().sqrt());
            weights.iter_mut().zip(lengths).for_each(|(w, length)| *w *= length);
            let sum: f64 = weights.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                break;
            }
            weights.iter_mut().for_each(|w| *w /= sum);
        }
        step.iter().all(|x| x.is_finite()).then_some(step)
    }
}
