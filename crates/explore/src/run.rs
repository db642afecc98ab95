//! A motion as it is asked for: in two runs with an error estimate, or in one at a glance.

use equations::{Equations, Outputs};
use integrate::{Options, Status};
use motion::{Choice, Motion, Settings, SingleRun, SolveError, Varying, error_estimate, setting, solve_choice};
use scene::Scene;
use symbolic::limits::SAME;

use crate::cache::Cache;
use crate::question::Question;

/// Steps of one run at most, and of one at a glance.
const MAX_STEPS: [usize; 2] = [200_000, 5_000];

/// How motions are integrated: as those that `deltaq compare` compares.
pub(crate) fn settings(question: &Question) -> Settings {
    let [max_steps, at_a_glance] = MAX_STEPS;
    match question.glance {
        true => Settings { tolerance: SAME, max_steps: at_a_glance, ..Settings::default() },
        false => Settings { max_steps, ..Settings::default() },
    }
}

/// The result of an integration.
pub(crate) enum Run {
    /// Twice, from chart to chart.
    Motion(Box<Motion>),
    /// Once, in one chart, to the end.
    Glance(Box<Varying>, Box<SingleRun>),
}

impl Run {
    /// Integrates `choice` from the start of the scene.
    pub(crate) fn of(scene: &Scene, choice: &Choice, settings: &Settings) -> Result<Run, SolveError> {
        Ok(Run::Motion(Box::new(solve_choice(scene, choice, settings)?)))
    }

    /// Integrates a preview; falls back to a full run, which can change charts and explains failures.
    pub(crate) fn at_a_glance(
        scene: &Scene,
        choice: &Choice,
        settings: &Settings,
        kept: &mut Cache,
    ) -> Result<Run, SolveError> {
        let once = |mut varying: Varying, parameters: &[f64]| {
            varying.set(&scene.start, parameters, &choice.constants, true)?;
            let prepared = varying.prepared_mut();
            let (method, max_steps) = (prepared.method.method, settings.max_steps);
            let options = Options { method, max_steps, ..Options::with_tolerance(settings.tolerance) };
            let run = prepared.integrate(setting(scene).end, &options)?;
            Ok((varying, run))
        };
        let parameters = kept.values(scene);
        match kept.take(scene, choice, settings).and_then(|varying| once(varying, &parameters)) {
            Ok((varying, run)) if run.solution.status == Status::Completed => {
                Ok(Run::Glance(Box::new(varying), Box::new(run)))
            }
            Ok((varying, _)) => {
                kept.keep(choice, varying);
                Run::of(scene, choice, settings)
            }
            Err(_) => Run::of(scene, choice, settings),
        }
    }

    /// What it was made of stays for the next one of `choice`.
    pub(crate) fn leave(self, choice: &Choice, kept: &mut Cache) {
        if let Run::Glance(varying, _) = self {
            kept.keep(choice, *varying);
        }
    }

    /// The last time at which outputs can be evaluated.
    pub(crate) fn end(&self) -> f64 {
        match self {
            Run::Motion(motion) => motion.end(),
            Run::Glance(_, run) => run.end(),
        }
    }

    /// Outputs at `t`.
    pub(crate) fn at(&mut self, t: f64) -> Result<Outputs, SolveError> {
        match self {
            Run::Motion(motion) => motion.at(t),
            Run::Glance(varying, run) => run.at(&mut varying.prepared_mut().compiled, t),
        }
    }

    /// The equations, and the values of their free constants.
    pub(crate) fn equations(&self) -> (&Equations, &[f64]) {
        match self {
            Run::Motion(motion) => (&motion.equations, &motion.constants),
            Run::Glance(varying, _) => (&varying.prepared().equations, varying.constants()),
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
