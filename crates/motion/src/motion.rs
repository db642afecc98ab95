//! One motion: equations and start data in, a trajectory with its error estimate out.

use std::sync::Arc;

use equations::{Compiled, Equations, Outputs};
use integrate::stall_detector::STRETCH;
use integrate::{Method, ProjectionReport, Work};
use mechanics::ConstantsRule;
use scene::Scene;

use crate::band::{Answer, Breach, ask_alone};
use crate::charts::{self, ChartChange, Course, Runs};
use crate::choice::removals;
use crate::clock::Clock;
use crate::constants::resolve;
use crate::form::derive_in_form;
use crate::method::Chosen;
use crate::metric::{larger, subtract};
use crate::stiffness_probe::{FARTHER, NotSuited};
use crate::trajectory::Trajectory;
use crate::wanted::kept_before;
use crate::{Choice, ChosenForm, Doubt, Ending, Prepared, Setting, Settings, SolveError, setting};

/// Wall-clock seconds spent.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, schemars::JsonSchema)]
pub struct Seconds {
    /// From system to equations.
    pub derive: f64,
    /// From equations to tapes, start values included.
    pub compile: f64,
    /// Free constants and time integration, both runs.
    pub integrate: f64,
}

/// The form in which the equations of a motion were evaluated, and how often another one replaced it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FormReport {
    /// The form of the formulation.
    pub chosen: ChosenForm,
    /// How its acceleration-level equations are solved, and why ([`equations::Plan::why`]).
    pub why: Vec<String>,
    /// Evaluations of the kept run in the plain form, because a pivot of the chosen form was small.
    pub fallbacks: usize,
}

/// A trajectory with its equations, error estimate, work and checks.
#[derive(Clone)]
pub struct Motion {
    /// The equations behind it.
    pub equations: Equations,
    /// Values of the free constants.
    pub constants: Vec<f64>,
    /// How it ended.
    pub ending: Ending,
    /// Where the tolerance did not decide the steps: the runs' difference is not an error estimate then.
    pub doubt: Option<Doubt>,
    /// What the user expects to be constant and this motion changes.
    pub breaches: Vec<Breach>,
    /// Of what the user expects to be constant: by how much it might change unseen.
    pub unseen: Vec<(String, f64)>,
    /// The method, and why; of a motion in equal steps none.
    pub method: Option<Chosen>,
    /// Work of the kept run.
    pub work: Work,
    /// What projection did in the kept run.
    pub projection: ProjectionReport,
    /// Time spent.
    pub seconds: Seconds,
    /// The form in which the equations were evaluated.
    pub form: FormReport,
    /// Where pivots became small and others took over. Outputs stay those of the first chart.
    pub charts: Vec<ChartChange>,
    end: f64,
    pub(crate) compiled: Compiled,
    pub(crate) kept: Trajectory,
    pub(crate) looser: Trajectory,
    /// The times at which both runs are known, where they are not at all times; besides `end`.
    pub(crate) wanted: Option<Arc<[f64]>>,
}

impl Motion {
    /// Time of the start.
    pub fn start(&self) -> f64 {
        self.kept.ends()[0]
    }

    /// Last time at which both runs can be read off: a little before the singularity where a motion stops.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Whether the motion reached the time asked for.
    pub fn is_complete(&self) -> bool {
        self.ending == Ending::Completed
    }

    /// Whether at `t` the difference of the two runs is not an error estimate.
    pub fn is_doubted(&self, t: f64) -> bool {
        self.doubt.as_ref().is_some_and(|doubt| (t - doubt.from) * (self.kept.ends()[1] - self.start()) >= 0.0)
    }

    /// End points of the steps of the kept run.
    pub fn step_times(&self) -> Vec<f64> {
        self.kept.step_times().into_owned()
    }

    /// Coordinates, velocities, multipliers and invariants at `t`.
    ///
    /// # Errors
    /// [`SolveError::Reading`] where the equations of the instant cannot be solved; [`SolveError::Dense`] of
    /// a long motion at other times than those of [`Settings::times`].
    pub fn at(&mut self, t: f64) -> Result<Outputs, SolveError> {
        self.kept.outputs(&mut self.compiled, t)
    }

    /// The states `y` at `t` from the kept run, in the order of the states of [`Motion::equations`].
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn states_at(&mut self, t: f64) -> Result<Vec<f64>, SolveError> {
        self.kept.state(&mut self.compiled, t)
    }

    /// Difference of the runs' coordinates at `t`: the looser's error, in practice a bound of the kept one's.
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn difference_of_runs(&mut self, t: f64) -> Result<Vec<f64>, SolveError> {
        let (kept, looser) = self.at_in_both_runs(t)?;
        Ok(subtract(&kept.coordinates, &looser.coordinates))
    }

    /// [`Motion::at`] from the kept and the looser run: what both give has its own error estimate.
    ///
    /// # Errors
    /// As [`Motion::at`].
    pub fn at_in_both_runs(&mut self, t: f64) -> Result<(Outputs, Outputs), SolveError> {
        let kept = self.at(t)?;
        Ok((kept, self.looser.outputs(&mut self.compiled, t)?))
    }

    /// Whether it keeps what another motion changes: it comes as far, does not change it, and would show as
    /// much.
    pub fn keeps(&self, changed: &Breach) -> bool {
        let of_it = |name: &str| name == changed.name;
        let shows = |by: f64| ask_alone(changed.largest, Some(by)) == Answer::Apart;
        let way = |t: f64| (t - self.start()).abs();
        way(self.end()) >= way(changed.t)
            && self.breaches.iter().all(|breach| !of_it(&breach.name))
            && self.unseen.iter().any(|(name, by)| of_it(name) && shows(*by))
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
                *d = larger(*d, (now - then).abs());
            }
        }
        let names = self.equations.invariants.iter().map(|i| i.name.clone());
        Ok(names.zip(start).zip(drift).map(|((name, start), drift)| (name, start, drift)).collect())
    }
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
    let clock = Clock::start();
    let mut prepared = Prepared::new(setting, equations, settings)?;
    let compile = clock.seconds();
    let clock = Clock::start();
    resolve(&mut prepared, constants, settings, Some(setting), None)?;
    let (runs, chosen) = run(setting, &mut prepared, settings)?;
    let mut motion = Motion::of(prepared, runs, Some(chosen), Seconds { compile, ..Seconds::default() });
    motion.judge(setting, settings)?;
    motion.seconds.integrate = clock.seconds();
    Ok(motion)
}

/// More steps ahead than this, and other methods are tried.
const PATIENCE: f64 = 20_000.0;
/// Both runs of `prepared`, made with the same settings, by the method asked for, or a suitable one:
///
/// - by the one that suits the equations;
/// - where their solution is not smooth, by [`Method::Dop853`];
/// - where more than 20 000 steps are ahead, 500 are tried by [`Method::Radau5`] from there on; if it comes
///   ten times farther by them, the equations are stiff, and both runs are by it.
fn run(setting: Setting, prepared: &mut Prepared, settings: &Settings) -> Result<(Runs, Chosen), SolveError> {
    let Chosen { mut method, mut why } = prepared.method.clone();
    let asked = settings.method.is_some();
    let mut patience = if asked { f64::INFINITY } else { PATIENCE.min(settings.max_steps as f64) };
    loop {
        let settings = Settings { method: Some(method), ..settings.clone() };
        match charts::run(setting, prepared, &settings, patience)? {
            Course::Run(runs) => return Ok((*runs, Chosen { method, why })),
            Course::Unsuited(NotSuited::NotSmooth) => {
                (method, why) = (Method::Dop853, "the motion leaves its Taylor series: it is not smooth".into());
            }
            Course::Unsuited(NotSuited::Slow { stiff }) => {
                patience = f64::INFINITY;
                if stiff {
                    method = Method::Radau5;
                    why = format!("the equations are stiff: by {STRETCH} steps it comes {FARTHER} times farther");
                }
            }
        }
    }
}

/// Derives and integrates a choice from the start of the scene, in the form that [`Settings::form`] says.
///
/// # Errors
/// [`SolveError`] where there is no motion.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// use motion::{CHETAEV, Settings, choices, solve_choice};
/// // the ice sledge turns at a constant rate: phi = 0.3 + t
/// let chetaev = choices(&scene).into_iter().find(|c| c.formulation == CHETAEV).unwrap();
/// let mut motion = solve_choice(&scene, &chetaev, &Settings::default())?;
/// assert!(motion.is_complete());
/// assert!((motion.at(1.0)?.coordinates[2] - 1.3).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_choice(scene: &Scene, choice: &Choice, settings: &Settings) -> Result<Motion, SolveError> {
    if choice.removal.is_none() && choice.formulation.needs_removal() {
        removals(scene)?;
    }
    solve_from(setting(scene), choice, settings)
}

/// [`solve_choice`] of any system, from any start; a removal has to be in the choice.
///
/// # Errors
/// As [`solve_choice`].
pub fn solve_from(setting: Setting, choice: &Choice, settings: &Settings) -> Result<Motion, SolveError> {
    let clock = Clock::start();
    let (equations, chosen) = derive_in_form(setting.system, setting.start, choice, settings.form)?;
    let derive = clock.seconds();
    let mut motion = solve(setting, equations, &choice.constants, settings)?;
    (motion.seconds.derive, motion.form.chosen) = (derive, chosen);
    Ok(motion)
}

impl Motion {
    /// Truncates the motion: outputs cannot be evaluated after `t`.
    pub fn end_at(&mut self, t: f64, error: &SolveError) {
        self.stop_at(t, format!("it cannot be read off behind: {error}"));
    }

    /// It ends where both runs can be read off, at most where it did.
    pub(crate) fn read_to_the_end(&mut self) {
        let Motion { compiled, kept, looser, wanted, .. } = self;
        let end = readable_end(compiled, kept, looser, wanted.as_deref());
        if (self.end - end) * (self.end - self.start()) > 0.0 {
            self.end = end;
        }
    }

    /// It ends here, for this cause.
    pub(crate) fn stop_at(&mut self, t: f64, cause: String) {
        (self.end, self.ending) = (t, Ending::Stopped { t, cause });
    }

    /// From the kept and the looser run, in this order.
    pub(crate) fn of(mut prepared: Prepared, runs: Runs, method: Option<Chosen>, seconds: Seconds) -> Self {
        let Runs { trajectories: [mut kept, mut looser], changes, ending, work, projection, fallbacks } = runs;
        let wanted = kept.thinned_to().or(looser.thinned_to()).cloned();
        Motion {
            end: readable_end(&mut prepared.compiled, &mut kept, &mut looser, wanted.as_deref()),
            wanted,
            ending,
            constants: prepared.constants,
            method,
            work,
            projection,
            seconds,
            form: FormReport {
                chosen: ChosenForm { name: prepared.equations.formulation, why: "asked for".into() },
                why: prepared.form.why,
                fallbacks,
            },
            charts: changes,
            doubt: None,
            breaches: Vec::new(),
            unseen: Vec::new(),
            kept,
            looser,
            equations: prepared.equations,
            compiled: prepared.compiled,
        }
    }
}

/// Distances before a singularity at which outputs are tried, as fractions of the motion's length.
const BEFORE_A_STOP: [f64; 5] = [0.0, 1e-12, 1e-9, 1e-6, 1e-3];

fn readable_end(
    compiled: &mut Compiled,
    kept: &mut Trajectory,
    looser: &mut Trajectory,
    wanted: Option<&[f64]>,
) -> f64 {
    let ([start, end], [_, other]) = (kept.ends(), looser.ends());
    let length = (end - start).abs().min((other - start).abs());
    let direction = (end - start).signum();
    let mut readable = |t: f64| [&mut *kept, &mut *looser].into_iter().all(|run| run.outputs(compiled, t).is_ok());
    let ends = BEFORE_A_STOP.map(|fraction| {
        let t = start + direction * length * (1.0 - fraction);
        wanted.filter(|_| fraction > 0.0).map_or(t, |wanted| kept_before(wanted, direction > 0.0, t))
    });
    ends.into_iter().find(|&t| readable(t)).unwrap_or(start)
}

impl std::fmt::Debug for Motion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Motion")
            .field("formulation", &self.equations.formulation)
            .field("ending", &self.ending)
            .field("end", &self.end)
            .finish_non_exhaustive()
    }
}
