//! A motion as it is asked for: in two runs with an error estimate, or in one at a glance.

use deltaq::{
    Choice, Motion, Prepared, Settings, SingleRun, SolveError, derive_in_form, error_estimate, formulation, prepare,
    removals, setting, solve_choice,
};
use equations::{Equations, Outputs};
use integrate::{Options, Status};
use scene::Scene;

use crate::question::Question;

/// Steps of one run at most, and of one at a glance.
const MAX_STEPS: [usize; 2] = [200_000, 5_000];
/// Tolerance at a glance: less than can be seen.
const GLANCE: f64 = 1e-6;

/// How motions are integrated: as those that `deltaq compare` compares, unless a tolerance is asked for.
pub(crate) fn settings(question: &Question) -> Settings {
    let of = |tolerance: f64, max_steps: usize| Settings { tolerance, max_steps, ..Settings::default() };
    match question.tolerance {
        _ if question.glance => of(GLANCE, MAX_STEPS[1]),
        tolerance if tolerance > 0.0 => of(tolerance, MAX_STEPS[0]),
        _ => of(Settings::default().tolerance, MAX_STEPS[0]),
    }
}

/// What was integrated.
pub(crate) enum Run {
    /// Twice, from chart to chart.
    Motion(Box<Motion>),
    /// Once, in one chart, to the end.
    Glance(Box<Prepared>, Box<SingleRun>),
}

impl Run {
    /// Integrates `choice` from the start of the scene.
    pub(crate) fn of(scene: &Scene, choice: &Choice, glance: bool, settings: &Settings) -> Result<Run, SolveError> {
        if !glance {
            return Ok(Run::Motion(Box::new(solve_choice(scene, choice, settings)?)));
        }
        if choice.removal.is_none() && formulation(choice.formulation).is_some_and(|f| f.needs_removal) {
            removals(scene)?;
        }
        let setting = setting(scene);
        let (equations, _) = derive_in_form(setting.system, setting.start, choice, settings.form)?;
        let mut prepared = prepare(setting, equations, &choice.constants, settings)?;
        let Settings { tolerance, max_steps, .. } = *settings;
        let method = prepared.method.method;
        let options = Options { method, max_steps, ..Options::with_tolerance(tolerance) };
        let run = prepared.integrate(setting.end, &options)?;
        if run.solution.status != Status::Completed {
            // another chart may lead on, and why it ends is said in words
            return Run::of(scene, choice, false, settings);
        }
        Ok(Run::Glance(Box::new(prepared), Box::new(run)))
    }

    /// The last time at which it can be read off.
    pub(crate) fn end(&self) -> f64 {
        match self {
            Run::Motion(motion) => motion.end(),
            Run::Glance(_, run) => run.end(),
        }
    }

    /// What is read off at `t`.
    pub(crate) fn at(&mut self, t: f64) -> Result<Outputs, SolveError> {
        match self {
            Run::Motion(motion) => motion.at(t),
            Run::Glance(prepared, run) => run.at(&mut prepared.compiled, t),
        }
    }

    /// The equations, and the values of their free constants.
    pub(crate) fn equations(&self) -> (&Equations, &[f64]) {
        match self {
            Run::Motion(motion) => (&motion.equations, &motion.constants),
            Run::Glance(prepared, _) => (&prepared.equations, &prepared.constants),
        }
    }

    /// `completed`, `untrusted` or `stopped`, why it is not completed, and an estimate of the error, which
    /// one run does not have.
    pub(crate) fn status(&mut self, scene: &Scene) -> Result<(&'static str, Option<String>, Option<f64>), SolveError> {
        match self {
            Run::Motion(motion) => {
                let estimate = error_estimate(motion, setting(scene))?;
                let (status, cause) = estimate.status(motion);
                Ok((status, cause, Some(estimate.absolute)))
            }
            Run::Glance(..) => Ok(("completed", None, None)),
        }
    }
}
