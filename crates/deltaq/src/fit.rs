//! Fairness: the free constants with which one motion comes close to another.
//!
//! "Different" means different for *every* choice of free constants (T9), so a comparison searches for
//! others.

mod squares;

use equations::Equations;
use integrate::BoundaryError;
use mechanics::ConstantsRule;
use nalgebra::{DMatrix, DVector};
use symbolic::Expr;

use crate::metric::larger;
use crate::single_run::{SingleRun, outputs};
use crate::{Metric, Motion, Prepared, Setting, Settings, SolveError, TIGHTER, solve};

/// Instants at which the sum of squares is taken.
pub const INSTANTS: usize = 40;

/// Tolerance of the integrations while constants are searched, and the limit on their steps.
pub(crate) const SEARCH_TOLERANCE: f64 = 1e-7;
const SEARCH_STEPS: usize = 5_000;

/// Readings that take as long as a step.
const READINGS: usize = 4;

/// Where the search comes this close, relative to the length of the way, it is refined at the full tolerance.
const CLOSE: f64 = 1e-4;

/// Integrates `equations` with free constants for which the sum of squares
///
/// ```text
/// Σ_k Δqᵀ |M| Δq ,   Δq = q(t_k; C) − q_target(t_k) ,
/// ```
///
/// over 40 instants has a minimum near that of `guesses` which is closest: searched at a coarse tolerance,
/// and refined where it comes close, for then it may be exact. `None` where there is no free constant, or no
/// guess leads to a motion.
///
/// # Errors
/// [`SolveError`] where the motion cannot be started or `target` cannot be read off.
pub fn best_fit(
    setting: Setting,
    equations: &Equations,
    target: &mut Motion,
    guesses: &[Vec<f64>],
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Motion>, SolveError> {
    if equations.free_constants.is_empty() {
        return Ok(None);
    }
    let end = target.end();
    let mut differences = Differences::new(setting, equations, target, INSTANTS, metric, settings)?;
    let mut begun =
        |guess: &Vec<f64>| -> f64 { differences.at(guess, 1.0, 1).map_or(f64::INFINITY, |apart| apart.norm_squared()) };
    let closest = match guesses {
        [only] => Some(only),
        several => {
            let distances: Vec<f64> = several.iter().map(&mut begun).collect();
            several.iter().zip(distances).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(guess, _)| guess)
        }
    };
    let Some(constants) = closest.and_then(|guess| differences.squares(guess, settings)) else { return Ok(None) };
    let rule = ConstantsRule::Given(constants);
    Ok(Some(solve(Setting { end, ..setting }, equations.clone(), &rule, settings)?))
}

/// Constants, end, tolerance and largest number of steps of a run.
type Asked = (Vec<f64>, f64, f64, usize);

/// Differences to a motion at equidistant instants, as functions of the free constants of another.
pub struct Differences {
    prepared: Prepared,
    coarse: Settings,
    tolerance: f64,
    /// Time, coordinates and a factor of the metric, at each instant.
    goal: Vec<(f64, DVector<f64>, DMatrix<f64>)>,
    origin: DVector<f64>,
    /// The states that the coordinates are, where they are just that: then nothing is solved to read them.
    places: Option<Vec<usize>>,
    start: f64,
    end: f64,
    /// The last run with what it was of: a step of a descent begins where the one before has looked.
    last: Option<(Asked, SingleRun)>,
    /// Steps and readings so far, times the operations of an evaluation.
    pub(crate) work: usize,
}

impl Differences {
    /// At this number of instants.
    ///
    /// # Errors
    /// As of [`best_fit`].
    pub fn new(
        setting: Setting,
        equations: &Equations,
        target: &mut Motion,
        instants: usize,
        metric: &mut Metric,
        settings: &Settings,
    ) -> Result<Differences, SolveError> {
        let (start, end) = (target.start(), target.end());
        let mut goal = Vec::new();
        for k in 1..=instants {
            let t = start + (end - start) * k as f64 / instants as f64;
            let outputs = target.at(t)?;
            let factor = metric.factor(t, &outputs.coordinates, &outputs.velocities);
            goal.push((t, DVector::from_vec(outputs.coordinates), factor));
        }
        let origin = DVector::from_vec(target.at(start)?.coordinates);
        let prepared = Prepared::new(setting, equations.clone(), settings)?;
        let method = Some(prepared.method.method);
        let coarse = Settings { max_steps: SEARCH_STEPS.min(settings.max_steps), method, ..settings.clone() };
        let states = &equations.states;
        let place = |&q: &Expr| states.iter().position(|y| equations.graph.as_symbol(q) == Some(y.symbol));
        let places = equations.coordinates.iter().map(place).collect();
        let (tolerance, last, work) = (SEARCH_TOLERANCE, None, 0);
        Ok(Differences { prepared, coarse, tolerance, goal, origin, places, start, end, last, work })
    }

    /// Motions may take no more than this many times the steps of those with these constants.
    pub(crate) fn limit_steps(&mut self, constants: &[f64], times: usize) {
        let options = self.coarse.options(SEARCH_TOLERANCE);
        self.prepared.set_constants(constants);
        if let Ok(run) = self.prepared.integrate(self.end, &options) {
            let steps = run.solution.work.steps + run.solution.work.rejected;
            self.coarse.max_steps = self.coarse.max_steps.min(times * steps.max(10));
        }
    }

    /// From now on motions are integrated as finely as the one that is to be met.
    pub(crate) fn refine(&mut self, settings: &Settings) {
        self.tolerance = settings.tolerance * TIGHTER;
    }

    /// Steps that a motion may take.
    pub(crate) fn max_steps(&self) -> usize {
        self.coarse.max_steps
    }

    /// Where this part of the motion ends, and every `stride`-th instant of it.
    pub(crate) fn times(&self, part: f64, stride: usize) -> (f64, Vec<f64>) {
        let times = (1..=self.instants(part, stride)).map(|k| self.goal[k * stride - 1].0).collect();
        (self.start + (self.end - self.start) * part, times)
    }

    /// Counts work that was done elsewhere.
    pub(crate) fn did(&mut self, steps: usize, readings: usize) {
        self.work += (steps + readings / READINGS) * self.prepared.compiled.cost()[1].operations();
    }

    /// The largest gap of these coordinates at every `stride`-th instant, as many as there are.
    pub(crate) fn gap_of<'a>(&self, motion: impl Iterator<Item = &'a [f64]>, stride: usize) -> f64 {
        let instants = self.goal.chunks_exact(stride).map(|instants| &instants[stride - 1]);
        let each = motion.zip(instants);
        let gaps = each.map(|(now, (_, q, factor))| (factor * (DVector::from_column_slice(now) - q)).norm());
        gaps.fold(0.0, larger)
    }

    /// Number of coordinates.
    pub(crate) fn dimension(&self) -> usize {
        self.origin.len()
    }

    /// Every `stride`-th instant up to this part of the motion.
    fn instants(&self, part: f64, stride: usize) -> usize {
        (self.goal.len() as f64 * part) as usize / stride
    }

    /// The Euclidean length of the way of the target to these instants.
    pub(crate) fn way(&self, part: f64, stride: usize) -> f64 {
        let to = (1..=self.instants(part, stride)).map(|k| &self.goal[k * stride - 1]);
        to.map(|(_, q, factor)| (factor * (q - &self.origin)).norm_squared()).sum::<f64>().sqrt()
    }

    /// Whether what is left of differences is so small that it may be nothing.
    pub(crate) fn is_close(&self, largest: f64) -> bool {
        largest < CLOSE * self.way(1.0, 1) / (self.goal.len() as f64).sqrt()
    }

    /// All differences with these constants, or why there are none.
    fn fill(
        &mut self,
        constants: &[f64],
        part: f64,
        stride: usize,
        tolerance: f64,
        limits: &Settings,
    ) -> Result<DVector<f64>, BoundaryError> {
        let broken = |reason: String| BoundaryError::Residual { reason };
        let (n, count) = (self.dimension(), self.instants(part, stride));
        let Differences { prepared, goal, places, last, .. } = self;
        prepared.set_constants(constants);
        let end = self.start + (self.end - self.start) * part;
        let options = Settings { method: Some(prepared.method.method), ..limits.clone() }.options(tolerance);
        let asked = (constants.to_vec(), end, tolerance, options.max_steps);
        let run = match last.take() {
            Some((same, run)) if same == asked => run,
            _ => prepared.integrate(end, &options).map_err(|e| broken(e.to_string()))?,
        };
        let (_, run) = last.insert((asked, run));
        let done = run.solution.work;
        self.work += (done.steps + done.rejected + count / READINGS) * prepared.compiled.cost()[1].operations();
        run.solution.completed()?;
        let mut differences = DVector::zeros(count * n);
        let mut states = vec![0.0; prepared.compiled.dimension()];
        for k in 1..=count {
            let (t, q, factor) = &goal[k * stride - 1];
            run.states_at(&mut prepared.compiled, *t, &mut states).map_err(|e| broken(e.to_string()))?;
            let now = match places {
                Some(places) => places.iter().map(|&i| states[i]).collect(),
                None => outputs(&mut prepared.compiled, *t, &states).map_err(|e| broken(e.to_string()))?.coordinates,
            };
            let difference = factor * (DVector::from_vec(now) - q);
            differences.rows_mut((k - 1) * n, n).copy_from(&difference);
        }
        Ok(differences)
    }

    /// All differences with these constants, coarsely until [`Differences::refine`]; `None` without a motion.
    pub(crate) fn at(&mut self, constants: &[f64], part: f64, stride: usize) -> Option<DVector<f64>> {
        let coarse = self.coarse.clone();
        self.fill(constants, part, stride, self.tolerance, &coarse).ok()
    }

    /// The largest gap at these instants as of [`Differences::at`]; infinite without a motion.
    pub(crate) fn largest(&mut self, constants: &[f64], part: f64, stride: usize) -> f64 {
        let n = self.dimension();
        let lengths = |all: DVector<f64>| {
            let squares = all.as_slice().chunks_exact(n).map(|d| d.iter().map(|x| x * x).sum::<f64>());
            squares.fold(0.0, larger).sqrt()
        };
        self.at(constants, part, stride).map_or(f64::INFINITY, lengths)
    }
}
