//! Members integrated and read off.

use super::reading::{Reader, Reading};
use super::run::Outcome;
use super::threads::shared;
use super::{Ensemble, EnsembleMember, EnsembleOptions, MemberRun};
use crate::clock::Clock;
use crate::metric::subtract;
use crate::{Breach, Doubt, ErrorEstimate, SolveError};
use equations::Outputs;
use symbolic::caught;

/// What became of a member, read off.
#[derive(Clone, Debug)]
pub struct MemberMotion {
    /// Coordinates, velocities, multipliers and invariants at the times asked for, as far as the motion came.
    pub outputs: Vec<Outputs>,
    /// Largest differences of the two runs at these times; zero where there is none of them, none without
    /// [`EnsembleOptions::estimate`]. A coordinate's size is also how far its velocity may have brought it.
    pub estimate: Option<ErrorEstimate>,
    /// Where the scene's own constraints, or what is listed as constant, are off by more than the two runs
    /// leave open; never without [`EnsembleOptions::estimate`].
    pub doubt: Option<Doubt>,
    /// [`crate::Motion::breaches`]; empty where no estimate was asked for.
    pub breaches: Vec<Breach>,
    /// The run behind it.
    pub run: MemberRun,
}

impl MemberMotion {
    /// [`crate::Ending::status`], untrusted where it is in doubt or its estimate is too large
    /// ([`ErrorEstimate::complaint`]).
    pub fn status(&self) -> (&'static str, Option<String>) {
        let doubt = self.doubt.as_ref().map(|doubt| doubt.because.clone());
        self.run.ending.status(doubt.or_else(|| self.estimate.as_ref().and_then(ErrorEstimate::complaint)))
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
        let instants = instants(members, times, options);
        let all: Vec<f64> = instants.iter().map(|(t, _)| *t).collect();
        let runs = self.run(members, &all, options);
        let seconds = begin.seconds();
        let reader = match self.reader(&instants) {
            Ok(reader) => reader,
            Err(error) => return (members.iter().map(|_| Err(error.clone())).collect(), seconds),
        };
        let (runs, read) = self.read(&reader, members, runs, options);
        let joined = |(run, read): (Outcome, Option<Result<Reading, SolveError>>)| {
            let mut run = run?;
            let Reading { outputs, estimate, doubt, breaches, .. } = read.unwrap_or_else(|| Ok(Reading::default()))?;
            for values in [&mut run.states, &mut run.differences, &mut run.unknowns] {
                let mut asked = instants.iter().map(|(_, asked)| *asked);
                values.retain(|_| asked.next().unwrap_or(true));
            }
            Ok(MemberMotion { outputs, estimate, doubt, breaches, run })
        };
        let mut motions: Vec<_> = runs.into_iter().zip(read).map(joined).collect();
        let singly = |(motion, member): (&mut Result<MemberMotion, SolveError>, &EnsembleMember)| {
            let stopped = match &*motion {
                Err(SolveError::AtStart(_)) => Some(member.t),
                Ok(found) if found.run.left_chart && options.estimate => found.run.stopped(),
                _ => None,
            };
            let found = caught("row", || stopped.and_then(|t| self.singly(member, t, times, options)));
            if let Some(found) = found.map_err(SolveError::from).transpose() {
                *motion = found;
            }
        };
        motions.iter_mut().zip(members).for_each(singly);
        (motions, seconds)
    }
}

type Readings = Vec<Option<Result<Reading, SolveError>>>;

impl Ensemble {
    /// What runs say; where round-off of the rates is more than both runs of a member differ by, with a
    /// looser run that has it in its rates.
    fn read(
        &self,
        reader: &Reader,
        members: &[EnsembleMember],
        mut runs: Vec<Outcome>,
        options: &EnsembleOptions,
    ) -> (Vec<Outcome>, Readings) {
        let mut read = read_all(reader, members, &runs, options);
        let disturbance = |(index, reading): (usize, &mut Option<Result<Reading, SolveError>>)| {
            let reading = reading.as_mut()?.as_mut().ok()?;
            Some((index, reading.disturbance.take()?))
        };
        let (places, disturbances): (Vec<usize>, Vec<Vec<f64>>) =
            read.iter_mut().enumerate().filter_map(disturbance).unzip();
        if places.is_empty() {
            return (runs, read);
        }
        let disturbed = places.iter().map(|&i| &members[i]).zip(disturbances).collect();
        let times: Vec<f64> = reader.instants.iter().map(|(t, _)| *t).collect();
        let again = match self.run_disturbed(disturbed, &times, options.threads) {
            Ok(again) => again,
            Err(error) => {
                places.iter().for_each(|&i| read[i] = Some(Err(error.clone())));
                return (runs, read);
            }
        };
        let mut counted = Vec::with_capacity(places.len());
        for (&i, looser) in places.iter().zip(again) {
            let Ok(kept) = &mut runs[i] else { continue };
            match looser {
                Ok(looser) if looser.states.len() >= kept.states.len() || kept.stopped().is_some() => {
                    kept.states.truncate(looser.states.len());
                    kept.unknowns.truncate(looser.states.len());
                    kept.differences = kept.states.iter().zip(&looser.states).map(|(a, b)| subtract(a, b)).collect();
                    counted.push(i);
                }
                // no run follows the motion with round-off in its rates
                Ok(_) => {}
                Err(error) => read[i] = Some(Err(error)),
            }
        }
        let once_more = counted.iter().map(|&i| (members[i].clone(), runs[i].clone()));
        let (members, kept): (Vec<EnsembleMember>, Vec<Outcome>) = once_more.unzip();
        for (i, reading) in counted.into_iter().zip(read_all(reader, &members, &kept, options)) {
            read[i] = reading;
        }
        (runs, read)
    }

    /// [`Ensemble::motions`] of the members that could be started.
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

fn read_all(reader: &Reader, members: &[EnsembleMember], runs: &[Outcome], options: &EnsembleOptions) -> Readings {
    shared(options.threads, members.len(), 1, |take| {
        let mut reader = reader.clone();
        let mut done = Vec::new();
        while let Some(index) = take() {
            if let Ok(run) = &runs[index] {
                let read = caught("row", || reader.read(&members[index], run, options));
                done.push((index, read.unwrap_or_else(|broken| Err(broken.into()))));
            }
        }
        done
    })
}

/// Instants within the time of all members at which their constraints are looked at.
pub const WATCHED: usize = 8;

/// The times asked for, in their order, and where an error is estimated, others between them.
pub fn instants(members: &[EnsembleMember], times: &[f64], options: &EnsembleOptions) -> Vec<(f64, bool)> {
    let mut instants: Vec<(f64, bool)> = times.iter().map(|&t| (t, true)).collect();
    let Some(first) = members.first().filter(|_| options.estimate) else { return instants };
    let direction = (first.end - first.t).signum();
    let latest = |of: &dyn Fn(&EnsembleMember) -> f64| members.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
    // in the direction of time, from the last start to the first end
    let (start, end) = (latest(&|m| direction * m.t), -latest(&|m| -direction * m.end));
    if start < end && end.is_finite() && times.windows(2).all(|pair| direction * pair[0] <= direction * pair[1]) {
        let between = |i: usize| direction * (start + (end - start) * i as f64 / (WATCHED + 1) as f64);
        instants.extend((1..=WATCHED).map(|i| (between(i), false)));
        instants.sort_by(|a, b| (direction * a.0).total_cmp(&(direction * b.0)));
    }
    instants
}
