//! One motion: equations and start data in, a trajectory with its error estimate out.

use std::time::Instant;

use equations::{Compiled, Equations, Outputs};
use integrate::{DenseOutput, Interrupt, Method, Projection, ProjectionReport, Solution, Status, StopCause, Work};
use mechanics::{ConstantsRule, State, System};

use crate::SolveError;
use crate::doubt::Doubt;
use crate::gap::subtract;
use crate::horizon::natural_constants;
use crate::run::{Origin, Prepared, Trajectory};

/// The tolerance of the second run over that of the first.
pub const TIGHTER: f64 = 1e-2;

/// How a motion is integrated.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Tolerance of the first run; the second, whose trajectory is kept, has [`TIGHTER`] times this.
    pub tolerance: f64,
    /// Method.
    pub method: Method,
    /// Projection onto the constraint after every step.
    pub projection: Projection,
    /// Limit on the steps of one run.
    pub max_steps: usize,
    /// All unknowns of an instant by LU factorization, as derived; otherwise in the form that [`equations::Plan::choose`] finds cheapest. The motion is the same to
    /// round-off.
    pub plain: bool,
    /// The flag by which another thread ends all runs: what is under way then stops early, or is refused.
    pub interrupt: Option<Interrupt>,
}

impl Default for Settings {
    fn default() -> Self {
        let (method, projection) = (Method::Dop853, Projection::EveryStep);
        Settings { tolerance: 1e-11, method, projection, max_steps: 1_000_000, plain: false, interrupt: None }
    }
}

/// How a motion ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At the time asked for.
    Completed,
    /// Earlier, with the time and the cause in words.
    Stopped {
        /// Time reached.
        t: f64,
        /// Cause.
        cause: String,
    },
}

/// Wall-clock seconds spent.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seconds {
    /// From system to equations.
    pub derive: f64,
    /// From equations to tapes, start values included.
    pub compile: f64,
    /// Free constants and time integration, both runs.
    pub integrate: f64,
}

/// In which form the equations of a motion were evaluated, and how well that went.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FormReport {
    /// What was chosen and why ([`equations::Plan::why`]).
    pub why: Vec<String>,
    /// Evaluations of the kept run in which a pivot of the form was small, so that the plain form was evaluated instead.
    pub fallbacks: usize,
}

/// A trajectory with everything that was learned on the way.
#[derive(Clone)]
pub struct Motion {
    /// The equations behind it.
    pub equations: Equations,
    /// Values of the free constants.
    pub constants: Vec<f64>,
    /// How it ended.
    pub ending: Ending,
    /// Where the tolerance did not decide how long the steps are: the difference of the two runs is no error estimate then.
    pub doubt: Option<Doubt>,
    /// Work of the kept run.
    pub work: Work,
    /// What projection did in the kept run.
    pub projection: ProjectionReport,
    /// Time spent.
    pub seconds: Seconds,
    /// In which form the equations were evaluated.
    pub form: FormReport,
    end: f64,
    compiled: Compiled,
    kept: Trajectory,
    looser: Trajectory,
    state: Vec<f64>,
    other: Vec<f64>,
}

impl Motion {
    /// Time of the start.
    pub fn start(&self) -> f64 {
        self.kept.ends()[0]
    }

    /// Last time that both runs reached and at which both can be read off: where a motion stops at a singularity, a little before it.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Whether the motion reached the time asked for.
    pub fn is_complete(&self) -> bool {
        self.ending == Ending::Completed
    }

    /// Whether at `t` the difference of the two runs is no error estimate.
    pub fn is_doubted(&self, t: f64) -> bool {
        self.doubt.as_ref().is_some_and(|doubt| (t - doubt.from) * (self.kept.ends()[1] - self.start()) >= 0.0)
    }

    /// End points of the steps of the kept run.
    pub fn step_times(&self) -> Vec<f64> {
        self.kept.step_times()
    }

    /// Coordinates, velocities, multipliers and invariants at `t`.
    ///
    /// # Errors
    /// [`SolveError::Reading`] where the equations of the instant cannot be solved.
    pub fn at(&mut self, t: f64) -> Result<Outputs, SolveError> {
        self.kept.outputs(&mut self.compiled, t, &mut self.state)
    }

    /// The states `y` at `t` from the kept run, in the order of the states of [`Motion::equations`].
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn states_at(&mut self, t: f64) -> Result<Vec<f64>, SolveError> {
        self.kept.state(&mut self.compiled, t, &mut self.state)?;
        Ok(self.state.clone())
    }

    /// Difference of the coordinates of the two runs at `t`: what the looser run was wrong by, and a bound in practice for the kept one.
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn difference_of_runs(&mut self, t: f64) -> Result<Vec<f64>, SolveError> {
        Ok(self.at_with_difference(t)?.1)
    }

    /// [`Motion::at`] and [`Motion::difference_of_runs`] in one.
    pub(crate) fn at_with_difference(&mut self, t: f64) -> Result<(Outputs, Vec<f64>), SolveError> {
        let (kept, looser) = self.at_in_both_runs(t)?;
        let difference = subtract(&kept.coordinates, &looser.coordinates);
        Ok((kept, difference))
    }

    /// [`Motion::at`] from the kept run and from the looser one: any quantity computed from both has its own error estimate.
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn at_in_both_runs(&mut self, t: f64) -> Result<(Outputs, Outputs), SolveError> {
        let kept = self.at(t)?;
        Ok((kept, self.looser.outputs(&mut self.compiled, t, &mut self.other)?))
    }

    /// Name, value at the start and largest deviation from it at `times`, of each invariant.
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn invariant_drift(&mut self, times: &[f64]) -> Result<Vec<(String, f64, f64)>, SolveError> {
        let start = self.at(self.start())?.invariants;
        let mut drift = vec![0.0_f64; start.len()];
        for &t in times {
            for (d, (now, then)) in drift.iter_mut().zip(self.at(t)?.invariants.iter().zip(&start)) {
                *d = d.max((now - then).abs());
            }
        }
        let names = self.equations.invariants.iter().map(|i| i.name.clone());
        Ok(names.zip(start).zip(drift).map(|((name, start), drift)| (name, start, drift)).collect())
    }

    /// `samples + 1` equidistant times from start to end.
    pub fn grid(&self, samples: usize) -> Vec<f64> {
        let (a, b) = (self.start(), self.end());
        (0..=samples).map(|i| a + (b - a) * i as f64 / samples as f64).collect()
    }
}

/// What a motion starts from: a system and a state on its constraint.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    /// The system.
    pub system: &'a System,
    /// `(t₀, q₀, v₀)`.
    pub start: &'a State,
    /// Time at which the motion is to end.
    pub end: f64,
}

/// Integrates `equations` from `setting.start` to `setting.end`, twice, and keeps the tighter run.
///
/// # Errors
/// [`SolveError`] where the motion could not be started; how it ended otherwise is [`Motion::ending`].
pub fn solve(
    setting: Setting,
    equations: Equations,
    constants: &ConstantsRule,
    settings: &Settings,
) -> Result<Motion, SolveError> {
    let clock = Instant::now();
    let mut prepared = Prepared::new(setting, equations, settings)?;
    let compile = clock.elapsed().as_secs_f64();
    let clock = Instant::now();
    let constants = resolve(&mut prepared, constants, settings)?;
    let kept = prepared.run(&constants, setting.end, settings.tolerance * TIGHTER, Origin::Start, settings)?;
    let looser = prepared.second_run(&constants, setting.end, &kept, settings)?;
    let integrate = clock.elapsed().as_secs_f64();
    let mut end = |run: &Solution| ending(&prepared.equations, &mut prepared.compiled, run);
    let ending = joint_ending(end(&kept.solution), end(&looser.solution), [setting.start.t, setting.end]);
    let (work, projection, fallbacks) = (kept.solution.work, kept.solution.projection, kept.fallbacks);
    let runs = [kept.trajectory(), looser.trajectory()];
    let seconds = Seconds { derive: 0.0, compile, integrate };
    let mut motion = Motion { work, projection, ..Motion::of(prepared, constants, ending, runs, seconds) };
    motion.form.fallbacks = fallbacks;
    let steps = [motion.kept.step_times(), motion.looser.step_times()];
    motion.doubt = Doubt::of(&steps, motion.end, motion.is_complete(), settings.method);
    Ok(motion)
}

impl Motion {
    /// Of the `kept` and the looser run, which are told apart by nothing but their order; no work and no projections.
    pub(crate) fn of(
        mut prepared: Prepared,
        constants: Vec<f64>,
        ending: Ending,
        [mut kept, mut looser]: [Trajectory; 2],
        seconds: Seconds,
    ) -> Self {
        let size = prepared.equations.states.len();
        Motion {
            end: readable_end(&mut prepared.compiled, &mut kept, &mut looser, size),
            ending,
            constants,
            work: Work::default(),
            projection: ProjectionReport::default(),
            seconds,
            form: FormReport { why: prepared.form.why, fallbacks: 0 },
            doubt: None,
            kept,
            looser,
            state: vec![0.0; size],
            other: vec![0.0; size],
            equations: prepared.equations,
            compiled: prepared.compiled,
        }
    }
}

/// Where only the tighter run goes on, there is no error estimate, and so no motion.
pub(crate) fn unconfirmed(cause: &str) -> String {
    format!("the run that estimates the error stops here: {cause}")
}

/// How the kept run ended, unless the looser one stopped while that went on, in a run over this time.
pub(crate) fn joint_ending(kept: Ending, looser: Ending, [start, end]: [f64; 2]) -> Ending {
    // both stop near the same singularity, or for different causes
    const NEAR: f64 = 1e-3;
    let much_before = |t: f64, later: f64| (later - t) * (end - start).signum() > NEAR * (later - start).abs();
    match (kept, looser) {
        (Ending::Completed, Ending::Stopped { t, cause }) => Ending::Stopped { t, cause: unconfirmed(&cause) },
        (Ending::Stopped { t: later, .. }, Ending::Stopped { t, cause }) if much_before(t, later) => {
            Ending::Stopped { t, cause: unconfirmed(&cause) }
        }
        (ending, _) => ending,
    }
}

/// How far before a singularity a motion is read off, as fractions of its length.
const BEFORE_A_STOP: [f64; 5] = [0.0, 1e-12, 1e-9, 1e-6, 1e-3];

fn readable_end(compiled: &mut Compiled, kept: &mut Trajectory, looser: &mut Trajectory, size: usize) -> f64 {
    let ([start, end], [_, other]) = (kept.ends(), looser.ends());
    let length = (end - start).abs().min((other - start).abs());
    let direction = (end - start).signum();
    let mut y = vec![0.0; size];
    let mut readable =
        |t: f64| [&mut *kept, &mut *looser].into_iter().all(|run| run.outputs(compiled, t, &mut y).is_ok());
    let ends = BEFORE_A_STOP.map(|fraction| start + direction * length * (1.0 - fraction));
    ends.into_iter().find(|&t| readable(t)).unwrap_or(start)
}

pub(crate) fn resolve(
    prepared: &mut Prepared,
    rule: &ConstantsRule,
    settings: &Settings,
) -> Result<Vec<f64>, SolveError> {
    let expected = prepared.equations.free_constants.len();
    match rule {
        ConstantsRule::Zero => Ok(vec![0.0; expected]),
        ConstantsRule::Given(values) => given_constants(&prepared.equations, values),
        ConstantsRule::Natural { horizon } => natural_constants(prepared, *horizon, settings),
    }
}

/// Values given one a free constant, or one a memory variable (then those without a costate have to be zero).
fn given_constants(equations: &Equations, values: &[f64]) -> Result<Vec<f64>, SolveError> {
    let constants = &equations.free_constants;
    if let Some(&value) = values.iter().find(|x| !x.is_finite()) {
        return Err(SolveError::ConstantNotFinite { formulation: equations.formulation.into(), value });
    }
    if values.len() == constants.len() {
        return Ok(values.to_vec());
    }
    let memory = equations.removal.as_ref().map(|r| r.memory.len());
    let used: Vec<Option<usize>> = constants.iter().map(|c| c.memory).collect();
    let unused_are_zero = values.iter().enumerate().all(|(i, &x)| x == 0.0 || used.contains(&Some(i)));
    if Some(values.len()) == memory && unused_are_zero {
        return Ok(used.into_iter().map(|i| i.map_or(0.0, |i| values[i])).collect());
    }
    Err(SolveError::ConstantCount {
        formulation: equations.formulation.into(),
        expected: constants.len(),
        names: constant_names(equations).join(", "),
        found: values.len(),
    })
}

/// Names of the free constants.
pub fn constant_names(equations: &Equations) -> Vec<String> {
    equations.free_constants.iter().map(|c| equations.graph.name(c.symbol)).collect()
}

pub(crate) fn ending(equations: &Equations, compiled: &mut Compiled, run: &Solution) -> Ending {
    let Status::Stopped { t, cause } = &run.status else { return Ending::Completed };
    let cause = match cause {
        StopCause::Event { index } => {
            let guard = equations.graph.plain(equations.guards[*index]);
            return Ending::Stopped { t: *t, cause: format!("{guard} vanishes, by which the equations divide") };
        }
        StopCause::NotFinite { component } => {
            let symbol = equations.states.get(*component).map(|y| equations.graph.name(y.symbol));
            format!("{} is no longer finite", symbol.unwrap_or_default())
        }
        StopCause::StepTooSmall { step, .. } => {
            format!("the error asks for steps of {step:.1e}, which no longer move time: a singularity is near")
        }
        other => other.to_string(),
    };
    let near = nearly_zero_guard(equations, compiled, &run.dense).map_or(String::new(), |words| format!("; {words}"));
    Ending::Stopped { t: *t, cause: cause + &near }
}

/// A guard is nearly zero when it is under this fraction of its value at the start.
const NEARLY_ZERO: f64 = 1e-2;

/// The guard that has shrunk most over the run, if it is nearly zero at its end.
fn nearly_zero_guard(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> Option<String> {
    let count = compiled.guards();
    let (mut start, mut end) = (vec![0.0; count], vec![0.0; count]);
    compiled.guard_values(dense.start(), dense.start_state(), &mut start);
    compiled.guard_values(dense.end(), dense.end_state(), &mut end);
    let ratios = start.iter().zip(&end).map(|(a, b)| (b / a).abs());
    let (index, ratio) = ratios.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let guard = equations.graph.plain(equations.guards[index]);
    (ratio < NEARLY_ZERO).then(|| format!("{guard}, by which the equations divide, is down to {:.1e}", end[index]))
}
