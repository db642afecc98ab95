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

use nalgebra::DMatrix;

use crate::divisor_zeros::may_vanish;
use crate::events::{PARTS, Segment};
use crate::options::{Method, Options};
use crate::root::least as least_of;
use crate::system::{Failure, System};
use crate::taylor_step::LEAST_RELATIVE;

/// A minimum where `p` turns counts as zero up to this many roots of the tolerance, within this limit.
/// Errors of other methods are so many times the tolerance, of solutions as smooth.
const ROOTS: f64 = 10.0;
const MOST: f64 = 1e-2;
const OTHERS: f64 = 4.0;
/// Up to here where `p` does not turn, which is where its cosine is over this.
const TOUCHES: f64 = 1e-7;
const SAME: f64 = 0.9;
/// A minimum is judged where |p| is this many times as large again, and forgotten where it is so many times.
const PASSED: f64 = 2.0;
const FORGOTTEN: f64 = 16.0;
/// A run that can go no farther has come to a loss of rank where |p| would vanish, as it falls, within this
/// part of the time so far.
const NEAR: f64 = 1e-3;
/// A minimum is seen against what |p| was within so many of the longest steps before it.
const STEPS: f64 = 4.0;
/// Instants that are remembered: those at which |p| or its direction is another than at the last one by this
/// factor and this cosine.
const REMEMBERED: usize = 64;
const FALLS: f64 = 0.6;

/// Makes the rows of `b` (row-major, `h` rows) orthonormal; returns |det L| = |p|.
pub fn orthonormal(b: &mut [f64], h: usize) -> f64 {
    let n = b.len() / h;
    let mut size = 1.0;
    for i in 0..h {
        let (above, rest) = b.split_at_mut(i * n);
        let row = &mut rest[..n];
        let mut length = norm(row);
        for _ in 0..2 {
            let before = length;
            for other in above.chunks_exact(n) {
                let along = dot(row, other);
                row.iter_mut().zip(other).for_each(|(a, b)| *a -= along * b);
            }
            length = norm(row);
            // once is enough unless digits were lost
            if length > 0.5 * before {
                break;
            }
        }
        if length > 0.0 {
            row.iter_mut().for_each(|x| *x /= length);
        }
        size *= length;
    }
    size
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// `‖P − Q‖²`, about `2 − 2 cos` where that is small: under 1 the cosine is positive.
fn apart(p: &[f64], q: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in p.iter().zip(q) {
        sum += (a - b) * (a - b);
    }
    sum
}

/// `det(P Qᵀ)` of two matrices of `h` rows each: of orthonormal ones the cosine between their minors.
pub fn cosine(p: &[f64], q: &[f64], h: usize) -> f64 {
    let n = p.len() / h;
    DMatrix::from_fn(h, h, |i, j| dot(&p[i * n..(i + 1) * n], &q[j * n..(j + 1) * n])).determinant()
}

/// Whether `p` may vanish in a step at whose begin, in whose middle and at whose end it has these sizes and
/// rows ([`orthonormal`]), with `h` rows each.
pub fn may_lose(sizes: [f64; 3], rows: [&[f64]; 3], h: usize) -> bool {
    let turns = |p: &[f64], q: &[f64]| apart(p, q) >= 1.0 && cosine(p, q, h) <= 0.0;
    may_vanish(sizes.map(|size| size * size)) || turns(rows[0], rows[1]) || turns(rows[1], rows[2])
}

/// Whether the least |p|, at `depth` of what it was, is a loss of rank, where the cosine between before and
/// after is `turn` and the tolerance is `relative`.
fn is_lost(depth: f64, turn: f64, relative: f64) -> bool {
    depth < if turn > SAME { TOUCHES } else { (ROOTS * relative.max(LEAST_RELATIVE).sqrt()).min(MOST) }
}

/// `p` at an instant.
#[derive(Clone, Default)]
struct Minors {
    t: f64,
    size: f64,
    basis: Vec<f64>,
    /// The longest step since the one remembered before.
    step: f64,
    /// Whether it belongs to a minimum that is over.
    judged: bool,
}

impl Minors {
    /// Those of the rows at `(t, y)` times `scale`, where there is room for them.
    fn set(&mut self, system: &System, (t, y): (f64, &[f64]), scale: &[f64]) -> Result<(), Failure> {
        (self.t, self.step, self.judged) = (t, 0.0, false);
        system.rows(t, y, &mut self.basis)?;
        let n = self.basis.len() / scale.len();
        for (row, scale) in self.basis.chunks_exact_mut(n).zip(scale) {
            row.iter_mut().for_each(|x| *x *= scale);
        }
        self.size = orthonormal(&mut self.basis, scale.len());
        Ok(())
    }
}

/// `p` at ends of steps, the last one among them.
pub(crate) struct RankWatch {
    h: usize,
    start: f64,
    relative: f64,
    /// Factors of the rows: of length 1 at the start.
    scale: Vec<f64>,
    passed: VecDeque<Minors>,
    /// At the end of the step, and in its middle.
    end: Minors,
    middle: Minors,
    /// Whether the minimum among those not judged is over.
    over: bool,
    state: Vec<f64>,
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
        let room = Minors { basis: vec![0.0; h * n], ..Minors::default() };
        let mut watch = RankWatch {
            h,
            start: t,
            relative,
            scale: vec![1.0; h],
            passed: VecDeque::new(),
            end: room.clone(),
            middle: room.clone(),
            over: false,
            state: vec![0.0; y.len()],
        };
        if watch.is_on() {
            let mut start = room;
            system.rows(t, y, &mut start.basis)?;
            let factor = |length: f64| if length > 0.0 { length.recip() } else { 1.0 };
            watch.scale = start.basis.chunks_exact(n).map(|row| factor(norm(row))).collect();
            start.set(system, (t, y), &watch.scale)?;
            watch.passed.push_back(start);
        }
        Ok(watch)
    }

    pub(crate) fn is_on(&self) -> bool {
        self.h > 0
    }

    /// Whether rank has been lost by the end of a step to the state `end`.
    pub(crate) fn look(&mut self, system: &System, segment: &Segment, end: &[f64]) -> Result<Option<Lost>, Failure> {
        let Some(begin) = self.passed.back().filter(|_| self.is_on()) else { return Ok(None) };
        self.end.set(system, (segment.end, end), &self.scale)?;
        segment.state(0.5, &mut self.state);
        self.middle.set(system, (segment.time(0.5), &self.state), &self.scale)?;
        let points = [begin, &self.middle, &self.end];
        if may_lose(points.map(|p| p.size), points.map(|p| &p.basis[..]), self.h)
            && let Some((theta, least)) = self.least(system, segment)?
            && self.is_loss(&least, segment.width)
        {
            return Ok(Some(if theta > 0.0 { Lost::Inside(theta) } else { Lost::Before }));
        }
        let least = self.passed.iter().skip(1).filter(|at| !at.judged).min_by(|a, b| a.size.total_cmp(&b.size));
        self.over = least.is_some_and(|least| self.end.size >= FORGOTTEN * least.size);
        Ok(least.is_some_and(|least| self.is_loss(least, segment.width)).then_some(Lost::Before))
    }

    /// The step has been taken.
    pub(crate) fn advance(&mut self) {
        if self.over {
            self.passed.iter_mut().for_each(|at| at.judged = true);
            self.over = false;
        }
        let Some(mut last) = self.passed.pop_back() else { return };
        let step = (self.end.t - last.t).abs();
        let is_new = |before: &Minors| {
            let [low, high] = [before.size.min(last.size), before.size.max(last.size)];
            low < FALLS * high || apart(&before.basis, &last.basis) > 2.0 - 2.0 * SAME
        };
        if self.passed.back().is_none_or(is_new) {
            let room = if self.passed.len() < REMEMBERED { None } else { self.passed.pop_front() };
            self.passed.push_back(last);
            last = room.unwrap_or_else(|| self.end.clone());
            last.step = 0.0;
        }
        self.end.step = step.max(last.step);
        std::mem::swap(&mut last, &mut self.end);
        self.passed.push_back(last);
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
        let mut before = self.passed.iter().filter(|at| (least.t - at.t) * width > 0.0);
        let own = if least.step > 0.0 { least.step } else { width.abs() };
        let length = STEPS * before.clone().map(|at| at.step).fold(own, f64::max);
        let within = before.clone().filter(|at| (least.t - at.t).abs() <= length);
        within.max_by(|a, b| a.size.total_cmp(&b.size)).or_else(|| before.next_back())
    }

    fn is_loss(&self, least: &Minors, width: f64) -> bool {
        let now = &self.end;
        if now.size < PASSED * least.size {
            return false;
        }
        let Some(reference) = self.reference(least, width).or(self.passed.back()) else { return false };
        let mut before = self.passed.iter().rev().skip_while(|at| (at.t - least.t) * width > 0.0);
        // the place on the way in that mirrors the one on the way out
        let mirror = before.find(|at| at.size >= now.size).unwrap_or(reference);
        is_lost(least.size / reference.size, cosine(&mirror.basis, &now.basis, self.h), self.relative)
    }

    /// Where |p| is least within the step, and `p` there, if it may vanish in it.
    fn least(&self, system: &System, segment: &Segment) -> Result<Option<(f64, Minors)>, Failure> {
        let mut state = self.state.clone();
        let mut at = |theta: f64| {
            segment.state(theta, &mut state);
            let mut found = Minors { basis: self.end.basis.clone(), ..Minors::default() };
            found.set(system, (segment.time(theta), &state), &self.scale).map(|()| found)
        };
        let place = |part: usize| part as f64 / PARTS as f64;
        let mut points: Vec<Minors> = self.passed.back().cloned().into_iter().collect();
        for part in 1..PARTS {
            points.push(at(place(part))?);
        }
        points.push(self.end.clone());
        let may_vanish = |&part: &usize| {
            let three = [0, 1, 2].map(|i| &points[part + i]);
            may_lose(three.map(|p| p.size), three.map(|p| &p.basis[..]), self.h)
        };
        let mut least: Option<(f64, Minors)> = None;
        for range in (0..PARTS - 1).filter(may_vanish).map(|part| [place(part), place(part + 2)]) {
            let (theta, size) = least_of(|theta| at(theta).map(|found| found.size), range)?;
            if least.as_ref().is_none_or(|(_, least)| size < least.size) {
                least = Some((theta, at(theta)?));
            }
        }
        Ok(least)
    }
}
