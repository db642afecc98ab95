//! One motion by a discrete principle, in equal steps.

use discrete::{Composition, Discrete, RemovedStart};
use integrate::{Method, ProjectionReport, StopCause, Work};
use scene::Scene;

use crate::charts::Runs;
use crate::clock::Clock;
use crate::constants::resolve;
use crate::discrete_run::{DiscreteRun, PassedOver};
use crate::lost_rank::{column_factors, watch_rank};
use crate::trajectory::Trajectory;
use crate::{
    CHETAEV, Choice, Ending, Metric, Motion, Prepared, REMOVED_CONSTRAINT, Seconds, Settings, SolveError, VAKONOMIC,
    VAKONOMIC_COSTATE, derive, setting,
};

/// Largest number of steps of a motion that is kept.
pub const STEP_LIMIT: usize = 10_000_000;

/// How time is stepped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stepping {
    /// Equal steps that keep the structure of the motion: by a discrete variational principle.
    Leapfrog,
    /// As many as the tolerance asks for, with projection; `None`: by the method that suits the motion.
    Adaptive(Option<Method>),
}

impl Stepping {
    /// Every way that there is with these methods.
    pub fn all(methods: &[Method]) -> impl Iterator<Item = Stepping> {
        let methods = methods.iter().copied().map(Some);
        [None].into_iter().chain(methods).map(Stepping::Adaptive).chain([Stepping::Leapfrog])
    }

    /// Its name, as on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Stepping::Leapfrog => "leapfrog",
            Stepping::Adaptive(method) => method.map_or("auto", Method::name),
        }
    }
}

/// Equal steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// Longest step > 0, not above the time to go, in the scene's unit of time; that is cut into as few equal
    /// steps as this allows, at least two.
    pub step: f64,
    /// Order 2, 4, 6 or 8.
    pub composition: Composition,
}

/// The discrete motion of a choice from the scene's start with these free constants, as in its equations.
///
/// # Errors
/// [`SolveError::NoPrinciple`], [`SolveError::Discrete`].
pub fn discrete_of(scene: &Scene, choice: &Choice, constants: &[f64]) -> Result<Discrete, SolveError> {
    let (system, start) = (&scene.system, &scene.start);
    let end = start.t + scene.duration;
    let own = choice.formulation;
    match &choice.removal {
        None if own == CHETAEV => Ok(Discrete::chetaev(system, start, end)?),
        None if [VAKONOMIC, VAKONOMIC_COSTATE].contains(&own) => {
            Ok(Discrete::vakonomic(system, start, constants, end)?)
        }
        Some(removal) if own == REMOVED_CONSTRAINT => {
            let equations = derive(system, choice)?;
            let mut costates = vec![0.0; removal.memory.len()];
            for (constant, &value) in equations.free_constants.iter().zip(constants) {
                if let Some(i) = constant.memory {
                    costates[i] = value;
                }
            }
            let at = RemovedStart::at(system, removal, start, &costates)?;
            Ok(Discrete::removed(system, removal, &at, end)?)
        }
        _ => Err(SolveError::NoPrinciple { formulation: own.name.into() }),
    }
}

/// Steps a choice from the scene's start to its end, twice: as `steps` say, which is kept, and twice as long,
/// within the limits of `settings`.
/// Their difference estimates the error of the longer ones. Outputs at a time, multipliers too, are those of
/// the derived equations at the discrete motion's positions, velocities (and multipliers or costates).
///
/// It stops before a step of either run within which a gauge ([`Compiled::gauges`](equations::Compiled))
/// grows too much.
///
/// Free constants that are natural at a horizon are found by the time loop, as they say.
///
/// # Errors
/// [`SolveError::Step`], [`SolveError::Breakpoint`]; those of [`discrete_of`] and of [`crate::solve`].
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// use motion::{Settings, Steps, choices, solve_by_steps};
/// use discrete::Composition;
/// let chetaev = choices(&scene).remove(0);
/// let steps = Steps { step: 0.01, composition: Composition::Fourth };
/// let mut motion = solve_by_steps(&scene, &chetaev, steps, &Settings::default())?;
/// assert_eq!(motion.step_times().len(), 101);
/// assert!((motion.at(1.0)?.coordinates[2] - 1.3).abs() < 1e-12);
/// assert!(motion.difference_of_runs(1.0)?.iter().all(|e| e.abs() < 1e-8));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve_by_steps(scene: &Scene, choice: &Choice, steps: Steps, settings: &Settings) -> Result<Motion, SolveError> {
    let (length, direction, round_off) = (scene.duration.abs(), scene.duration.signum(), 1e-9);
    // a step that divides the time up to round-off divides it; the other run has longer ones
    let count = (length / steps.step - round_off).ceil().max(2.0);
    let possible = steps.step > 0.0 && steps.step <= length * (1.0 + round_off);
    if !(possible && count <= STEP_LIMIT as f64) {
        return Err(SolveError::Step { step: steps.step, length: scene.duration, limit: STEP_LIMIT });
    }
    let count = count as usize;
    for &t in &scene.system.breakpoints {
        let steps = (t - scene.start.t) / scene.duration * count as f64;
        if (0.0..=count as f64).contains(&steps) && (steps - steps.round()).abs() > round_off * count as f64 {
            return Err(SolveError::Breakpoint { t, step: scene.duration / count as f64 });
        }
    }
    let clock = Clock::start();
    let mut equations = derive(&scene.system, choice)?;
    watch_rank(&mut equations, &scene.system);
    let derive = clock.seconds();
    let clock = Clock::start();
    let mut prepared = Prepared::new(setting(scene), equations, settings)?;
    let compile = clock.seconds();
    let clock = Clock::start();
    resolve(&mut prepared, &choice.constants, settings, Some(setting(scene)), None)?;
    let discrete = discrete_of(scene, choice, &prepared.constants)?.composed(steps.composition);
    let run = |count: usize| {
        let options = settings.options(settings.tolerance);
        discrete.trajectory_until(count, |t, taken| {
            let too_many = taken >= options.max_steps;
            let cause = too_many.then_some(StopCause::TooManySteps { limit: options.max_steps });
            cause.or_else(|| options.interrupt.as_ref()?.pass(t, taken)).map(|cause| cause.to_string())
        })
    };
    let (kept, looser) = (run(count)?, run(count.div_ceil(2))?);
    let integrate = clock.seconds();
    // a motion ends where the first of its runs ends, for that run's reason
    let before = (kept.end() - looser.end()) * direction > 0.0;
    let ending = match (&kept.stop, &looser.stop) {
        (_, Some(error)) if before => Ending::unconfirmed(looser.end(), &error.to_string()),
        (Some(error), _) | (None, Some(error)) => Ending::Stopped { t: kept.end(), cause: error.to_string() },
        (None, None) => Ending::Completed,
    };
    let work = Work { steps: kept.times().len() - 1, ..Work::default() };
    let mut runs = [kept, looser].map(|run| {
        let values = prepared.values.clone();
        DiscreteRun::new(run, values, &prepared.equations, &scene.system)
    });
    let step = scene.duration / count as f64;
    let (t, start) = (prepared.t, prepared.start.clone());
    let columns = column_factors(&mut prepared.compiled, &mut Metric::new(&scene.system)?, t, &start);
    let passed_over = runs.iter_mut().filter_map(|run| run.passed_over(&mut prepared, step, &columns));
    let passed_over = passed_over.min_by(|a, b| (direction * a.t).total_cmp(&(direction * b.t)));
    let runs = runs.map(|run| Trajectory::Discrete(Box::new(run)));
    let seconds = Seconds { derive, compile, integrate };
    let projection = ProjectionReport::default();
    let runs = Runs { trajectories: runs, changes: Vec::new(), ending, work, projection, fallbacks: 0 };
    let mut motion = Motion::of(prepared, runs, None, seconds);
    if let Some(PassedOver { t, cause }) = passed_over.filter(|found| direction * (found.t - motion.end()) < 0.0) {
        motion.stop_at(t, cause);
    }
    Ok(motion)
}
