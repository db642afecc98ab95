//! Runs of the time loop: equations compiled and started, states over time.

use integrate::{DenseOutput, Options, Problem, Solution, Start};
use mechanics::{Compiled, Equations, EvaluationFailure, Outputs, complete_removal_start};
use symbolic::Symbol;

use crate::{Setting, Settings, SolveError};

/// States over time, and the unknowns `z` along the way where the equations of an instant have several roots.
#[derive(Clone)]
pub(crate) struct Trajectory {
    pub(crate) dense: DenseOutput,
    anchors: Vec<(f64, Vec<f64>)>,
}

impl Trajectory {
    /// What is read off at `t`; `state` is room for the state there.
    pub(crate) fn outputs(
        &self,
        compiled: &mut Compiled,
        t: f64,
        state: &mut [f64],
    ) -> Result<Outputs, EvaluationFailure> {
        let nearest = self.anchors.iter().min_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs()));
        if let Some((_, unknowns)) = nearest {
            compiled.set_guess(unknowns);
        }
        self.dense.evaluate(t, state);
        compiled.outputs(t, state)
    }
}

/// A run of the time loop.
pub(crate) struct Run {
    pub(crate) solution: Solution,
    anchors: Vec<(f64, Vec<f64>)>,
}

impl Run {
    pub(crate) fn trajectory(self) -> Trajectory {
        Trajectory { dense: self.solution.dense, anchors: self.anchors }
    }
}

/// Equations compiled and started: what every run of the same motion shares.
pub(crate) struct Prepared {
    pub(crate) equations: Equations,
    pub(crate) compiled: Compiled,
    start_tape: symbolic::Tape,
    start_inputs: Vec<f64>,
    pub(crate) guess: Vec<f64>,
    pub(crate) t: f64,
}

impl Prepared {
    pub(crate) fn new(setting: Setting, equations: Equations, settings: &Settings) -> Result<Self, SolveError> {
        let mut compiled = Compiled::new(&equations)?;
        if settings.method.is_implicit() {
            compiled = compiled.with_jacobian(&equations)?;
        }
        let mut values = setting.system.values_at(setting.start);
        if let Some(removal) = &equations.removal {
            values.extend(complete_removal_start(setting.system, removal, setting.start)?.values());
        }
        let (mut symbols, mut start_inputs): (Vec<Symbol>, Vec<f64>) = values.into_iter().unzip();
        symbols.extend(equations.constant_symbols());
        start_inputs.resize(symbols.len(), 0.0);
        let mut outputs: Vec<symbolic::Expr> = equations.states.iter().map(|y| y.start).collect();
        outputs.extend(equations.blocks.iter().flat_map(|b| b.guess.iter().copied()));
        let start_tape = equations.graph.compile(&symbols, &outputs, &equations.parameters)?;
        Ok(Prepared { equations, compiled, start_tape, start_inputs, guess: Vec::new(), t: setting.start.t })
    }

    /// Sets the free constants and returns `y(t₀)`.
    pub(crate) fn start(&mut self, constants: &[f64]) -> Vec<f64> {
        let first = self.start_inputs.len() - constants.len();
        self.start_inputs[first..].copy_from_slice(constants);
        let mut values = vec![0.0; self.start_tape.outputs()];
        self.start_tape.evaluate(&self.start_inputs, &mut self.start_tape.workspace(), &mut values);
        self.guess = values.split_off(self.equations.states.len());
        self.compiled.set_constants(constants);
        if self.guess.len() == self.equations.unknowns().len() {
            self.compiled.set_guess(&self.guess);
        }
        values
    }

    /// One run.
    pub(crate) fn run(
        &mut self,
        constants: &[f64],
        end: f64,
        tolerance: f64,
        settings: &Settings,
    ) -> Result<Run, SolveError> {
        let mut options = Options::with_tolerance(tolerance);
        options.method = settings.method;
        options.projection = settings.projection;
        options.max_steps = settings.max_steps;
        options.interrupt = settings.interrupt.clone();
        self.run_with(constants, end, &options)
    }

    /// One run with all options chosen.
    pub(crate) fn run_with(&mut self, constants: &[f64], end: f64, options: &Options) -> Result<Run, SolveError> {
        let y = self.start(constants);
        let mut anchors = Vec::new();
        let start = self.compiled.settle(self.t, &y)?.to_vec();
        self.compiled.rates(self.t, &y, &mut vec![0.0; y.len()])?;
        if self.compiled.needs_guess() {
            anchors.push((self.t, start));
        }
        let mut runner = Runner { compiled: &mut self.compiled, anchors };
        let solution = integrate::integrate(&mut runner, &Start { t: self.t, y }, end, options)?;
        Ok(Run { solution, anchors: runner.anchors })
    }
}

/// Compiled equations as the time integrator sees them.
struct Runner<'a> {
    compiled: &'a mut Compiled,
    anchors: Vec<(f64, Vec<f64>)>,
}

fn refused(failure: EvaluationFailure) -> integrate::EvaluationError {
    integrate::EvaluationError { reason: failure.to_string() }
}

impl Problem for Runner<'_> {
    fn dimension(&self) -> usize {
        self.compiled.dimension()
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        self.compiled.rates(t, y, rates).map_err(refused)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        self.compiled.jacobian(t, y, jacobian).map_err(refused)
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<f64, integrate::EvaluationError> {
        self.compiled.project(t, y).map_err(refused)
    }
    fn accepted(&mut self, t: f64, y: &[f64]) -> Result<(), integrate::EvaluationError> {
        if self.compiled.needs_guess() {
            let unknowns = self.compiled.settle(t, y).map_err(refused)?.to_vec();
            self.anchors.push((t, unknowns));
        }
        Ok(())
    }
    fn events(&self) -> usize {
        self.compiled.guards()
    }
    fn event_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), integrate::EvaluationError> {
        self.compiled.guard_values(t, y, values);
        Ok(())
    }
}
