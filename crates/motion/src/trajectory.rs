//! States over time, however they were computed.

use std::borrow::Cow;
use std::sync::Arc;

use equations::{Compiled, Outputs};

use crate::SolveError;
use crate::chart_transition::Later;
use crate::discrete_run::DiscreteRun;
use crate::single_run::{SingleRun, outputs};

/// A run from chart to chart, those after the first with their own equations.
pub(crate) type Legs = Vec<(SingleRun, Option<Box<Later>>)>;

/// States over time.
#[derive(Clone)]
pub(crate) enum Trajectory {
    /// The polynomials of the time loop.
    TimeLoop(Box<SingleRun>),
    /// The same from chart to chart.
    Charts(Legs),
    /// The nodes of a discrete motion.
    Discrete(Box<DiscreteRun>),
}

impl Trajectory {
    /// Times of the start and of the end.
    pub(crate) fn ends(&self) -> [f64; 2] {
        match self {
            Trajectory::TimeLoop(run) => [run.solution.dense.start(), run.end()],
            Trajectory::Charts(legs) => [legs[0].0.solution.dense.start(), legs[legs.len() - 1].0.end()],
            Trajectory::Discrete(run) => run.ends(),
        }
    }

    /// Sizes of the states of the first chart; none of a motion in equal steps.
    pub(crate) fn sizes(&self) -> &[f64] {
        match self {
            Trajectory::TimeLoop(run) => &run.sizes,
            Trajectory::Charts(legs) => &legs[0].0.sizes,
            Trajectory::Discrete(_) => &[],
        }
    }

    /// The times at which it is known, where those are not all.
    pub(crate) fn thinned_to(&self) -> Option<&Arc<[f64]>> {
        match self {
            Trajectory::TimeLoop(run) => run.solution.dense.thinned_to(),
            Trajectory::Charts(legs) => legs.iter().find_map(|(run, _)| run.solution.dense.thinned_to()),
            Trajectory::Discrete(_) => None,
        }
    }

    /// End points of the steps.
    pub(crate) fn step_times(&self) -> Cow<'_, [f64]> {
        match self {
            Trajectory::TimeLoop(run) => run.solution.dense.step_times().into(),
            Trajectory::Charts(legs) => {
                let mut times: Vec<f64> = Vec::new();
                legs.iter().for_each(|(run, _)| times.extend(run.solution.dense.step_times()));
                times.dedup();
                times.into()
            }
            Trajectory::Discrete(run) => run.times().into(),
        }
    }

    /// The state at `t`, in the variables of the first chart. Equations of the instant with several roots
    /// then start from the right one.
    pub(crate) fn state(&mut self, compiled: &mut Compiled, t: f64) -> Result<Vec<f64>, SolveError> {
        let mut state = vec![0.0; compiled.dimension()];
        match self {
            Trajectory::TimeLoop(run) => run.states_at(compiled, t, &mut state)?,
            Trajectory::Charts(legs) => match leg(legs, t) {
                (run, None) => run.states_at(compiled, t, &mut state)?,
                (run, Some(later)) => return later.states(run, t),
            },
            Trajectory::Discrete(run) => run.state(compiled, t, &mut state)?,
        }
        Ok(state)
    }

    /// Outputs at `t`.
    pub(crate) fn outputs(&mut self, compiled: &mut Compiled, t: f64) -> Result<Outputs, SolveError> {
        if let Trajectory::Charts(legs) = self {
            return outputs_in(legs, compiled, t);
        }
        let state = self.state(compiled, t)?;
        outputs(compiled, t, &state)
    }
}

/// Outputs at `t`, as of the first chart, which is `compiled`.
pub(crate) fn outputs_in(legs: &mut Legs, compiled: &mut Compiled, t: f64) -> Result<Outputs, SolveError> {
    match leg(legs, t) {
        (run, None) => run.at(compiled, t),
        (run, Some(later)) => later.outputs(run, t),
    }
}

/// The chart in which the motion is at `t`.
fn leg(legs: &mut Legs, t: f64) -> &mut (SingleRun, Option<Box<Later>>) {
    let ends = |run: &SingleRun| (run.end() - t) * (run.end() - run.solution.dense.start()) >= 0.0;
    let last = legs.len() - 1;
    let at = legs[..last].iter().position(|(run, _)| ends(run)).unwrap_or(last);
    &mut legs[at]
}
