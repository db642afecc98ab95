//! Where constraints lose rank along a solution.
//!
//! A matrix `B(t, y) ∈ Rʰˣⁿ` ([`crate::Problem::rows`]) has rank h along the solution. At an instant at which
//! it has not, several solutions go on, or none; and a step that ends near such a place may leave it along
//! another branch than it came, with all residuals small. Watched is the vector `p` of the minors of size h,
//! smooth in the entries and zero where rank is lost, by way of `B = L Q` with orthonormal rows of `Q`:
//!
//! ```text
//! |p| = |det L|,    ⟨p(a), p(b)⟩ = |p(a)| |p(b)| det(Q(a) Q(b)ᵀ)      (Cauchy–Binet)
//! ```
//!
//! Factors of rows, units and how the rows are written do not change ratios of |p| and these cosines.
//!
//! Rank is lost at a minimum of |p| that is too low against the values a step's length before it. A solution
//! known to a relative error ε passes a crossing at a distance of √ε at most, and may have turned from one
//! branch to the other there: such a minimum counts where the direction of `p` has changed. Where it has not,
//! the minimum itself has to vanish. In steps that become short towards the place this length is that of the
//! longest of the steps before.

use std::collections::VecDeque;

use crate::events::{PARTS, Segment};
use crate::options::{Method, Options};
use crate::poles::may_vanish;
use crate::system::{Failure, System};

/// A minimum where `p` turns counts as zero up to this many roots of the tolerance, within these limits. Errors
/// of other methods are so many times the tolerance, of solutions as smooth.
const ROOTS: f64 = 10.0;
const LEAST: f64 = 1e-6;
const MOST: f64 = 1e-2;
const OTHERS: f64 = 4.0;
/// Up to here where `p` does not turn, which is where its cosine is over this.
const TOUCHES: f64 = 1e-7;
const SAME: f64 = 0.9;
/// A minimum is judged where |p| is this many times as large again, and forgotten where it is so many times.
const PASSED: f64 = 2.0;
const FORGOTTEN: f64 = 16.0;
/// A run that can go no farther has come to a loss of rank where |p| would vanish, as it falls, within this part
/// of the time so far.
const NEAR: f64 = 1e-3;
/// A minimum is seen against what |p| was within so many of the longest steps before it.
const STEPS: f64 = 4.0;
/// Instants that are remembered: those at which |p| or its direction is another than at the last one by this
/// factor and this cosine.
const REMEMBERED: usize = 64;
const FALLS: f64 = 0.6;
/// The bracket of a minimum becomes shorter by eight digits.
const SECTIONS: usize = 40;
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Makes the rows of `b` (row-major, `h` rows) orthonormal; returns |det L| = |p|.
pub(crate) fn orthonormal(b: &mut [f64], h: usize) -> f64 {
    let n = b.len() / h;
    let mut size = 1.0;
    for i in 0..h {
        let (above, rest) = b.split_at_mut(i * n);
        let row = &mut rest[..n];
        for _ in 0..2 {
            for other in above.chunks_exact(n) {
                let along: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(other).for_each(|(a, b)| *a -= along * b);
            }
        }
        let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 {
            row.iter_mut().for_each(|x| *x /= length);
        }
        size *= length;
    }
    size
}

/// `det(P Qᵀ)` of two matrices of `h` rows each.
pub(crate) fn cosine(p: &[f64], q: &[f64], h: usize) -> f64 {
    let n = p.len() / h;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut m: Vec<f64> = p.chunks_exact(n).flat_map(|a| q.chunks_exact(n).map(move |b| dot(a, b))).collect();
    let mut determinant = 1.0;
    for k in 0..h {
        let best = (k..h).max_by(|&i, &j| m[i * h + k].abs().total_cmp(&m[j * h + k].abs())).unwrap_or(k);
        if best != k {
            (0..h).for_each(|j| m.swap(k * h + j, best * h + j));
            determinant = -determinant;
        }
        let pivot = m[k * h + k];
        determinant *= pivot;
        if pivot == 0.0 {
            return 0.0;
        }
        for i in k + 1..h {
            let factor = m[i * h + k] / pivot;
            (k + 1..h).for_each(|j| m[i * h + j] -= factor * m[k * h + j]);
        }
    }
    determinant
}

/// Whether `p` may vanish in a step with these sizes and these cosines to its begin in the middle and at its
/// end.
pub(crate) fn may_lose([begin, middle, end]: [f64; 3], [to_middle, to_end]: [f64; 2]) -> bool {
    may_vanish([begin, middle * to_middle, end * to_end])
        || may_vanish([begin * begin, middle * middle, end * end])
}

/// Whether the least |p|, at `depth` of what it was, is a loss of rank, where the cosine between before and
/// after is `turn` and the tolerance is `relative`.
fn is_lost(depth: f64, turn: f64, relative: f64) -> bool {
    depth < if turn > SAME { TOUCHES } else { (ROOTS * relative.sqrt()).clamp(LEAST, MOST) }
}

/// `p` at an instant.
#[derive(Clone)]
struct Minors {
    t: f64,
    size: f64,
    basis: Vec<f64>,
    /// The longest step since the one remembered before.
    step: f64,
    /// Whether it belongs to a minimum that is over.
    judged: bool,
}

/// `p` at ends of steps, the last one among them.
pub(crate) struct RankWatch {
    h: usize,
    start: f64,
    relative: f64,
    /// Factors of the rows: of length 1 at the start.
    scale: Vec<f64>,
    passed: VecDeque<Minors>,
    end: Option<Minors>,
    /// Whether the minimum among those not judged is over.
    over: bool,
    dimension: usize,
}

/// Where rank is lost: in this part of the step, or at its begin or before.
pub(crate) enum Lost {
    Inside(f64),
    Before,
}

impl RankWatch {
    pub(crate) fn new(system: &System, t: f64, y: &[f64], options: &Options) -> Result<Self, Failure> {
        let (h, n) = system.rank();
        let relative = options.relative_tolerance * if options.method == Method::Taylor { 1.0 } else { OTHERS };
        let (passed, dimension) = (VecDeque::new(), y.len());
        let mut watch = RankWatch { h, start: t, relative, scale: vec![1.0; h], passed, end: None, over: false, dimension };
        if watch.is_on() {
            let mut b = vec![0.0; h * n];
            system.rows(t, y, &mut b)?;
            let length = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
            watch.scale = b.chunks_exact(n).map(|row| if length(row) > 0.0 { length(row).recip() } else { 1.0 }).collect();
            let start = watch.minors(system, t, y)?;
            watch.passed.push_back(start);
        }
        Ok(watch)
    }

    pub(crate) fn is_on(&self) -> bool {
        self.h > 0
    }

    fn minors(&self, system: &System, t: f64, y: &[f64]) -> Result<Minors, Failure> {
        let mut basis = vec![0.0; self.h * system.rank().1];
        system.rows(t, y, &mut basis)?;
        let n = basis.len() / self.h;
        for (row, scale) in basis.chunks_exact_mut(n).zip(&self.scale) {
            row.iter_mut().for_each(|x| *x *= scale);
        }
        let size = orthonormal(&mut basis, self.h);
        Ok(Minors { t, size, basis, step: 0.0, judged: false })
    }

    fn cosine(&self, a: &Minors, b: &Minors) -> f64 {
        cosine(&a.basis, &b.basis, self.h)
    }

    /// Whether rank has been lost by the end of a step to the state `end`.
    pub(crate) fn look(&mut self, system: &System, segment: &Segment, end: &[f64]) -> Result<Option<Lost>, Failure> {
        let Some(begin) = self.passed.back().filter(|_| self.is_on()) else { return Ok(None) };
        let now = self.minors(system, segment.end, end)?;
        let mut state = vec![0.0; self.dimension];
        segment.state(0.5, &mut state);
        let middle = self.minors(system, segment.time(0.5), &state)?;
        let cosines = [self.cosine(begin, &middle), self.cosine(begin, &now)];
        let mut found = None;
        if may_lose([begin.size, middle.size, now.size], cosines) {
            let (theta, least) = self.least(system, segment, &now, &mut state)?;
            if self.is_loss(&least, &now, segment.width) {
                found = Some(if theta > 0.0 { Lost::Inside(theta) } else { Lost::Before });
            }
        }
        let least = self.passed.iter().skip(1).filter(|at| !at.judged).min_by(|a, b| a.size.total_cmp(&b.size));
        if found.is_none() && least.is_some_and(|least| self.is_loss(least, &now, segment.width)) {
            found = Some(Lost::Before);
        }
        self.over = least.is_some_and(|least| now.size >= FORGOTTEN * least.size);
        self.end = Some(now);
        Ok(found)
    }

    /// The step has been taken.
    pub(crate) fn advance(&mut self) {
        let Some(mut end) = self.end.take() else { return };
        self.passed.iter_mut().filter(|_| self.over).for_each(|at| at.judged = true);
        let Some(last) = self.passed.pop_back() else { return };
        end.step = (end.t - last.t).abs();
        let is_new = |before: &Minors| {
            let [low, high] = [before.size.min(last.size), before.size.max(last.size)];
            low < FALLS * high || self.cosine(before, &last) < SAME
        };
        if self.passed.back().is_none_or(is_new) {
            self.passed.push_back(last);
        } else {
            end.step = end.step.max(last.step);
        }
        self.passed.push_back(end);
        if self.passed.len() > REMEMBERED {
            self.passed.pop_front();
        }
    }

    /// Whether rank is being lost where a run can go no farther.
    pub(crate) fn is_near(&self) -> bool {
        let Some(last) = self.passed.back() else { return false };
        let falls = |before: &&Minors| last.size < FALLS * before.size;
        self.passed.iter().rev().find(falls).is_some_and(|before| {
            let ahead = last.size * (last.t - before.t).abs() / (before.size - last.size);
            ahead < NEAR * (last.t - self.start).abs()
        })
    }

    /// Where |p| was largest within a step's length before `least`.
    fn reference(&self, least: &Minors, width: f64) -> Option<&Minors> {
        let before = self.passed.iter().filter(|at| (least.t - at.t) * width > 0.0);
        let own = if least.step > 0.0 { least.step } else { width.abs() };
        let length = STEPS * before.clone().map(|at| at.step).fold(own, f64::max);
        let within = before.clone().filter(|at| (least.t - at.t).abs() <= length);
        within.max_by(|a, b| a.size.total_cmp(&b.size)).or_else(|| before.last())
    }

    fn is_loss(&self, least: &Minors, now: &Minors, width: f64) -> bool {
        if now.size < PASSED * least.size {
            return false;
        }
        let Some(reference) = self.reference(least, width).or(self.passed.back()) else { return false };
        let mut before = self.passed.iter().rev().skip_while(|at| (at.t - least.t) * width > 0.0);
        // the place on the way in that mirrors the one on the way out
        let mirror = before.find(|at| at.size >= now.size).unwrap_or(reference);
        is_lost(least.size / reference.size, self.cosine(mirror, now), self.relative)
    }

    /// Where |p| is least within the step, and `p` there.
    fn least(
        &self,
        system: &System,
        segment: &Segment,
        now: &Minors,
        state: &mut [f64],
    ) -> Result<(f64, Minors), Failure> {
        let mut at = |theta: f64| {
            segment.state(theta, state);
            self.minors(system, segment.time(theta), state)
        };
        let mut points: Vec<Minors> = self.passed.back().cloned().into_iter().collect();
        for part in 1..PARTS {
            points.push(at(part as f64 / PARTS as f64)?);
        }
        points.push(now.clone());
        let place = |part: usize| part.min(PARTS) as f64 / PARTS as f64;
        let mut brackets = Vec::new();
        for part in 0..PARTS {
            if self.cosine(&points[part], &points[part + 1]) < 0.0 {
                brackets.push([place(part), place(part + 1)]);
            }
        }
        for part in 0..=PARTS {
            let size = points[part].size;
            if (part == 0 || size <= points[part - 1].size) && (part == PARTS || size <= points[part + 1].size) {
                brackets.push([place(part.saturating_sub(1)), place(part + 1)]);
            }
        }
        let first = points.into_iter().zip(0..).min_by(|a, b| a.0.size.total_cmp(&b.0.size));
        let mut least = first.map_or((1.0, now.clone()), |(at, part)| (place(part), at));
        for [mut low, mut high] in brackets {
            for _ in 0..SECTIONS {
                let inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
                let [left, right] = [at(inner[0])?, at(inner[1])?];
                if left.size <= right.size { high = inner[1] } else { low = inner[0] }
                let (theta, nearer) = if left.size <= right.size { (inner[0], left) } else { (inner[1], right) };
                if nearer.size < least.1.size {
                    least = (theta, nearer);
                }
            }
        }
        Ok(least)
    }
}
