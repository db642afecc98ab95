//! Equations made ready for single runs of the time loop, and for other integrators than ours.

use equations::{Compiled, Equations, Outputs, Plan};
use integrate::{Method, Options, ProjectionReport, Start, Status, Work};
use mechanics::ConstantsRule;

use crate::motion::resolve;
use crate::run::{Prepared, Trajectory, integrate_once};
use crate::{Setting, Settings, SolveError};

/// Equations compiled and started.
#[derive(Clone)]
pub struct Ready {
    /// The equations.
    pub equations: Equations,
    /// `ẏ = F(t, y)`, with its Jacobian after [`ready()`]; the constants and the guess are set.
    pub compiled: Compiled,
    /// The form in which it is evaluated.
    pub form: Plan,
    /// Values of the free constants.
    pub constants: Vec<f64>,
    /// `t₀`.
    pub t: f64,
    /// `y(t₀)`.
    pub start: Vec<f64>,
    /// The unknowns of the instant at the start, for [`Compiled::set_guess`]; empty where the derivation knows none.
    pub guess: Vec<f64>,
}

/// What a single run came to. No second run stands beside it: nothing is known of its error but what its tolerance says.
pub struct SingleRun {
    /// How it ended.
    pub status: Status,
    /// What it cost.
    pub work: Work,
    /// How far the projections moved the states.
    pub projection: ProjectionReport,
    trajectory: Trajectory,
}

impl SingleRun {
    /// The time reached.
    pub fn end(&self) -> f64 {
        self.trajectory.ends()[1]
    }

    /// Coordinates, velocities, multipliers and invariants at `t`, which has to be an end of the run where that kept its ends only.
    ///
    /// # Errors
    /// [`SolveError::Reading`] where the equations of the instant cannot be solved.
    pub fn at(&mut self, ready: &mut Ready, t: f64) -> Result<Outputs, SolveError> {
        let mut state = vec![0.0; ready.start.len()];
        self.trajectory.outputs(&mut ready.compiled, t, &mut state)
    }

    /// The states at `t`.
    ///
    /// # Errors
    /// As [`SingleRun::at`].
    pub fn states_at(&mut self, ready: &mut Ready, t: f64, states: &mut [f64]) -> Result<(), SolveError> {
        self.trajectory.state(&mut ready.compiled, t, states)
    }
}

impl Ready {
    /// Integrates once from the start to `end`: half of what [`crate::solve`] does, for those who know the error from elsewhere.
    ///
    /// # Errors
    /// [`SolveError`] where the run cannot be started; how it ended is [`SingleRun::status`].
    pub fn integrate(&mut self, end: f64, options: &Options) -> Result<SingleRun, SolveError> {
        self.prepare(options.method)?;
        if !self.guess.is_empty() {
            self.compiled.set_guess(&self.guess);
        }
        let start = Start { t: self.t, y: self.start.clone() };
        let run = integrate_once(&mut self.compiled, start, end, options)?;
        let (status, work, projection) = (run.solution.status.clone(), run.solution.work, run.solution.projection);
        Ok(SingleRun { status, work, projection, trajectory: run.trajectory() })
    }

    /// Compiles what `method` needs beyond the rates, unless that is done: it is done by the first run anyway.
    ///
    /// # Errors
    /// [`SolveError::Compile`].
    pub fn prepare(&mut self, method: Method) -> Result<(), SolveError> {
        if method.is_implicit() && !self.compiled.has_jacobian() {
            self.compiled = self.compiled.clone().with_jacobian(&self.equations)?;
        }
        if method == Method::Taylor && !self.compiled.has_series() {
            self.compiled = self.compiled.clone().with_series(&self.equations, &self.form)?;
        }
        Ok(())
    }
}

/// [`ready()`] without a Jacobian, unless the method of `settings` asks for one: for runs by [`Ready::integrate`], which compiles what is missing.
///
/// # Errors
/// As [`ready()`].
pub fn ready_to_run(
    setting: Setting,
    equations: Equations,
    constants: &ConstantsRule,
    settings: &Settings,
) -> Result<Ready, SolveError> {
    let mut prepared = Prepared::new(setting, equations, settings)?;
    let constants = resolve(&mut prepared, constants, settings)?;
    let start = prepared.start(&constants);
    let Prepared { equations, compiled, form, guess, t, .. } = prepared;
    Ok(Ready { equations, compiled, form, constants, t, start, guess })
}

/// Compiles `equations`, Jacobian included, and computes what they start from. Nothing is integrated, unless the constants are natural at a
/// horizon; that is done as `settings` say.
///
/// # Errors
/// [`SolveError`] where there is no start.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", r#"
/// # title = "Ice sledge on an incline"
/// # [coordinates]
/// # x   = { start = 0 }
/// # y   = { start = 0 }
/// # phi = { start = 0.3 }
/// # [system]
/// # lagrangian  = "(x'^2 + y'^2 + phi'^2)/2 + x"
/// # constraints = ["y'*cos(phi) - x'*sin(phi)"]
/// # [start.velocities]
/// # "phi'" = 1
/// # "x'" = 0.5
/// # [run]
/// # duration = 1
/// # "#)?;
/// use deltaq::{Settings, choices, derive, ready, setting};
/// // the ice sledge turns at a constant rate, y = (x, y, phi, x', y', phi')
/// let chetaev = choices(&scene).remove(0);
/// let equations = derive(&scene.system, &chetaev)?;
/// let mut ready = ready(setting(&scene), equations, &chetaev.constants, &Settings::default())?;
/// let mut rates = [0.0; 6];
/// ready.compiled.rates(0.0, &ready.start, &mut rates)?;
/// assert_eq!((rates[2], rates[5]), (1.0, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn ready(
    setting: Setting,
    equations: Equations,
    constants: &ConstantsRule,
    settings: &Settings,
) -> Result<Ready, SolveError> {
    let mut ready = ready_to_run(setting, equations, constants, settings)?;
    if !ready.compiled.has_jacobian() {
        ready.compiled = ready.compiled.with_jacobian(&ready.equations)?;
    }
    Ok(ready)
}
