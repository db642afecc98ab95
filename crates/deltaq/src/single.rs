//! Single runs of the time loop, for measurements: what [`crate::solve`] does twice, once, as often as wanted.

use integrate::{Options, Status, Work};
use mechanics::{ConstantsRule, Equations, Outputs};

use crate::motion::resolve;
use crate::run::{Prepared, Trajectory};
use crate::{Setting, Settings, SolveError};

/// Equations compiled and started, with their constants known.
pub struct SingleRuns {
    prepared: Prepared,
    constants: Vec<f64>,
    end: f64,
}

/// One run: how it ended, what it cost, the states over time.
pub struct SingleRun {
    /// How it ended.
    pub status: Status,
    /// What it cost.
    pub work: Work,
    trajectory: Trajectory,
}

impl SingleRuns {
    /// Compiles `equations` (with a Jacobian where the method of `settings` asks for one) and finds their constants; natural ones by integrating as
    /// `settings` say.
    ///
    /// # Errors
    /// [`SolveError`] where there is no start.
    pub fn new(
        setting: Setting,
        equations: Equations,
        constants: &ConstantsRule,
        settings: &Settings,
    ) -> Result<Self, SolveError> {
        let mut prepared = Prepared::new(setting, equations, settings)?;
        let constants = resolve(&mut prepared, constants, settings)?;
        Ok(SingleRuns { prepared, constants, end: setting.end })
    }

    /// The equations.
    pub fn equations(&self) -> &Equations {
        &self.prepared.equations
    }

    /// Values of the free constants.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// `y(t₀)` and `F(t₀, y(t₀))`.
    ///
    /// # Errors
    /// [`SolveError::AtStart`] where the equations of the instant cannot be solved.
    pub fn start(&mut self) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let y = self.prepared.start(&self.constants);
        let mut rates = vec![0.0; y.len()];
        self.prepared.compiled.settle(self.prepared.t, &y)?;
        self.prepared.compiled.rates(self.prepared.t, &y, &mut rates)?;
        Ok((y, rates))
    }

    /// One run from the start to the end.
    ///
    /// # Errors
    /// [`SolveError`] where it cannot be started; how it ended otherwise is [`SingleRun::status`].
    pub fn run(&mut self, options: &Options) -> Result<SingleRun, SolveError> {
        let run = self.prepared.run_with(&self.constants, self.end, options)?;
        let (status, work) = (run.solution.status.clone(), run.solution.work);
        Ok(SingleRun { status, work, trajectory: run.trajectory() })
    }

    /// Coordinates, velocities, multipliers and invariants of `run` at `t`.
    ///
    /// # Errors
    /// [`SolveError::AtStart`] where the equations of the instant cannot be solved.
    pub fn outputs(&mut self, run: &SingleRun, t: f64) -> Result<Outputs, SolveError> {
        let mut state = vec![0.0; run.trajectory.dense.dimension()];
        Ok(run.trajectory.outputs(&mut self.prepared.compiled, t, &mut state)?)
    }
}

impl SingleRun {
    /// The states at `t`.
    pub fn states_at(&self, t: f64, states: &mut [f64]) {
        self.trajectory.dense.evaluate(t, states);
    }

    /// Number of states.
    pub fn dimension(&self) -> usize {
        self.trajectory.dense.dimension()
    }
}
