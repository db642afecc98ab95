//! Fairness: the free constants with which one motion comes close to another.
//!
//! "Different" means different for *every* choice of free constants (T9), so a comparison searches for
//! others.

pub(crate) mod search;
mod squares;

pub use squares::Power;

use equations::Equations;
use integrate::BoundaryError;
use mechanics::ConstantsRule;
use nalgebra::{DMatrix, DVector};
use symbolic::Expr;
use symbolic::limits::SAME;

use motion::band::{SAMPLES, SEARCH_STEPS};
use motion::shooting::{BEGINNING, LONGER};
use motion::{Metric, Motion, Prepared, Setting, Settings, SingleRun, SolveError, TIGHTER, larger, outputs, solve};

/// Instants at which gaps are looked at; of these every fourth for a first look, and for the sum of squares.
pub const INSTANTS: usize = 160;
const COARSE: usize = 4;

/// Where the search comes this close, relative to the length of the way, it is refined at the full tolerance.
pub(crate) const CLOSE: f64 = 1e-4;

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
    let mut differences = Differences::new(setting, equations, target, metric, settings)?;
    let constants = match guesses {
        [only] => Some(only.clone()),
        several => differences.closest(several),
    };
    let Some(constants) = constants.and_then(|guess| differences.squares(&guess, settings)) else { return Ok(None) };
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
}

impl Differences {
    /// At [`INSTANTS`] of the target.
    ///
    /// # Errors
    /// As of [`best_fit`].
    pub fn new(
        setting: Setting,
        equations: &Equations,
        target: &mut Motion,
        metric: &mut Metric,
        settings: &Settings,
    ) -> Result<Differences, SolveError> {
        let (start, end) = (target.start(), target.end());
        let mut goal = Vec::new();
        for k in 1..=INSTANTS {
            let t = start + (end - start) * k as f64 / INSTANTS as f64;
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
        let (tolerance, last) = (SAME, None);
        Ok(Differences { prepared, coarse, tolerance, goal, origin, places, start, end, last })
    }

    /// Steps times operations of the motion with these constants. From now on motions may take a few times
    /// the steps.
    fn limit_steps(&mut self, constants: &[f64]) -> usize {
        let options = self.coarse.options(self.tolerance);
        self.prepared.set_constants(constants);
        let Ok(run) = self.prepared.integrate(self.end, &options) else { return 0 };
        let steps = run.solution.work.steps + run.solution.work.rejected;
        self.coarse.max_steps = self.coarse.max_steps.min(LONGER * steps.max(SAMPLES));
        steps * self.prepared.compiled.cost()[1].operations()
    }

    /// From now on motions are integrated as finely as the one that is to be met.
    fn refine(&mut self, settings: &Settings) {
        self.tolerance = settings.tolerance * TIGHTER;
    }

    /// The guess with the least sum of squares; `None` where none of them leads to a motion.
    fn closest(&mut self, guesses: &[Vec<f64>]) -> Option<Vec<f64>> {
        let mut distance = |guess: &Vec<f64>| self.at(guess, 1.0, 1).map(|apart| (apart.norm_squared(), guess.clone()));
        let all: Vec<(f64, Vec<f64>)> = guesses.iter().filter_map(&mut distance).collect();
        all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, guess)| guess)
    }

    /// Number of coordinates.
    pub fn dimension(&self) -> usize {
        self.origin.len()
    }

    /// Every `stride`-th instant up to this part of the motion.
    fn instants(&self, part: f64, stride: usize) -> usize {
        (self.goal.len() as f64 * part) as usize / stride
    }

    /// The Euclidean length of the way of the target to these instants.
    pub fn way(&self, part: f64, stride: usize) -> f64 {
        let to = (1..=self.instants(part, stride)).map(|k| &self.goal[k * stride - 1]);
        to.map(|(_, q, factor)| (factor * (q - &self.origin)).norm_squared()).sum::<f64>().sqrt()
    }

    /// Whether what these constants leave of differences is so small that it may be nothing.
    fn is_close(&mut self, constants: &[f64], part: f64) -> bool {
        let count = self.instants(part, 1) as f64;
        self.largest(constants, part, 1) < CLOSE * self.way(part, 1) / count.sqrt()
    }

    /// All differences with these constants.
    ///
    /// # Errors
    /// Why there are none.
    pub fn fill(
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
    fn at(&mut self, constants: &[f64], part: f64, stride: usize) -> Option<DVector<f64>> {
        let coarse = self.coarse.clone();
        self.fill(constants, part, stride, self.tolerance, &coarse).ok()
    }

    /// The largest gap up to this part of the motion, at every `stride`-th instant; infinite without one.
    fn largest(&mut self, constants: &[f64], part: f64, stride: usize) -> f64 {
        let n = self.dimension();
        let lengths = |all: DVector<f64>| {
            let squares = all.as_slice().chunks_exact(n).map(|d| d.iter().map(|x| x * x).sum::<f64>());
            squares.fold(0.0, larger).sqrt()
        };
        self.at(constants, part, stride).map_or(f64::INFINITY, lengths)
    }

    /// For each constant the change by which a beginning of the motion changes as much as it is long.
    fn sizes_at(&mut self, from: &[f64]) -> Vec<f64> {
        let way = self.way(BEGINNING, COARSE);
        let Some(at) = self.at(from, BEGINNING, COARSE) else { return vec![1.0; from.len()] };
        let mut size = |j: usize| {
            let mut size = 1.0_f64;
            let (mut grown, mut shrunk) = (false, false);
            for _ in 0..30 {
                let mut moved = from.to_vec();
                moved[j] += size;
                let change = self.at(&moved, BEGINNING, COARSE);
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
}
