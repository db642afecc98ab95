//! Two runs of one motion, however they were made.

use equations::{Compiled, Outputs};

use super::limits::{BEFORE_THE_END, ENDS};
use crate::{Motion, SolveError};

/// The kept and the looser run of a motion: in one chart or several, by equal steps, in a lane.
pub(crate) trait TwoRuns {
    /// Outputs of the kept run.
    fn kept(&mut self, t: f64) -> Result<Outputs, SolveError>;
    /// Outputs of the looser run.
    fn looser(&mut self, t: f64) -> Result<Outputs, SolveError>;
    /// States of the kept run in its first chart. [`TwoRuns::compiled`] then has the root of the motion
    /// there.
    fn states(&mut self, t: f64) -> Option<Vec<f64>>;
    /// States of the looser run.
    fn looser_states(&mut self, t: f64) -> Option<Vec<f64>>;
    /// The equations of the first chart.
    fn compiled(&mut self) -> &mut Compiled;
    /// The sizes of states by which they were integrated.
    fn sizes(&mut self) -> Vec<f64>;
    /// Names of the states.
    fn names(&self) -> Vec<String>;
    /// Instants at which accumulated round-off is looked for, in the first chart: the start, then equidistant
    /// ones, so many or as many as there are.
    fn equidistant(&self, stretches: usize) -> Vec<f64>;
    /// Further instants: some ends of steps, or all.
    fn ends_of_steps(&self) -> Vec<f64>;
}

impl TwoRuns for Motion {
    fn kept(&mut self, t: f64) -> Result<Outputs, SolveError> {
        self.at(t)
    }
    fn looser(&mut self, t: f64) -> Result<Outputs, SolveError> {
        self.looser.outputs(&mut self.compiled, t)
    }
    fn states(&mut self, t: f64) -> Option<Vec<f64>> {
        self.states_at(t).ok()
    }
    fn looser_states(&mut self, t: f64) -> Option<Vec<f64>> {
        self.looser.state(&mut self.compiled, t).ok()
    }
    fn compiled(&mut self) -> &mut Compiled {
        &mut self.compiled
    }
    fn sizes(&mut self) -> Vec<f64> {
        self.kept.sizes().to_vec()
    }
    fn names(&self) -> Vec<String> {
        self.equations.states.iter().map(|state| self.equations.graph.name(state.symbol)).collect()
    }
    fn equidistant(&self, stretches: usize) -> Vec<f64> {
        let (start, part) = (self.start(), self.judged());
        let times = self.grid(stretches).into_iter().map(|t| self.kept_before(start + part * (t - start)));
        times.filter(|t| self.is_in_first_chart(*t)).collect()
    }
    fn ends_of_steps(&self) -> Vec<f64> {
        let (start, length) = (self.start(), self.judged() * (self.end() - self.start()).abs());
        let ends = self.kept.step_times();
        let number = ENDS.min(ends.len());
        let some = (1..=number).map(|k| ends[k * ends.len() / number - 1]);
        let judged = some.filter(|t| (t - start).abs() <= length).map(|t| self.kept_before(t));
        judged.filter(|t| self.is_in_first_chart(*t)).collect()
    }
}

impl Motion {
    /// How much of the motion is judged.
    fn judged(&self) -> f64 {
        if self.is_complete() { 1.0 } else { BEFORE_THE_END }
    }

    /// Behind it, the pivots of the first chart are small.
    fn is_in_first_chart(&self, t: f64) -> bool {
        let start = self.start();
        self.charts.first().is_none_or(|change| (t - start).abs() < (change.t - start).abs())
    }
}
