//! Runs of the time loop: equations compiled and started, states over time.

use equations::{Compiled, Equations, EvaluationFailure, Outputs, Plan, Role};
use integrate::{DenseOutput, Method, Options, Problem, Solution, Start};
use mechanics::complete_removal_start;
use symbolic::Symbol;

use crate::nodes::Nodes;
use crate::{Setting, Settings, SolveError};

/// States over time, and the unknowns `z` along the way where the equations of an instant have several roots.
#[derive(Clone)]
pub(crate) struct Trajectory {
    path: Path,
    anchors: Vec<(f64, Vec<f64>)>,
}

/// Where states come from.
#[derive(Clone)]
enum Path {
    /// The polynomials of the time loop.
    Dense(DenseOutput),
    /// The nodes of a discrete motion.
    Nodes(Box<Nodes>),
}

impl Trajectory {
    pub(crate) fn of_nodes(nodes: Nodes) -> Self {
        Trajectory { path: Path::Nodes(Box::new(nodes)), anchors: Vec::new() }
    }

    /// Times of the start and of the end.
    pub(crate) fn ends(&self) -> [f64; 2] {
        match &self.path {
            Path::Dense(dense) => [dense.start(), dense.end()],
            Path::Nodes(nodes) => nodes.ends(),
        }
    }

    /// End points of the steps.
    pub(crate) fn step_times(&self) -> Vec<f64> {
        match &self.path {
            Path::Dense(dense) => dense.step_times(),
            Path::Nodes(nodes) => nodes.times().to_vec(),
        }
    }

    /// The state at `t`. Where the equations of the instant have several roots, they are solved from the right one after this.
    pub(crate) fn state(&mut self, compiled: &mut Compiled, t: f64, state: &mut [f64]) -> Result<(), SolveError> {
        match &mut self.path {
            Path::Dense(dense) => {
                if let Some(unknowns) = nearest(&self.anchors, t) {
                    compiled.set_guess(unknowns);
                }
                dense.evaluate(t, state);
                Ok(())
            }
            Path::Nodes(nodes) => nodes.state(compiled, t, state),
        }
    }

    /// What is read off at `t`; `state` is room for the state there.
    pub(crate) fn outputs(
        &mut self,
        compiled: &mut Compiled,
        t: f64,
        state: &mut [f64],
    ) -> Result<Outputs, SolveError> {
        self.state(compiled, t, state)?;
        compiled.outputs(t, state).map_err(|failure| SolveError::Reading { t, failure })
    }
}

/// The unknowns that are known nearest to `t`.
fn nearest(anchors: &[(f64, Vec<f64>)], t: f64) -> Option<&[f64]> {
    let nearest = anchors.iter().min_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs()));
    nearest.map(|(_, unknowns)| &unknowns[..])
}

/// Where a run starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// From the start.
    Start,
    /// From the start with its last digits changed: how far this run ends from the other one also tells what those digits are worth.
    LastDigit,
}

/// Units in the last place by which a start is moved.
const UNITS: f64 = 4.0;

/// A few units in the last place, up or down as the place in `y` has it.
pub(crate) fn move_last_digits(y: &mut [f64]) {
    move_digits(y, |_| UNITS);
}

/// So many units in the last place of each, up or down as the place in `y` has it.
fn move_digits(y: &mut [f64], units: impl Fn(usize) -> f64) {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    for (i, x) in y.iter_mut().enumerate() {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let part = units(i) * f64::EPSILON;
        *x *= if state & 1 == 0 { 1.0 + part } else { 1.0 - part };
    }
}

/// Parts of the largest size under which a size is round-off.
const NO_SIZE: f64 = 1e-14;

/// The size of each state, by which the absolute tolerance is multiplied: what it is at the start or what its rate there makes of it within the
/// run, if that is under 1. So a motion of 10⁻¹² m is resolved as well as one of 1 m. A state that starts as round-off
/// of the others, or at rest in zero, says nothing of its size, and has 1.
pub(crate) fn sizes(y: &[f64], rates: &[f64], length: f64) -> Vec<f64> {
    let reach: Vec<f64> = y.iter().zip(rates).map(|(y, rate)| y.abs().max((rate * length).abs())).collect();
    let least = NO_SIZE * reach.iter().copied().fold(0.0, f64::max);
    reach.into_iter().map(|size| if size > least { size.min(1.0) } else { 1.0 }).collect()
}

/// A run of the time loop.
pub(crate) struct Run {
    pub(crate) solution: Solution,
    /// Evaluations that fell back on the plain form.
    pub(crate) fallbacks: usize,
    anchors: Vec<(f64, Vec<f64>)>,
    /// [`Options::sizes`] of the run.
    sizes: Vec<f64>,
}

impl Run {
    /// The unknowns of the instant near `t`, where its equations have several roots.
    pub(crate) fn unknowns_near(&self, t: f64) -> Option<&[f64]> {
        nearest(&self.anchors, t)
    }

    pub(crate) fn trajectory(self) -> Trajectory {
        Trajectory { path: Path::Dense(self.solution.dense), anchors: self.anchors }
    }
}

/// Equations compiled and started: what every run of the same motion shares.
#[derive(Clone)]
pub(crate) struct Prepared {
    pub(crate) equations: Equations,
    pub(crate) compiled: Compiled,
    /// The form that was chosen.
    pub(crate) form: Plan,
    /// `t, q, v`, what belongs to a removal, the free constants → the states, guesses for the unknowns of the instant.
    pub(crate) start_tape: symbolic::Tape,
    pub(crate) start_symbols: Vec<Symbol>,
    pub(crate) start_inputs: Vec<f64>,
    pub(crate) guess: Vec<f64>,
    pub(crate) t: f64,
}

impl Prepared {
    pub(crate) fn new(setting: Setting, equations: Equations, settings: &Settings) -> Result<Self, SolveError> {
        let constants = vec![0.0; equations.free_constants.len()];
        Prepared::around(setting, equations, &constants, settings)
    }

    /// In a form that suits these values of the free constants.
    pub(crate) fn around(
        setting: Setting,
        equations: Equations,
        constants: &[f64],
        settings: &Settings,
    ) -> Result<Self, SolveError> {
        let mut values = setting.system.values_at(setting.start);
        if let Some(removal) = &equations.removal {
            values.extend(complete_removal_start(setting.system, removal, setting.start)?.values());
        }
        let (mut symbols, mut start_inputs): (Vec<Symbol>, Vec<f64>) = values.into_iter().unzip();
        symbols.extend(equations.constant_symbols());
        start_inputs.extend(constants);
        let mut outputs: Vec<symbolic::Expr> = equations.states.iter().map(|y| y.start).collect();
        outputs.extend(equations.blocks.iter().flat_map(|b| b.guess.iter().copied()));
        let start_tape = equations.tape(&symbols, &outputs)?;
        let mut start = vec![0.0; start_tape.outputs()];
        start_tape.evaluate(&start_inputs, &mut start_tape.workspace(), &mut start);
        let mut point = vec![setting.start.t];
        point.extend(&start[..equations.states.len()]);
        point.extend(constants);
        let form = if settings.plain { Plan::plain(&equations) } else { Plan::choose(&equations, Some(&point))? };
        let mut compiled = Compiled::with_plan(&equations, &form)?;
        if settings.method.is_implicit() {
            compiled = compiled.with_jacobian(&equations)?;
        }
        if settings.method == Method::Taylor {
            compiled = compiled.with_series(&equations, &form)?;
        }
        Ok(Prepared {
            form,
            equations,
            compiled,
            start_tape,
            start_symbols: symbols,
            start_inputs,
            guess: Vec::new(),
            t: setting.start.t,
        })
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

    /// The run that estimates the error of `kept`, no farther than that one came.
    pub(crate) fn second_run(
        &mut self,
        constants: &[f64],
        end: f64,
        kept: &Run,
        settings: &Settings,
    ) -> Result<Run, SolveError> {
        let reached = kept.solution.dense.end();
        let options = Options { sizes: kept.sizes.clone(), ..self.options(settings.tolerance, settings) };
        if kept.solution.work.steps == 0 || reached == end {
            return self.run(constants, end, settings.tolerance, Origin::LastDigit, settings);
        }
        let start = self.at(constants, Origin::LastDigit);
        integrate_once(&mut self.compiled, start, reached, &options)
    }

    /// One run.
    pub(crate) fn run(
        &mut self,
        constants: &[f64],
        end: f64,
        tolerance: f64,
        start: Origin,
        settings: &Settings,
    ) -> Result<Run, SolveError> {
        let options = self.options(tolerance, settings);
        let start = self.at(constants, start);
        integrate_once(&mut self.compiled, start, end, &options)
    }

    fn options(&self, tolerance: f64, settings: &Settings) -> Options {
        Options {
            method: settings.method,
            projection: settings.projection,
            max_steps: settings.max_steps,
            interrupt: settings.interrupt.clone(),
            ..Options::with_tolerance(tolerance)
        }
    }

    fn at(&mut self, constants: &[f64], origin: Origin) -> Start {
        let mut y = self.start(constants);
        if origin == Origin::LastDigit {
            // places are exact; what moves is known as well as the constraints can tell it
            let place = |role: Role| matches!(role, Role::Position | Role::DisplacementParameter | Role::Memory);
            let (states, lost) = (&self.equations.states, self.equations.lost_digits.max(UNITS));
            move_digits(&mut y, |i| if place(states[i].role) { UNITS } else { lost });
        }
        Start { t: self.t, y }
    }
}

/// One run of the time loop from `start`, with the sizes of its own start where `options` have none; the constants and the guess of `compiled` are set.
pub(crate) fn integrate_once(
    compiled: &mut Compiled,
    start: Start,
    end: f64,
    options: &Options,
) -> Result<Run, SolveError> {
    let mut anchors = Vec::new();
    let unknowns = compiled.settle(start.t, &start.y).map_err(SolveError::AtStart)?.to_vec();
    if compiled.needs_guess() {
        anchors.push((start.t, unknowns));
    }
    let mut rates = vec![0.0; start.y.len()];
    compiled.rates(start.t, &start.y, &mut rates).map_err(SolveError::AtStart)?;
    let mut options = options.clone();
    if options.sizes.is_empty() {
        options.sizes = sizes(&start.y, &rates, end - start.t);
    }
    let before = compiled.fallbacks();
    let mut runner = Runner { compiled, anchors };
    let solution = integrate::integrate(&mut runner, &start, end, &options)?;
    let anchors = runner.anchors;
    Ok(Run { solution, anchors, fallbacks: compiled.fallbacks() - before, sizes: options.sizes })
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
        self.compiled.taylor(t, y, unit, coefficients).map_err(refused)
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
