//! States over time, however they were computed.

use equations::{Compiled, Outputs};

use crate::SolveError;
use crate::discrete_run::DiscreteRun;
use crate::single_run::{SingleRun, outputs};

/// States over time.
#[derive(Clone)]
pub(crate) enum Trajectory {
    /// The polynomials of the time loop.
    TimeLoop(Box<SingleRun>),
    /// The nodes of a discrete motion.
    Discrete(Box<DiscreteRun>),
}

impl Trajectory {
    /// Times of the start and of the end.
    pub(crate) fn ends(&self) -> [f64; 2] {
        match self {
            Trajectory::TimeLoop(run) => [run.solution.dense.start(), run.end()],
            Trajectory::Discrete(run) => run.ends(),
        }
    }

    /// End points of the steps.
    pub(crate) fn step_times(&self) -> Vec<f64> {
        match self {
            Trajectory::TimeLoop(run) => run.solution.dense.step_times(),
            Trajectory::Discrete(run) => run.times().to_vec(),
        }
    }

    /// The state at `t`. Equations of the instant with several roots then start from the right one.
    pub(crate) fn state(&mut self, compiled: &mut Compiled, t: f64) -> Result<Vec<f64>, SolveError> {
        let mut state = vec![0.0; compiled.dimension()];
        match self {
            Trajectory::TimeLoop(run) => run.states_at(compiled, t, &mut state),
            Trajectory::Discrete(run) => run.state(compiled, t, &mut state)?,
        }
        Ok(state)
    }

    /// What is read off at `t`.
    pub(crate) fn outputs(&mut self, compiled: &mut Compiled, t: f64) -> Result<Outputs, SolveError> {
        let state = self.state(compiled, t)?;
        outputs(compiled, t, &state)
    }
}
