//! A single motion as two runs, and whether their difference is an error.

use equations::{Compiled, Outputs};

use super::invariant_monitor::InvariantMonitor;
use super::limits::{BEFORE_THE_END, INSTANTS, LOOKS};
use super::{Doubt, TwoRuns};
use crate::{Motion, Setting, Settings, SolveError};

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
        let number = if ends.len() > INSTANTS { INSTANTS / 2 } else { ends.len() };
        let mut shortest: Vec<[f64; 2]> = ends.windows(2).map(|step| [(step[1] - step[0]).abs(), step[1]]).collect();
        shortest.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let some = (1..=number).map(|k| ends[k * ends.len() / number - 1]);
        let some = some.chain(shortest.into_iter().take(INSTANTS - number).map(|[_, end]| end));
        let judged = some.filter(|t| (t - start).abs() <= length).map(|t| self.kept_before(t));
        judged.filter(|t| self.is_in_first_chart(*t)).collect()
    }
}

impl Motion {
    /// Looks where the difference of its runs is not an error, what it changes of what the user expects to be
    /// constant, and what round-off both runs share.
    ///
    /// # Errors
    /// [`SolveError`] if what is looked at cannot be compiled.
    pub(crate) fn judge(&mut self, setting: Setting, settings: &Settings) -> Result<(), SolveError> {
        let method = self.method.as_ref().map(|chosen| chosen.method);
        let steps = [self.kept.step_times(), self.looser.step_times()];
        self.doubt = Doubt::of([&steps[0], &steps[1]], self.end(), self.is_complete(), method);
        if self.doubt.is_some() || settings.plain {
            return Ok(());
        }
        let mut monitor = InvariantMonitor::new(setting.system, &self.equations, &[])?;
        let times = self.grid(LOOKS);
        let kept: Vec<(f64, Outputs)> = times.iter().map_while(|&t| Some((t, self.at(t).ok()?))).collect();
        self.doubt = monitor.doubt(self, &kept, &[]);
        (self.breaches, self.unseen) = (monitor.breaches, monitor.unseen);
        if self.doubt.is_some() {
            return Ok(());
        }
        self.count_round_off(setting, &Settings { method, ..settings.clone() })
    }

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
