//! Members integrated and read off.

use equations::{Compiled, Outputs};

use super::run::Outcome;
use super::threads::shared;
use super::{Ensemble, EnsembleMember, EnsembleOptions, MemberRun};
use crate::clock::Clock;
use crate::error_estimate::Differences;
use crate::metric::subtract;
use crate::single_run::outputs;
use crate::{ErrorEstimate, Metric, SolveError};

/// What became of a member, read off.
#[derive(Clone, Debug)]
pub struct MemberMotion {
    /// Coordinates, velocities, multipliers and invariants at the times asked for, as far as the motion came.
    pub outputs: Vec<Outputs>,
    /// Largest differences of the two runs at these times; zero where there is none of them, none without
    /// [`EnsembleOptions::estimate`]. A coordinate's size is also how far its velocity may have brought it.
    pub estimate: Option<ErrorEstimate>,
    /// The run behind it.
    pub run: MemberRun,
}

impl MemberMotion {
    /// [`crate::Ending::status`], untrusted where its estimate is too large ([`ErrorEstimate::complaint`]).
    pub fn status(&self) -> (&'static str, Option<String>) {
        self.run.ending.status(self.estimate.as_ref().and_then(ErrorEstimate::complaint))
    }
}

impl Ensemble {
    /// [`Ensemble::run`], and what its states say: multipliers, invariants, the error estimate.
    ///
    /// An `Err` is a member that could not be started or, with [`SolveError::Reading`], not be read off.
    pub fn motions(
        &self,
        members: &[EnsembleMember],
        times: &[f64],
        options: &EnsembleOptions,
    ) -> Vec<Result<MemberMotion, SolveError>> {
        self.timed_motions(members, times, options).0
    }

    /// The same, and the seconds of the integration: nothing that was read off is in them.
    fn timed_motions(
        &self,
        members: &[EnsembleMember],
        times: &[f64],
        options: &EnsembleOptions,
    ) -> (Vec<Result<MemberMotion, SolveError>>, f64) {
        let begin = Clock::start();
        let runs = self.run(members, times, options);
        let seconds = begin.seconds();
        let (compiled, metric) = (&self.varying.prepared().compiled, &self.metric);
        let names: Vec<String> = self.system.coordinates.iter().map(|c| c.name.clone()).collect();
        let read = shared(options.threads, members.len(), 1, |take| {
            let (compiled, metric) = (compiled.clone(), metric.clone());
            let mut reader = Reader { names: &names, compiled, metric, times };
            let mut done = Vec::new();
            while let Some(index) = take() {
                if let Ok(run) = &runs[index] {
                    done.push((index, reader.read(&members[index], run, options)));
                }
            }
            done
        });
        let joined = |(run, read): (Outcome, Option<Result<_, SolveError>>)| {
            let run = run?;
            let (outputs, estimate) = read.unwrap_or_else(|| Ok((Vec::new(), None)))?;
            Ok(MemberMotion { outputs, estimate, run })
        };
        (runs.into_iter().zip(read).map(joined).collect(), seconds)
    }
}

impl Ensemble {
    /// [`Ensemble::motions`] of those members that there are.
    pub fn answers(
        &self,
        members: Vec<Result<EnsembleMember, String>>,
        times: &[f64],
        options: &EnsembleOptions,
    ) -> Vec<Result<MemberMotion, String>> {
        self.timed_answers(members, times, options).0
    }

    /// [`Ensemble::answers`] and the seconds of the integration alone.
    pub fn timed_answers(
        &self,
        members: Vec<Result<EnsembleMember, String>>,
        times: &[f64],
        options: &EnsembleOptions,
    ) -> (Vec<Result<MemberMotion, String>>, f64) {
        let mut started = Vec::with_capacity(members.len());
        let refused: Vec<Option<String>> =
            members.into_iter().map(|member| member.map(|member| started.push(member)).err()).collect();
        let (motions, seconds) = self.timed_motions(&started, times, options);
        let mut motions = motions.into_iter();
        let answer = |cause: Option<String>| match cause {
            Some(cause) => Some(Err(cause)),
            None => motions.next().map(|motion| motion.map_err(|error| error.to_string())),
        };
        (refused.into_iter().filter_map(answer).collect(), seconds)
    }
}

struct Reader<'a> {
    names: &'a [String],
    compiled: Compiled,
    metric: Metric,
    times: &'a [f64],
}

impl Reader<'_> {
    fn read(
        &mut self,
        member: &EnsembleMember,
        run: &MemberRun,
        options: &EnsembleOptions,
    ) -> Result<(Vec<Outputs>, Option<ErrorEstimate>), SolveError> {
        member.set(&mut self.compiled);
        self.metric.set_parameters(&member.constants[member.constants.len() - self.metric.parameters()..]);
        let start = outputs(&mut self.compiled, member.t, &member.y)?.coordinates;
        let mut differences = Differences::from(self.names, &start);
        let mut read = Vec::with_capacity(run.states.len());
        for (i, (&t, y)) in self.times.iter().zip(&run.states).enumerate() {
            if let Some(unknowns) = run.unknowns.get(i) {
                self.compiled.set_guess(unknowns);
            }
            let now = outputs(&mut self.compiled, t, y)?;
            if let Some(difference) = run.differences.get(i) {
                let other = outputs(&mut self.compiled, t, &subtract(y, difference))?;
                differences.add(&mut self.metric, t, &now, &other, t - member.t);
            }
            read.push(now);
        }
        Ok((read, options.estimate.then(|| differences.estimate())))
    }
}
