//! The decision in floating point.

use integrate::DenseOutput;
use mechanics::SingularValues;
use nalgebra::{DMatrix, DVector};
use symbolic::limits::LAST_DIGITS;

use crate::DecisionError;
use crate::affine_set::AffineSet;
use crate::curve::{Curve, Flow};
use crate::family::Family;
use crate::sizes::{CERTAINTY, Column, Sizes, Sums};
use crate::transport::{Path, Transport};

/// Gauss nodes per panel, and the least number of panels.
pub(crate) const NODES: usize = 2;
const PANELS: usize = 40;
/// The question is judged up to these parts of the time.
const PARTS: [f64; 12] = [0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
/// Noise above this fraction of the curve's own acceleration leaves the result undecided: a mismatch below it
/// may be real. After a part `x` of the time, with `r` constants determined, it is `x^r` of that.
const TOO_LOUD: f64 = 1e-5;

/// Where round-off shortens steps: factors of the tolerances, with steps for each; the last attempt uses the
/// full budget of steps.
const ATTEMPTS: [(f64, usize); 3] = [(1.0, 3_000), (1e2, 3_000), (1.0, 100_000)];

/// How the decision is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecisionSettings {
    /// Relative tolerance of the looser run.
    pub tolerance: f64,
    /// The tighter run has this part of it.
    pub tighter: f64,
    /// Whether it is proved that no constants exist: one attempt then suffices, whatever its mismatch.
    pub refuted: bool,
}

impl Default for DecisionSettings {
    fn default() -> Self {
        DecisionSettings { tolerance: 1e-10, tighter: 1e-2, refuted: false }
    }
}

/// Whether the curve is a motion of the family.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// For some constants the mismatch is within the noise.
    Contained,
    /// For no constants it is.
    NotContained,
    /// The noise is too large to decide.
    Undecided,
}

/// A decision, and the numbers that it rests on.
///
/// The mismatch of accelerations is `y(t) = O(t) c + y₀(t)` for constants `c`; lengths are
/// `(∫ |y|²_M dt)^{1/2}`, in the unit of `√E/√T`.
#[derive(Clone, Debug)]
pub struct Decision {
    /// The answer.
    pub verdict: Verdict,
    /// The constants of least mismatch: the answer for [`Verdict::Contained`], else the nearest miss.
    pub set: AffineSet,
    /// The least mismatch, ρ.
    pub least: f64,
    /// The mismatch at `c = 0`.
    pub at_zero: f64,
    /// The noise of ρ.
    pub noise: f64,
    /// `(∫ |a|²_M dt)^{1/2}` of the curve, for comparison with ρ.
    pub acceleration: f64,
    /// Names of the constants.
    pub constants: Vec<String>,
    /// Time since the start up to which this was decided, if not the end: later the noise is too large, or
    /// integration fails.
    pub until: Option<f64>,
    triangle: DMatrix<f64>,
    columns: Vec<Column>,
    sizes: Sizes,
}

impl Decision {
    /// The mismatch that the constants `c` leave.
    pub fn mismatch_at(&self, constants: &[f64]) -> f64 {
        (&self.triangle * self.scaled(constants).push(1.0)).norm()
    }

    /// Whether the curve moves, or accelerates, by more than round-off.
    pub fn moves(&self) -> bool {
        self.sizes.moves
    }

    /// How far each constant may be off, but for those that are free: what moves the mismatch less than its
    /// noise does.
    pub fn open(&self) -> Vec<f64> {
        let matrix = self.triangle.columns(0, self.columns.len()).into_owned();
        let (svd, limit) = (SingularValues::of(&matrix), CERTAINTY * self.sizes.noise);
        let seen = || (0..svd.values.len()).filter(|&k| svd.values[k] > limit);
        let part = |i: usize| seen().map(|k| (svd.right[(k, i)] / svd.values[k]).powi(2)).sum::<f64>().sqrt();
        let each = self.columns.iter().enumerate();
        each.map(|(i, column)| CERTAINTY * self.noise * part(i) * column.scale.abs()).collect()
    }

    /// The part of the curve's acceleration to which the answer holds.
    pub fn part(&self) -> f64 {
        self.least.max(self.noise) / self.acceleration
    }

    /// Whether a mismatch stands out from the noise.
    pub fn shows(&self, mismatch: f64) -> bool {
        mismatch > CERTAINTY * self.noise
    }

    /// The family's motion is the curve as far as both are known: a mismatch that moves nothing, as near a
    /// kink, is noise.
    pub fn is_noise(&mut self) {
        if self.verdict == Verdict::NotContained {
            let noise = self.noise.max(self.least / CERTAINTY);
            self.sizes.noise = if self.noise > 0.0 { self.sizes.noise * (noise / self.noise) } else { noise };
            (self.noise, self.verdict) = (noise, Verdict::Undecided);
        }
    }

    /// Noise as a part of what a mismatch is compared with.
    fn loudness(&self) -> f64 {
        let reach = (1.0 + self.scaled(&self.set.point).norm_squared()).sqrt();
        self.noise / self.sizes.scale(reach)
    }

    /// Constants in their scales.
    fn scaled(&self, constants: &[f64]) -> DVector<f64> {
        DVector::from_iterator(constants.len(), constants.iter().zip(&self.columns).map(|(c, column)| c / column.scale))
    }

    /// Whether the mismatch for the constants `c` is within the noise.
    pub fn admits(&self, constants: &[f64]) -> bool {
        self.verdict_at(constants) != Verdict::NotContained
    }

    /// The verdict on the constants `c` alone: for large constants the noise may be too large to decide.
    pub fn verdict_at(&self, constants: &[f64]) -> Verdict {
        let reach = (1.0 + self.scaled(constants).norm_squared()).sqrt();
        verdict_on(self.mismatch_at(constants), reach, &self.sizes, TOO_LOUD)
    }
}

/// Decides whether a curve is a motion of `family` for some choice of the family's constants.
///
/// The same curve comes twice: as well as it is known, and less well; the difference tells the noise. A
/// motion has its two runs; [`decide_flow`] does it for a curve that is integrated here.
///
/// # Errors
/// [`DecisionError`] where curve or constants cannot be followed to the end.
pub fn decide(
    family: &Family,
    tighter: &mut dyn Curve,
    looser: &mut dyn Curve,
    settings: &DecisionSettings,
) -> Result<Decision, DecisionError> {
    let mut fine = Transport::new(family, tighter);
    let mut coarse = Transport::new(family, looser);
    let mut found = Err(DecisionError::Curve { reason: String::new() });
    for (factor, steps) in ATTEMPTS {
        let tolerance = settings.tolerance * factor;
        let own = fine.run(tolerance * settings.tighter, steps)?;
        coarse.scales = fine.scales.clone();
        let paths = [own, coarse.run(tolerance, steps)?];
        found = judged(&mut fine, &mut coarse, &paths);
        let short = paths.iter().any(|path| matches!(path.stop, Some(DecisionError::Steps { .. })));
        // constants that do for the first moments need not do later
        if !short || found.as_ref().is_ok_and(|found| settings.refuted || found.verdict == Verdict::NotContained) {
            break;
        }
    }
    found
}

/// Judges as far as both runs come, and up to the end of each part of that.
fn judged(fine: &mut Transport, coarse: &mut Transport, paths: &[Path; 2]) -> Result<Decision, DecisionError> {
    let (start, end) = fine.span();
    let [own, other] = paths;
    let way = (own.end - start).abs().min((other.end - start).abs());
    if way == 0.0 {
        return Err(own.stop.clone().unwrap_or(DecisionError::Curve { reason: "it ends where it starts".into() }));
    }
    let bounds = bounds(own, start, way.copysign(end - start));
    let panels = bounds.len() - 1;
    let (constants, scales) = (fine.family.constants(), fine.scales.constants.clone());
    let mut triangle = DMatrix::zeros(0, constants.len() + 1);
    let zeros = DVector::zeros(constants.len() + 1);
    let mut sums = Sums { noise: zeros.clone(), terms: zeros, acceleration: 0.0, speed: 0.0, moves: false };
    let (nodes, n) = (legendre(), fine.family.shape.coordinates);
    let mut found: Vec<Decision> = Vec::new();
    let mut parts = PARTS.into_iter().peekable();
    let mut begun = None;
    let mut add = |panel: usize| -> Result<(), DecisionError> {
        let width = bounds[panel + 1] - bounds[panel];
        let above = triangle.nrows();
        triangle = std::mem::take(&mut triangle).resize_vertically(above + NODES * n, 0.0);
        for (i, (x, weight)) in nodes.into_iter().enumerate() {
            let t = bounds[panel] + width * x;
            let root = (weight * width.abs()).sqrt();
            let here = fine.mismatch(own, t)?;
            triangle.rows_mut(above + i * n, n).copy_from(&(&here.rows * root));
            if i == panel % NODES {
                let there = coarse.mismatch(other, t)?;
                let squares = |rows: DMatrix<f64>| {
                    DVector::from_iterator(rows.ncols(), rows.column_iter().map(|x| x.norm_squared()))
                };
                let terms = squares(fine.terms_of(&here));
                // what a constant could add is no round-off of the motion
                let own = terms[constants.len()].sqrt();
                sums.noise += squares(&here.rows - there.rows) * width.abs();
                sums.terms += terms * width.abs();
                sums.moves |= here.acceleration.hypot(here.speed / way) > CERTAINTY * LAST_DIGITS * own;
            }
            sums.acceleration += (here.acceleration * root).powi(2);
            sums.speed += (here.speed * root).powi(2);
        }
        triangle = compressed(std::mem::take(&mut triangle));
        let past = bounds[panel + 1] - start;
        let mut passed = false;
        while parts.next_if(|part| past.abs() >= part * way * (1.0 - 1e-9)).is_some() {
            passed = true;
        }
        if passed {
            let (sizes, mut columns) = sums.lengths(end - start, &triangle);
            // what grows hides what does not
            let first = begun.get_or_insert_with(|| columns.iter().map(|k| k.size / k.scale).collect::<Vec<_>>());
            columns.iter_mut().zip(first).for_each(|(k, first)| k.size = k.size.min(*first * k.scale));
            let mut scaled = triangle.clone();
            scaled.column_iter_mut().zip(&columns).for_each(|(mut column, known)| column *= known.scale);
            columns.iter_mut().zip(&scales).for_each(|(column, scale)| column.scale *= scale);
            let whole = panel + 1 == panels && way == (end - start).abs();
            let until = (!whole).then_some(past.abs());
            found.push(judge(scaled, sizes, (until, past / (end - start)), constants.to_vec(), columns));
        }
        Ok(())
    };
    let stopped = (0..panels).try_for_each(&mut add).err();
    // what no constants can do up to some time they cannot do at all
    let longest = |verdict: Verdict| found.iter().rposition(|decision| decision.verdict == verdict);
    let longest = longest(Verdict::NotContained).or_else(|| longest(Verdict::Contained));
    let quietest = || (0..found.len()).min_by(|&i, &j| found[i].loudness().total_cmp(&found[j].loudness()));
    match longest.or_else(quietest) {
        Some(i) => Ok(found.swap_remove(i)),
        None => Err(own.stop.clone().or(stopped).unwrap_or(DecisionError::Curve { reason: "it has no part".into() })),
    }
}

/// Where panels begin and end: the steps, short where much happens, in parts of at most one of [`PANELS`].
fn bounds(path: &Path, start: f64, way: f64) -> Vec<f64> {
    let end = start + way;
    let steps = path.dense.as_ref().map_or(&[][..], DenseOutput::step_times);
    let inside = steps.iter().copied().filter(|t| (t - start) * way > 0.0 && (end - t) * way > 0.0);
    let mut bounds = vec![start];
    for to in inside.chain([end]) {
        let from = bounds[bounds.len() - 1];
        let count = ((to - from) / way * PANELS as f64).ceil().max(1.0);
        bounds.extend(
            (1..=count as usize).map(|i| if i as f64 == count { to } else { from + (to - from) * i as f64 / count }),
        );
    }
    bounds
}

/// [`decide`] for a curve that is integrated beside the transport of the constants.
///
/// # Errors
/// As [`decide`].
pub fn decide_flow(family: &Family, flow: &Flow, settings: &DecisionSettings) -> Result<Decision, DecisionError> {
    decide(family, &mut flow.clone(), &mut flow.clone(), settings)
}

fn judge(
    triangle: DMatrix<f64>,
    sizes: Sizes,
    (until, part): (Option<f64>, f64),
    constants: Vec<String>,
    known: Vec<Column>,
) -> Decision {
    let last = triangle.ncols() - 1;
    // as many rows as right singular vectors
    let padded = triangle.clone().resize_vertically(last.max(triangle.nrows()), 0.0);
    let (matrix, goal) = (padded.columns(0, last).into_owned(), -padded.column(last));
    let svd = SingularValues::of(&matrix);
    let limit = CERTAINTY * sizes.noise;
    let solved = |limit: f64| {
        let point = svd.solve(&goal, limit);
        let reach = (1.0 + point.norm_squared()).sqrt();
        let least = (&matrix * &point - &goal).norm();
        (point, reach, least)
    };
    let (mut point, mut reach, mut least) = solved(limit);
    if least > CERTAINTY * sizes.noise * reach {
        // a free direction may be what is missing: far along it, it moves more than the noise
        let largest = svd.values.iter().copied().fold(0.0, f64::max);
        let (all, far, left) = solved(LAST_DIGITS * largest);
        if left <= CERTAINTY * sizes.noise * reach {
            (point, reach, least) = (all, far, left);
        }
    }
    let free: Vec<DVector<f64>> =
        (0..last).filter(|&k| svd.values[k] <= limit).map(|k| svd.right.row(k).transpose()).collect();
    // is there one whose effect would be lost in noise? Whatever its part among quiet ones: these are
    // orthonormal, and known to half of their digits
    let quiet = |k: &Column| (TOO_LOUD * k.size / (CERTAINTY * k.noise)).min(f64::EPSILON.sqrt().recip());
    let heard = DMatrix::from_fn(last, free.len(), |i, j| quiet(&known[i]) * free[j][i]);
    let loud = SingularValues::of(&heard).values.iter().any(|part| *part < 1.0);
    // as many derivatives of the mismatch may be zero by choice: early on, the rest is smaller
    let loudest = TOO_LOUD * part.powi((last - free.len()) as i32);
    let own = |c: DVector<f64>| DVector::from_iterator(last, c.iter().zip(&known).map(|(c, k)| c * k.scale));
    let directions = orthonormal(free.into_iter().map(own).collect());
    let verdict = match verdict_on(least, reach, &sizes, loudest) {
        // a mismatch this much larger than the motion is amplified round-off
        Verdict::NotContained if LAST_DIGITS * least > sizes.scale(reach) => Verdict::Undecided,
        Verdict::Contained if loud => Verdict::Undecided,
        verdict => verdict,
    };
    Decision {
        verdict,
        set: AffineSet { point: own(point).as_slice().to_vec(), directions },
        least,
        at_zero: goal.norm(),
        noise: sizes.noise * reach,
        acceleration: sizes.acceleration,
        constants,
        until,
        triangle,
        columns: known,
        sizes,
    }
}

/// What a mismatch says that constants of a size `reach` leave, if noise may be up to a part `loudest` of the
/// motion.
fn verdict_on(mismatch: f64, reach: f64, sizes: &Sizes, loudest: f64) -> Verdict {
    let noise = CERTAINTY * sizes.noise * reach;
    if mismatch > noise {
        Verdict::NotContained
    } else if noise <= loudest * sizes.scale(reach) {
        Verdict::Contained
    } else {
        Verdict::Undecided
    }
}

/// Orthonormal vectors with the same span.
fn orthonormal(vectors: Vec<DVector<f64>>) -> Vec<Vec<f64>> {
    let mut all: Vec<DVector<f64>> = Vec::new();
    for mut vector in vectors {
        vector /= vector.amax();
        all.iter().for_each(|other| vector -= other * other.dot(&vector));
        all.push(vector.normalize());
    }
    all.into_iter().map(|vector| vector.as_slice().to_vec()).collect()
}

/// The least of `|O c + y₀|` over all constants `c`, for rows `[O | y₀]`.
pub(crate) fn least(mut rows: DMatrix<f64>) -> f64 {
    let last = rows.ncols() - 1;
    for mut column in rows.columns_mut(0, last).column_iter_mut().filter(|column| column.norm() > 0.0) {
        column /= column.norm();
    }
    judge(
        compressed(rows),
        Sizes::default(),
        (None, 1.0),
        Vec::new(),
        vec![Column { scale: 1.0, noise: 0.0, size: 0.0 }; last],
    )
    .least
}

/// The triangular factor: the same lengths in at most as many rows as columns.
fn compressed(rows: DMatrix<f64>) -> DMatrix<f64> {
    if rows.nrows() <= rows.ncols() { rows } else { rows.qr().r() }
}

/// Nodes and weights of the Gauss-Legendre rule on [0, 1].
pub(crate) fn legendre() -> [(f64, f64); NODES] {
    let root = 0.75_f64.sqrt();
    [0.5 - root / 3.0, 0.5 + root / 3.0].map(|x| (x, 0.5))
}
