//! One run of the time loop.

use std::sync::Arc;

use equations::{Compiled, EvaluationFailure, Outputs, Tangents};
use integrate::{Gauge, Options, Problem, Solution, Start, Status, StopCause};

use crate::band::CHUNK;
use crate::lost_rank::column_factors;
use crate::state_scales::sizes;
use crate::{Metric, SolveError};

/// The result of a single run. Without a second run, only its tolerance indicates its error.
#[derive(Clone)]
pub struct SingleRun {
    /// Status, work and states over time.
    pub solution: Solution,
    /// Evaluations that fell back on the plain form.
    pub(crate) fallbacks: usize,
    /// Unknowns of the instant along the way, where its equations have several roots.
    anchors: Vec<(f64, Vec<f64>)>,
    /// [`Options::sizes`] of the run.
    pub(crate) sizes: Vec<f64>,
    /// Whether it ended because its pivots have become small.
    pub(crate) left_chart: bool,
}

impl SingleRun {
    /// Runs from `start`, with its own sizes unless `options` have some; `compiled` has constants and guess.
    /// Ends where the size of the chart comes to `largest`, if one is given. With `tangents` the states are
    /// `(y, dy, …)`; along each direction `dy` has the sizes of `y`.
    pub(crate) fn new(
        compiled: &mut Compiled,
        metric: &mut Metric,
        start: &Start,
        end: f64,
        mut options: Options,
        (largest, tangents): (Option<f64>, Option<&mut Tangents>),
    ) -> Result<SingleRun, SolveError> {
        let own = &start.y[..compiled.dimension()];
        let mut anchors = Vec::new();
        let unknowns = compiled.settle(start.t, own).map_err(SolveError::AtStart)?.to_vec();
        if compiled.needs_guess() {
            anchors.push((start.t, unknowns));
        }
        let mut rates = vec![0.0; own.len()];
        compiled.rates(start.t, own, &mut rates).map_err(SolveError::AtStart)?;
        if options.sizes.is_empty() {
            let parts = start.y.len() / own.len();
            options.sizes = sizes(compiled, metric, start.t, own, end - start.t).repeat(parts);
        }
        let before = compiled.fallbacks();
        let wanted = options.wanted.clone();
        let columns = column_factors(compiled, metric, start.t, own);
        let mut runner = Runner { compiled, tangents, anchors, judged: 1, wanted, largest, columns };
        let solution = integrate::integrate(&mut runner, start, end, &options)?;
        let anchors = runner.anchors;
        let at_guard = |status: &Status| match status {
            Status::Stopped { cause: StopCause::Event { index }, .. } => Some(*index),
            _ => None,
        };
        let left_chart = at_guard(&solution.status) == Some(compiled.guards());
        let fallbacks = compiled.fallbacks() - before;
        Ok(SingleRun { solution, anchors, fallbacks, sizes: options.sizes, left_chart })
    }

    /// The time reached.
    pub fn end(&self) -> f64 {
        self.solution.dense.end()
    }

    /// The states at `t`, which has to be an end of the run where that kept its ends only. Where the
    /// equations of the instant have several roots, `compiled` solves them from the right one after this.
    ///
    /// # Errors
    /// [`SolveError::Dense`] where the run was not kept there ([`Options::wanted`]).
    pub fn states_at(&self, compiled: &mut Compiled, t: f64, states: &mut [f64]) -> Result<(), SolveError> {
        if let Some(unknowns) = self.unknowns_near(t) {
            compiled.set_guess(&unknowns);
        }
        let dense = &self.solution.dense;
        if dense.thinned_to().is_some() {
            return Ok(dense.try_evaluate(t, states)?);
        }
        dense.evaluate(t, states);
        Ok(())
    }

    /// Coordinates, velocities, multipliers and invariants at `t`; as [`SingleRun::states_at`].
    ///
    /// # Errors
    /// [`SolveError::Reading`] where the equations of the instant cannot be solved; as
    /// [`SingleRun::states_at`].
    pub fn at(&self, compiled: &mut Compiled, t: f64) -> Result<Outputs, SolveError> {
        let mut states = vec![0.0; compiled.dimension()];
        self.states_at(compiled, t, &mut states)?;
        outputs(compiled, t, &states)
    }

    /// The unknowns of the instant near `t`, between those before and behind it, where its equations have
    /// several roots.
    pub(crate) fn unknowns_near(&self, t: f64) -> Option<Vec<f64>> {
        let forwards = self.end() >= self.solution.dense.start();
        let behind = self.anchors.partition_point(|(at, _)| if forwards { *at < t } else { *at > t });
        let (from, before) = self.anchors.get(behind.saturating_sub(1))?;
        let (to, next) = self.anchors.get(behind).unwrap_or(self.anchors.last()?);
        let share = if from == to { 0.0 } else { (t - from) / (to - from) };
        Some(before.iter().zip(next).map(|(a, b)| a + share * (b - a)).collect())
    }
}

/// The sum of the squares of the coefficients of the chart.
pub(crate) fn chart_size(compiled: &mut Compiled, t: f64, y: &[f64]) -> f64 {
    let mut values = vec![0.0; compiled.guards() + 1];
    compiled.guard_values(t, y, &mut values);
    values[compiled.guards()]
}

/// Outputs at a state.
pub fn outputs(compiled: &mut Compiled, t: f64, states: &[f64]) -> Result<Outputs, SolveError> {
    compiled.outputs(t, states).map_err(|failure| SolveError::Reading { t, failure })
}

/// Compiled equations as the time integrator sees them.
struct Runner<'a> {
    compiled: &'a mut Compiled,
    /// Of what is carried with the motion.
    tangents: Option<&'a mut Tangents>,
    anchors: Vec<(f64, Vec<f64>)>,
    /// Number of anchors that have been checked, the last one excepted: they lie beside a wanted time.
    judged: usize,
    /// [`Options::wanted`].
    wanted: Option<Arc<[f64]>>,
    /// Size of the chart at which the run ends, where it may.
    largest: Option<f64>,
    /// Factors of the columns of the constraints' rows.
    columns: Vec<f64>,
}

impl Runner<'_> {
    /// Drops anchors between which nothing is wanted, where many are new; the first and the last one stay.
    fn thin(&mut self) {
        let Some(wanted) = self.wanted.as_ref().filter(|_| self.anchors.len() >= self.judged + CHUNK) else { return };
        let times: Vec<f64> = self.anchors[self.judged - 1..].iter().map(|anchor| anchor.0).collect();
        let is_beside = |around: &[f64]| {
            let [from, to] = [around[0].min(around[2]), around[0].max(around[2])];
            wanted.get(wanted.partition_point(|&t| t < from)).is_some_and(|&t| t <= to)
        };
        let mut judged = times.windows(3).map(is_beside);
        let mut place = 0;
        let first = self.judged;
        self.anchors.retain(|_| {
            place += 1;
            place <= first || judged.next().unwrap_or(true)
        });
        self.judged = self.anchors.len();
    }
}

fn refused(failure: EvaluationFailure) -> integrate::EvaluationError {
    integrate::EvaluationError { reason: failure.to_string() }
}

impl Problem for Runner<'_> {
    fn dimension(&self) -> usize {
        self.compiled.dimension() * (1 + self.tangents.as_ref().map_or(0, |tangents| tangents.directions()))
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        match &mut self.tangents {
            Some(tangents) => tangents.rates(self.compiled, t, y, rates).map_err(refused),
            None => self.compiled.rates(t, y, rates).map_err(refused),
        }
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        self.compiled.jacobian(t, y, jacobian).map_err(refused)
    }
    fn has_taylor(&self) -> bool {
        self.compiled.has_series()
    }
    fn taylor(
        &mut self,
        t: f64,
        y: &[f64],
        unit: f64,
        coefficients: &mut [f64],
    ) -> Result<(), integrate::EvaluationError> {
        match &mut self.tangents {
            Some(tangents) => tangents.taylor(self.compiled, t, y, unit, coefficients).map_err(refused),
            None => self.compiled.taylor(t, y, unit, coefficients).map_err(refused),
        }
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<f64, integrate::EvaluationError> {
        match &mut self.tangents {
            Some(tangents) => tangents.project(self.compiled, t, y).map_err(refused),
            None => self.compiled.project(t, y).map_err(refused),
        }
    }
    fn accepted(&mut self, t: f64, y: &[f64]) -> Result<(), integrate::EvaluationError> {
        if self.compiled.needs_guess() {
            let unknowns = self.compiled.settle(t, &y[..self.compiled.dimension()]).map_err(refused)?.to_vec();
            self.anchors.push((t, unknowns));
            self.thin();
        }
        Ok(())
    }
    fn gauges(&self) -> &[Gauge] {
        self.compiled.gauges()
    }
    fn highest_power(&self) -> f64 {
        self.compiled.highest_power()
    }
    fn gauged(&mut self, t: f64, y: &[f64], arguments: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        let own = self.compiled.dimension();
        self.compiled.gauged(t, &y[..own], arguments).map_err(refused)
    }
    fn terms_of_gauged(&mut self, t: f64, y: &[f64], terms: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        let own = self.compiled.dimension();
        self.compiled.terms_of_gauged(t, &y[..own], terms).map_err(refused)
    }
    fn divisors(&self) -> usize {
        self.compiled.divisors()
    }
    fn divided(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        let own = self.compiled.dimension();
        self.compiled.divided(t, &y[..own], values).map_err(refused)
    }
    fn terms_of_rates(&mut self, t: f64, y: &[f64], terms: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        let own = self.compiled.dimension();
        terms.fill(0.0);
        terms[..own].copy_from_slice(&self.compiled.terms_of_rates(t, &y[..own]).map_err(refused)?);
        Ok(())
    }
    fn rank(&self) -> (usize, usize) {
        self.compiled.rank()
    }
    fn rows(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        self.compiled.rows(t, &y[..self.compiled.dimension()], entries).map_err(refused)?;
        entries
            .chunks_mut(self.columns.len())
            .for_each(|row| row.iter_mut().zip(&self.columns).for_each(|(x, c)| *x *= c));
        Ok(())
    }
    fn events(&self) -> usize {
        self.compiled.guards() + usize::from(self.largest.is_some())
    }
    fn event_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        self.compiled.guard_values(t, &y[..self.compiled.dimension()], values);
        if let (Some(largest), Some(size)) = (self.largest, values.last_mut()) {
            *size = largest - *size;
        }
        Ok(())
    }
}
