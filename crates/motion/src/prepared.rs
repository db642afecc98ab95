//! Equations compiled and started, for runs of the time loop and for other integrators than ours.

use equations::{Compiled, Equations, Plan, Role, Tangents};
use integrate::{Method, Options, Start};
use symbolic::Symbol;

use crate::band::limits::UNITS;
use crate::band::ulp_perturbation::move_digits;
use crate::direction::{Chord, Direction};
use crate::method::{Chosen, suited};
use crate::single_run::{SingleRun, chart_size};
use crate::start_values::StartValues;
use crate::state_scales::unbounded_sizes;
use crate::{Metric, Setting, Settings, SolveError};

/// Equations compiled and started: what every run of the same motion shares.
#[derive(Clone)]
pub struct Prepared {
    /// The equations.
    pub equations: Equations,
    /// `ẏ = F(t, y)`; the constants and the guess are set.
    pub compiled: Compiled,
    /// The form in which it is evaluated.
    pub form: Plan,
    /// The method asked for, or one that suits the equations.
    pub method: Chosen,
    /// Values of the free constants.
    pub constants: Vec<f64>,
    /// How many of these, the last ones, are parameters that vary.
    parameters: usize,
    /// `t₀`.
    pub t: f64,
    /// `y(t₀)`.
    pub start: Vec<f64>,
    /// The unknowns of the instant at the start, for [`Compiled::set_guess`]; empty if not derived.
    pub guess: Vec<f64>,
    pub(crate) values: StartValues,
    /// For the sizes of states.
    metric: Metric,
    /// [`mechanics::System::breakpoints`].
    breakpoints: Vec<f64>,
    /// Where the second run starts, unless where the first does.
    pub(crate) other_start: Option<Vec<f64>>,
    /// Where a search of natural constants starts, if anywhere.
    pub(crate) chord: Option<Chord>,
    /// The size of the chart at which another one is looked for, where there may be others.
    largest: Option<f64>,
}

/// `t`, `y`, the unknowns of the instant and the size of the chart at a start.
pub(crate) type Origin = (f64, Vec<f64>, Vec<f64>, Option<f64>);

/// Another chart is looked for where the squares of the coefficients have come to this many times those that
/// it was chosen with.
pub(crate) const GROWTH: f64 = 100.0;

impl Prepared {
    /// With the free constants zero.
    pub fn new(setting: Setting, equations: Equations, settings: &Settings) -> Result<Self, SolveError> {
        let constants = vec![0.0; equations.free_constants.len()];
        Prepared::around(setting, equations, constants, 0, settings)
    }

    /// In a form that suits these values of the free constants; the last `parameters` are varied parameters.
    pub(crate) fn around(
        setting: Setting,
        equations: Equations,
        constants: Vec<f64>,
        parameters: usize,
        settings: &Settings,
    ) -> Result<Self, SolveError> {
        settings.check()?;
        let t = setting.start.t;
        let mut values = StartValues::new(setting, &equations)?;
        values.set_constants(&constants);
        let point = [&[t], values.evaluate().0, &constants[..]].concat();
        let form = if settings.plain { Plan::plain(&equations) } else { Plan::choose(&equations, Some(&point))? };
        let compiled = Compiled::with_plan(&equations, &form)?;
        let asked = |method| Chosen { method, why: "asked for".into() };
        let method = settings.method.map_or_else(|| suited(&equations), asked);
        let (start, guess) = (Vec::new(), Vec::new());
        let varied: Vec<Symbol> = equations.free_constants.iter().map(|c| c.symbol).collect();
        let metric = Metric::varying(setting.system, &varied[varied.len() - parameters..])?;
        let (other_start, chord, largest, breakpoints) = (None, None, None, setting.system.breakpoints.clone());
        let mut prepared = Prepared {
            equations,
            compiled,
            form,
            method,
            constants,
            parameters,
            t,
            start,
            guess,
            values,
            metric,
            breakpoints,
            other_start,
            chord,
            largest,
        };
        prepared.metric.set_parameters(&prepared.constants[prepared.constants.len() - parameters..]);
        prepared.start_anew();
        if prepared.compiled.has_chart() {
            prepared.largest = Some(GROWTH * chart_size(&mut prepared.compiled, t, &prepared.start).max(1.0));
        }
        prepared.complete(prepared.method.method)?;
        Ok(prepared)
    }

    /// `y(t₀)`, with what round-off leaves of a zero as zero: a rate may depend on it by any part.
    pub fn start_without_round_off(&self) -> Vec<f64> {
        let vanishing = self.values.vanishing();
        self.start.iter().zip(vanishing).map(|(&y, vanishes)| if vanishes { 0.0 } else { y }).collect()
    }

    /// Compiles what `method` needs beyond the rates, once; the first run does it anyway.
    ///
    /// # Errors
    /// [`SolveError::Compile`].
    pub fn complete(&mut self, method: Method) -> Result<(), SolveError> {
        if method.is_implicit() && !self.compiled.has_jacobian() {
            self.compiled = self.compiled.clone().with_jacobian(&self.equations)?;
        }
        if method == Method::Taylor && !self.compiled.has_series() {
            self.compiled.add_series(&self.equations, &self.form)?;
        }
        Ok(())
    }

    /// The free constants but the parameters.
    pub(crate) fn own_constants(&self) -> &[f64] {
        &self.constants[..self.constants.len() - self.parameters]
    }

    /// Sets the free constants but the parameters, and by them the start.
    pub fn set_constants(&mut self, own: &[f64]) {
        self.constants[..own.len()].copy_from_slice(own);
        self.start_anew();
    }

    /// Sets the parameters that vary; what motions start from is set by [`Prepared::set_constants`].
    pub(crate) fn set_parameters(&mut self, parameters: &[f64]) {
        let own = self.constants.len() - self.parameters;
        self.constants[own..].copy_from_slice(parameters);
        self.metric.set_parameters(parameters);
    }

    /// The start and the free constants.
    pub(crate) fn start_and_constants(&self) -> [Vec<f64>; 2] {
        [self.start.clone(), self.constants.clone()]
    }

    /// The start, as the constants have it.
    fn start_anew(&mut self) {
        self.values.set_constants(&self.constants);
        let (start, guess) = self.values.evaluate();
        (self.start, self.guess) = (start.to_vec(), guess.to_vec());
        self.set_compiled();
    }

    /// Sets the constants and the guess of the compiled equations.
    pub(crate) fn set_compiled(&mut self) {
        self.compiled.set_constants(&self.constants);
        if !self.guess.is_empty() {
            self.compiled.set_guess(&self.guess);
        }
    }

    /// Integrates once from start to `end`: half of [`crate::solve`], for those who know the error otherwise.
    ///
    /// # Errors
    /// [`SolveError`] where the run cannot be started; how it ended is in [`SingleRun::solution`].
    pub fn integrate(&mut self, end: f64, options: &Options) -> Result<SingleRun, SolveError> {
        self.complete(options.method)?;
        self.run_from(self.start.clone(), end, options, None)
    }

    /// [`Prepared::integrate`]; ends where pivots have become small.
    pub(crate) fn run_in_chart(&mut self, end: f64, options: &Options) -> Result<SingleRun, SolveError> {
        self.complete(options.method)?;
        self.run_from(self.start.clone(), end, options, self.largest)
    }

    /// How large states are in a run from the start to `end`.
    pub(crate) fn sizes(&mut self, end: f64) -> Vec<f64> {
        self.set_compiled();
        unbounded_sizes(&mut self.compiled, &mut self.metric, self.t, &self.start, end - self.t)
    }

    fn run_from(
        &mut self,
        y: Vec<f64>,
        end: f64,
        options: &Options,
        largest: Option<f64>,
    ) -> Result<SingleRun, SolveError> {
        self.set_compiled();
        let mut options = options.clone();
        options.breakpoints.extend(&self.breakpoints);
        SingleRun::new(&mut self.compiled, &mut self.metric, &Start { t: self.t, y }, end, options, (largest, None))
    }

    /// [`Prepared::integrate`] of the motion and of its `tangents`, which start there, for equations that are
    /// complete; with the last digits of the start `moved`, as the run that estimates the error has them.
    pub(crate) fn integrate_with(
        &mut self,
        tangents: &mut Tangents,
        starts: &[Vec<f64>],
        end: f64,
        options: &Options,
        moved: bool,
    ) -> Result<SingleRun, SolveError> {
        self.set_compiled();
        let mut options = options.clone();
        options.breakpoints.extend(&self.breakpoints);
        let mut y = [std::slice::from_ref(&self.start), starts].concat().concat();
        if moved {
            move_digits(&mut y, |_| UNITS);
        }
        let start = Start { t: self.t, y };
        SingleRun::new(&mut self.compiled, &mut self.metric, &start, end, options, (None, Some(tangents)))
    }

    /// How the motion moves with a free constant, in units of this size.
    pub fn along_constant(&self, constant: usize, size: f64) -> Direction {
        let place = self.values.first_constant(self.constants.len()) + constant;
        let start = self.values.derivative(place).into_iter().map(|x| x * size).collect();
        let mut constants = vec![0.0; self.constants.len()];
        constants[constant] = size;
        Direction { start, constants, scale: size }
    }

    /// The run that estimates the error of `kept`, no farther than that one came. Its start has its last
    /// digits changed: how far the two ends are apart then also tells what those digits are worth.
    pub(crate) fn second_run(
        &mut self,
        kept: &SingleRun,
        end: f64,
        options: &Options,
    ) -> Result<SingleRun, SolveError> {
        let mut y = self.other_start.as_ref().unwrap_or(&self.start).clone();
        // places are exact; what moves is known as well as the constraints can tell it
        let place = |role: Role| matches!(role, Role::Position | Role::DisplacementParameter | Role::Memory);
        let (states, lost) = (&self.equations.states, self.equations.lost_digits.max(UNITS));
        move_digits(&mut y, |i| if place(states[i].role) { UNITS } else { lost });
        if kept.end() == end || kept.end() == self.t && !kept.left_chart {
            return self.run_from(y, end, options, None);
        }
        self.run_from(y, kept.end(), &Options { sizes: kept.sizes.clone(), ..options.clone() }, None)
    }

    /// Where and how the first run starts, for [`Prepared::return_to`].
    pub(crate) fn origin(&self) -> Origin {
        (self.t, self.start.clone(), self.guess.clone(), self.largest)
    }

    /// What runs next starts there.
    pub(crate) fn return_to(&mut self, (t, start, guess, largest): Origin) {
        (self.t, self.start, self.guess, self.largest, self.other_start) = (t, start, guess, largest, None);
    }

    /// What runs next starts where these two have come, and goes on until the chart has become worse again.
    pub(crate) fn go_on(&mut self, [kept, looser]: [&SingleRun; 2]) {
        let [start, other] = [kept, looser].map(|run| run.solution.dense.end_state().to_vec());
        (self.t, self.start, self.other_start) = (kept.end(), start, Some(other));
        self.largest = self.largest.map(|largest| largest * GROWTH);
        self.guess = kept.unknowns_near(self.t).unwrap_or_default();
    }
}
