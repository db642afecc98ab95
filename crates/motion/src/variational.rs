//! One run of a motion with its derivatives: alone for searches, beside a second one for error estimates.

use equations::{Outputs, Tangents};
use integrate::{Method, Options, Status, StopCause, Work};

use crate::direction::Direction;
use crate::{Prepared, SingleRun, SolveError};

/// A motion with its derivatives along directions, eight to a run.
pub struct VariationalRun<'a> {
    runs: Vec<(Tangents, SingleRun)>,
    along: &'a [Direction],
    states: usize,
    /// The method that was taken.
    pub(crate) method: Method,
}

/// The states of a motion, and how they and its constants move along a direction, by their size at most.
pub(crate) struct Moves {
    pub(crate) state: Vec<f64>,
    pub(crate) by: Vec<f64>,
    pub(crate) constants: Vec<f64>,
}

/// A run with derivatives along eight directions or less takes as long as this many without (measured on the
/// sledge, the bowl and three cylinders: 4.5 to 5.5). Fewer runs give differences in less time.
pub(crate) const PLAIN_RUNS: usize = 5;

/// Which of the two runs of a motion.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The tighter one.
    Kept,
    /// Its start has its last digits changed.
    Looser,
}

impl<'a> VariationalRun<'a> {
    /// Whether a method carries derivatives.
    pub fn is_by(method: Method) -> bool {
        matches!(method, Method::Taylor | Method::Dop853)
    }

    /// Refuses the other methods.
    pub(crate) fn check(method: Method) -> Result<(), SolveError> {
        if VariationalRun::is_by(method) {
            return Ok(());
        }
        let reason = format!("derivatives are carried by taylor and dop853, not by {}", method.name());
        Err(SolveError::Member { reason })
    }

    /// From the start of `prepared` to `end`. Taylor series give way to Runge and Kutta where rates are not
    /// smooth.
    pub fn run(
        prepared: &mut Prepared,
        along: &'a [Direction],
        end: f64,
        options: &Options,
        which: Which,
    ) -> Result<Self, SolveError> {
        let carried = VariationalRun::by(prepared, along, end, options, which)?;
        let rough = |status: &Status| matches!(status, Status::Stopped { cause: StopCause::NotSmooth { .. }, .. });
        if options.method == Method::Taylor && carried.runs.iter().any(|(_, run)| rough(&run.solution.status)) {
            let options = Options { method: Method::Dop853, ..options.clone() };
            return VariationalRun::by(prepared, along, end, &options, which);
        }
        Ok(carried)
    }

    /// The same by the method of the options, whatever comes.
    pub(crate) fn by(
        prepared: &mut Prepared,
        along: &'a [Direction],
        end: f64,
        options: &Options,
        which: Which,
    ) -> Result<Self, SolveError> {
        prepared.complete(options.method)?;
        let mut runs = Vec::new();
        for part in along.chunks(symbolic::LANES) {
            let mut tangents = Tangents::new(&prepared.compiled, part.len());
            for (l, direction) in part.iter().enumerate() {
                tangents.set_constants(&prepared.compiled, l, &direction.constants);
            }
            let starts: Vec<Vec<f64>> = part.iter().map(|direction| direction.start.clone()).collect();
            let run = prepared.integrate_with(&mut tangents, &starts, end, options, which == Which::Looser)?;
            runs.push((tangents, run));
        }
        Ok(VariationalRun { runs, along, states: prepared.start.len(), method: options.method })
    }

    /// How the run ended; of several, the first that stopped.
    pub fn status(&self) -> &Status {
        let each = || self.runs.iter().map(|(_, run)| &run.solution.status);
        each().find(|status| **status != Status::Completed).or_else(|| each().next()).expect("there are directions")
    }

    /// The times that the runs reached.
    pub(crate) fn ends(&self) -> impl Iterator<Item = f64> {
        self.runs.iter().map(|(_, run)| run.end())
    }

    /// End points of the steps.
    pub(crate) fn step_times(&self) -> Vec<f64> {
        self.runs.iter().flat_map(|(_, run)| run.solution.dense.step_times().iter().copied()).collect()
    }

    /// Steps of all runs, rejected ones too.
    pub(crate) fn steps(&self) -> usize {
        self.runs.iter().map(|(_, run)| run.solution.work.steps + run.solution.work.rejected).sum()
    }

    /// Work of the first run, with the steps of all.
    pub(crate) fn work(&self) -> Work {
        let all = || self.runs.iter().map(|(_, run)| run.solution.work);
        Work { steps: all().map(|work| work.steps).sum(), ..all().next().expect("there are directions") }
    }

    /// How the states at the end of the run move along each direction.
    pub(crate) fn end_moves(&self) -> impl Iterator<Item = &[f64]> {
        let ends = self.runs.iter().map(|(_, run)| &run.solution.dense.end_state()[self.states..]);
        ends.flat_map(|end| end.chunks_exact(self.states))
    }

    /// The states at `t`, and how they move along each direction.
    pub(crate) fn moves(&self, prepared: &mut Prepared, t: f64) -> Result<Vec<Moves>, SolveError> {
        let (n, mut all) = (self.states, Vec::new());
        for ((tangents, run), along) in self.runs.iter().zip(self.along.chunks(symbolic::LANES)) {
            let state = states(prepared, tangents, run, t)?;
            let (state, moves) = state.split_at(n);
            let moves = moves.chunks_exact(n).zip(along).map(|(by, direction)| {
                let largest = by.iter().zip(&run.sizes).fold(1.0_f64, |a, (by, size)| a.max(by.abs() / size));
                let by = by.iter().map(|x| x / largest).collect();
                let constants = direction.constants.iter().map(|x| x / largest).collect();
                Moves { state: state.to_vec(), by, constants }
            });
            all.extend(moves);
        }
        Ok(all)
    }

    /// Outputs at `t`, and their derivatives along each direction, divided by its scale.
    pub fn at(&mut self, prepared: &mut Prepared, t: f64) -> Result<(Outputs, Vec<Outputs>), SolveError> {
        let mut read: Option<(Outputs, Vec<Outputs>)> = None;
        for (tangents, run) in &mut self.runs {
            let state = states(prepared, tangents, run, t)?;
            let found = tangents.outputs(&mut prepared.compiled, t, &state);
            let (outputs, derivatives) = found.map_err(|failure| SolveError::Reading { t, failure })?;
            read.get_or_insert((outputs, Vec::new())).1.extend(derivatives);
        }
        let (outputs, mut derivatives) = read.expect("there are directions");
        for (found, along) in derivatives.iter_mut().zip(self.along) {
            let parts = [&mut found.coordinates, &mut found.velocities, &mut found.multipliers, &mut found.invariants];
            parts.into_iter().flatten().for_each(|x| *x /= along.scale);
        }
        Ok((outputs, derivatives))
    }
}

/// `(y, dy along direction 1, …)` at `t`.
fn states(prepared: &mut Prepared, tangents: &Tangents, run: &SingleRun, t: f64) -> Result<Vec<f64>, SolveError> {
    let mut state = vec![0.0; prepared.start.len() * (1 + tangents.directions())];
    run.states_at(&mut prepared.compiled, t, &mut state)?;
    Ok(state)
}
