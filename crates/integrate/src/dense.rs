//! The solution as a function of time.

use std::sync::Arc;

use crate::error::DenseError;

/// Coefficients of one run beyond which steps are dropped in which the solution is not wanted: 2 MB.
const ROOM: usize = 1 << 18;
/// Numbers for which there has to be memory beside them: 64 MB.
const BESIDE: usize = 1 << 23;

/// Piecewise polynomial; valid between its [`start`](DenseOutput::start) and [`end`](DenseOutput::end).
///
/// On the step from `t_k` to `t_k + h`, with `θ = (t − t_k)/h`, each component is
///
/// ```text
/// y(θ) = c₀ + θ (c₁ + (1−θ) (c₂ + θ (c₃ + (1−θ) (c₄ + …))))
/// ```
///
/// (Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.10), for
/// [`crate::Method::Taylor`] `c₀ + θ (c₁ + θ (c₂ + …))`. Continuous, also where a projection moved its end.
#[derive(Clone, Debug)]
pub struct DenseOutput {
    basis: Basis,
    dimension: usize,
    /// Coefficients a component and step.
    terms: usize,
    /// The start, then the end of each step, or of all together where only the ends are stored.
    times: Vec<f64>,
    start_state: Vec<f64>,
    end_state: Vec<f64>,
    /// The k-th stored step begins at `begins[k]` and has the length `widths[k]`, of either sign.
    begins: Vec<f64>,
    widths: Vec<f64>,
    /// Step after step, in the order of the basis. Empty: ends only.
    coefficients: Vec<f64>,
    /// [`crate::Options::wanted`].
    wanted: Option<Arc<[f64]>>,
    /// How many of the stored steps have been checked against `wanted`; `None` as long as all are kept.
    thinned: Option<usize>,
}

impl DenseOutput {
    pub(crate) fn new(t: f64, y: &[f64], basis: Basis, degree: usize, wanted: Option<Arc<[f64]>>) -> Self {
        Self {
            basis,
            dimension: y.len(),
            terms: degree + 1,
            times: vec![t],
            start_state: y.to_vec(),
            end_state: y.to_vec(),
            begins: Vec::new(),
            widths: Vec::new(),
            coefficients: Vec::new(),
            wanted,
            thinned: None,
        }
    }

    /// Whether there is memory for one more step, and enough beside it to tell of it; if not, the bytes that
    /// are stored.
    pub(crate) fn has_memory(&mut self) -> Result<(), usize> {
        let length = self.terms * self.dimension;
        let stored = &mut self.coefficients;
        if stored.capacity() - stored.len() >= length {
            return Ok(());
        }
        let reserved = stored.try_reserve(length).or_else(|_| stored.try_reserve_exact(length));
        // short runs need no look: it costs an eighth of theirs
        let beside = if stored.capacity() < ROOM { 0 } else { BESIDE };
        let beside = reserved.and_then(|()| Vec::<f64>::new().try_reserve_exact(beside));
        beside.map_err(|_| stored.len() * size_of::<f64>())
    }

    /// Room for the coefficients of one more step: fill it, then `push` keeps it or `pop_room` drops it.
    pub(crate) fn room(&mut self) -> &mut [f64] {
        let length = self.terms * self.dimension;
        let stored = self.coefficients.len();
        self.coefficients.resize(stored + length, 0.0);
        &mut self.coefficients[stored..]
    }

    /// The coefficients in the last room.
    pub(crate) fn last_room(&self) -> &[f64] {
        &self.coefficients[self.coefficients.len() - self.terms * self.dimension..]
    }

    pub(crate) fn pop_room(&mut self) {
        self.coefficients.truncate(self.coefficients.len() - self.terms * self.dimension);
    }

    /// One more step, from `begin` over `width`, valid up to `end`; `y` is the state at `end`. It takes room
    /// where its polynomial does.
    pub(crate) fn push(&mut self, begin: f64, width: f64, end: f64, y: &[f64]) {
        // one more polynomial than begins, where this step has one
        if self.coefficients.len() > self.begins.len() * self.terms * self.dimension {
            self.begins.push(begin);
            self.widths.push(width);
            self.thin();
        } else {
            self.times.truncate(1);
        }
        self.times.push(end);
        self.end_state.copy_from_slice(y);
    }

    /// Drops the steps without a wanted time once the stored coefficients exceed `ROOM`.
    fn thin(&mut self) {
        let Some(wanted) = &self.wanted else { return };
        if self.thinned.is_none() && self.coefficients.len() <= ROOM {
            return;
        }
        let length = self.terms * self.dimension;
        let looked = self.thinned.unwrap_or(0);
        let mut kept = looked;
        for step in looked..self.begins.len() {
            let (begin, width) = (self.begins[step], self.widths[step]);
            let [from, to] = [begin.min(begin + width), begin.max(begin + width)];
            let next = wanted.partition_point(|&t| t < from);
            if wanted.get(next).is_some_and(|&t| t <= to) {
                (self.begins[kept], self.widths[kept]) = (begin, width);
                self.coefficients.copy_within(step * length..(step + 1) * length, kept * length);
                kept += 1;
            }
        }
        self.begins.truncate(kept);
        self.widths.truncate(kept);
        self.coefficients.truncate(kept * length);
        self.thinned = Some(kept);
    }

    /// Goes on with what begins where this ends, of the same method.
    pub(crate) fn append(&mut self, mut next: DenseOutput) {
        if self.coefficients.is_empty() && self.thinned.is_none() {
            self.times.truncate(1);
        }
        self.times.extend(&next.times[1..]);
        self.begins.append(&mut next.begins);
        self.widths.append(&mut next.widths);
        self.coefficients.append(&mut next.coefficients);
        self.end_state = next.end_state;
        if next.thinned.is_some() {
            self.thinned = self.thinned.or(Some(0));
        }
        self.thin();
    }

    /// [`crate::Options::wanted`], if steps were dropped, so that the solution is known at these times only.
    pub fn thinned_to(&self) -> Option<&Arc<[f64]>> {
        self.wanted.as_ref().filter(|_| self.thinned.is_some())
    }

    pub(crate) fn basis(&self) -> Basis {
        self.basis
    }

    /// Where the integration started.
    pub fn start(&self) -> f64 {
        self.times[0]
    }

    /// The end asked for, or where the run stopped. Smaller than the start for backward integration.
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The number of unknowns.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The state at [`start`](DenseOutput::start).
    pub fn start_state(&self) -> &[f64] {
        &self.start_state
    }

    /// The state at [`end`](DenseOutput::end).
    pub fn end_state(&self) -> &[f64] {
        &self.end_state
    }

    /// The start, then the end of each step, or of all together where only the ends were stored; the last one
    /// is [`end`](DenseOutput::end).
    pub fn step_times(&self) -> &[f64] {
        &self.times
    }

    /// Writes the state at `t` into `y`.
    ///
    /// A `t` outside of the range by no more than round-off is moved to the end of the range. Farther
    /// outside, with a slice of the wrong length or where nothing was stored ([`crate::Dense::EndOnly`],
    /// [`crate::Options::wanted`]),
    /// debug builds panic; release builds answer with the state at the nearer end, as far as the slice
    /// reaches. Where the time is not known to be in range, ask [`try_evaluate`](DenseOutput::try_evaluate).
    pub fn evaluate(&self, t: f64, y: &mut [f64]) {
        if let Err(error) = self.try_evaluate(t, y) {
            debug_assert!(false, "{error}");
            let nearer_start = (t - self.start()).abs() < (t - self.end()).abs();
            let state = if nearer_start { &self.start_state } else { &self.end_state };
            for (y, state) in y.iter_mut().zip(state) {
                *y = *state;
            }
        }
    }

    /// Writes the state at `t` into `y`.
    ///
    /// # Errors
    /// [`DenseError::OutsideRange`] for a `t` farther outside of the range than round-off,
    /// `16 ε max(|start|, |end|)`; [`DenseError::NotStored`] between the ends where only they were stored, or
    /// where the step was dropped; [`DenseError::Dimension`] where `y` has the wrong length. `y` is then
    /// untouched.
    pub fn try_evaluate(&self, t: f64, y: &mut [f64]) -> Result<(), DenseError> {
        let (start, end) = (self.start(), self.end());
        if y.len() != self.dimension {
            return Err(DenseError::Dimension { expected: self.dimension, found: y.len() });
        }
        let slack = 16.0 * f64::EPSILON * start.abs().max(end.abs());
        let inside = t >= start.min(end) - slack && t <= start.max(end) + slack;
        if !inside {
            return Err(DenseError::OutsideRange { t, start, end });
        }
        let forward = end >= start;
        let before = |a: f64, b: f64| if forward { a <= b } else { a >= b };
        if before(end, t) {
            y.copy_from_slice(&self.end_state);
        } else if before(t, start) {
            y.copy_from_slice(&self.start_state);
        } else if self.coefficients.is_empty() {
            return Err(DenseError::NotStored { t, start, end });
        } else {
            // The last step that begins at or before t; there is one, since t is past the start.
            let step = self.begins.partition_point(|&begin| before(begin, t)).saturating_sub(1);
            let stored = |step: usize| {
                let (past, width) = ((t - self.begins[step]) * self.widths[step].signum(), self.widths[step].abs());
                -slack <= past && past <= width + slack
            };
            if self.thinned.is_some() && !stored(step) {
                return Err(DenseError::NotStored { t, start, end });
            }
            let length = self.terms * self.dimension;
            let coefficients = &self.coefficients[step * length..(step + 1) * length];
            evaluate_segment(self.basis, coefficients, (t - self.begins[step]) / self.widths[step], y);
        }
        Ok(())
    }
}

/// The basis functions of a step's coefficients.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Basis {
    /// 1, θ, θ (1 − θ), θ² (1 − θ) …; all components of the first coefficient, then those of the second …
    Nested,
    /// 1, θ, θ² …; all coefficients of the first component, then those of the second …
    Powers,
}

/// The polynomial of one step at θ.
pub fn evaluate_segment(basis: Basis, coefficients: &[f64], theta: f64, y: &mut [f64]) {
    let dimension = y.len();
    let terms = coefficients.len() / dimension;
    if basis == Basis::Powers {
        for (y, row) in y.iter_mut().zip(coefficients.chunks_exact(terms)) {
            *y = row.iter().rev().fold(0.0, |sum, c| c + theta * sum);
        }
        return;
    }
    y.copy_from_slice(&coefficients[(terms - 1) * dimension..]);
    for (j, row) in coefficients[..(terms - 1) * dimension].chunks_exact(dimension).enumerate().rev() {
        // c_{j+1} is multiplied by θ for even j, by 1 − θ for odd j.
        let factor = if j % 2 == 0 { theta } else { 1.0 - theta };
        for (y, c) in y.iter_mut().zip(row) {
            *y = c + factor * *y;
        }
    }
}

/// The polynomial of one step at θ, and its slope there.
pub(crate) fn segment_with_slope(basis: Basis, coefficients: &[f64], theta: f64, y: &mut [f64], slope: &mut [f64]) {
    let dimension = y.len();
    let terms = coefficients.len() / dimension;
    slope.fill(0.0);
    if basis == Basis::Powers {
        for ((y, slope), row) in y.iter_mut().zip(slope).zip(coefficients.chunks_exact(terms)) {
            (*y, *slope) = row.iter().rev().fold((0.0, 0.0), |(y, slope), c| (c + theta * y, y + theta * slope));
        }
        return;
    }
    y.copy_from_slice(&coefficients[(terms - 1) * dimension..]);
    for (j, row) in coefficients[..(terms - 1) * dimension].chunks_exact(dimension).enumerate().rev() {
        let (factor, sign) = if j % 2 == 0 { (theta, 1.0) } else { (1.0 - theta, -1.0) };
        for ((y, slope), c) in y.iter_mut().zip(&mut *slope).zip(row) {
            (*y, *slope) = (c + factor * *y, sign * *y + factor * *slope);
        }
    }
}
