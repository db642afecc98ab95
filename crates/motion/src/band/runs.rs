//! Two runs of one motion, however they were made.

use equations::{Compiled, Outputs};

use crate::SolveError;

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
    /// Further instants: some ends of steps, the shortest among them, or all.
    fn ends_of_steps(&self) -> Vec<f64>;
}
