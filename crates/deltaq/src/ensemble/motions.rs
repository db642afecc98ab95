//! Members integrated and read off.

use equations::{Compiled, Named, Outputs};

use super::run::Outcome;
use super::threads::shared;
use super::{Ensemble, EnsembleMember, EnsembleOptions, MemberRun};
use crate::clock::Clock;
use crate::error_estimate::Differences;
use crate::last_digits::terms_of_invariants;
use crate::lost_digits::{self, Looked, finite, is_small, largest};
use crate::metric::subtract;
use crate::round_off::BEFORE_THE_END;
use crate::single_run::outputs;
use crate::sizes::sizes;
use crate::watch::Watch;
use crate::{Doubt, Ending, ErrorEstimate, Metric, SolveError};

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
        let watch = Watch::new(&self.system, &self.starts.parameters());
        let watch = match watch {
            Ok(watch) => watch,
            Err(error) => return (members.iter().map(|_| Err(error.clone().into())).collect(), seconds),
        };
        let invariants = &self.equations().invariants;
        let states = lost_digits::names_of_states(self.equations());
        let (compiled, metric) = (&self.varying.prepared().compiled, &self.metric);
        let names: Vec<String> = self.system.coordinates.iter().map(|c| c.name.clone()).collect();
        let multipliers: Vec<String> = self.equations().multipliers.iter().map(|m| m.name.clone()).collect();
        let read = shared(options.threads, members.len(), 1, |take| {
            let (compiled, metric, watch) = (compiled.clone(), metric.clone(), watch.clone());
            let mut reader = Reader {
                names: &names,
                multipliers: &multipliers,
                compiled,
                metric,
                watch,
                invariants,
                states: &states,
                instants: &instants,
            };
            let mut done = Vec::new();
            while let Some(index) = take() {
                if let Ok(run) = &runs[index] {
                    done.push((index, reader.read(&members[index], run, options)));
                }
            }
            done
        });
        let joined = |(run, read): (Outcome, Option<Result<_, SolveError>>)| {
            let mut run = run?;
            let (outputs, estimate, doubt) = read.unwrap_or_else(|| Ok((Vec::new(), None, None)))?;
            for values in [&mut run.states, &mut run.differences, &mut run.unknowns] {
                let mut asked = instants.iter().map(|(_, asked)| *asked);
                values.retain(|_| asked.next().unwrap_or(true));
            }
            Ok(MemberMotion { outputs, estimate, doubt, run })
        };
        let mut motions: Vec<_> = runs.into_iter().zip(read).map(joined).collect();
        let singly = |(motion, member): (&mut Result<MemberMotion, SolveError>, &EnsembleMember)| {
            let stopped = match &*motion {
                Err(SolveError::AtStart(_)) => Some(member.t),
                Ok(found) if found.run.left_chart && options.estimate => found.run.stopped(),
                _ => None,
            };
            if let Some(found) = stopped.and_then(|t| self.singly(member, t, times, options)) {
                *motion = Ok(found);
            }
        };
        motions.iter_mut().zip(members).for_each(singly);
        (motions, seconds)
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

/// Instants within the time of all members at which their constraints are looked at.
const WATCHED: usize = 8;

/// The times asked for, in their order, and where an error is estimated, others between them.
fn instants(members: &[EnsembleMember], times: &[f64], options: &EnsembleOptions) -> Vec<(f64, bool)> {
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

/// So many instants are looked at for round-off first, beside the start.
const FEW: usize = 4;

struct Reader<'a> {
    names: &'a [String],
    multipliers: &'a [String],
    compiled: Compiled,
    metric: Metric,
    watch: Watch,
    invariants: &'a [Named],
    states: &'a [String],
    instants: &'a [(f64, bool)],
}

type Read = (Vec<Outputs>, Option<ErrorEstimate>, Option<Doubt>);

impl Reader<'_> {
    fn read(
        &mut self,
        member: &EnsembleMember,
        run: &MemberRun,
        options: &EnsembleOptions,
    ) -> Result<Read, SolveError> {
        member.set(&mut self.compiled);
        let parameters = &member.constants[member.constants.len() - self.metric.parameters()..];
        self.metric.set_parameters(parameters);
        let start = outputs(&mut self.compiled, member.t, &member.y)?;
        self.watch.begin(member.t, &start, parameters);
        let mut differences = Differences::from(self.names, self.multipliers, &start.coordinates);
        let mut read = Vec::with_capacity(run.states.len());
        let (mut is_clear, mut sizes) = (true, Vec::new());
        for (i, (&(t, asked), y)) in self.instants.iter().zip(&run.states).enumerate() {
            let now = self.at(run, i, t, y);
            let now = if asked {
                now?
            } else if let Ok(now) = now {
                now
            } else {
                continue;
            };
            let mut terms = || terms(&mut self.compiled, &mut self.metric, member, &mut sizes, t, y);
            is_clear &= !options.estimate || self.watch.is_clear(t, &now, &mut terms);
            if !asked {
                continue;
            }
            if let Some(difference) = run.differences.get(i) {
                let other = outputs(&mut self.compiled, t, &subtract(y, difference))?;
                differences.add(&mut self.metric, t, &now, &other, t - member.t);
                if differences.has_doubtful_multipliers() {
                    differences.add_terms(self.compiled.terms_of_multipliers(member.t, t, y).ok());
                }
            }
            read.push(now);
        }
        let mut doubt = if is_clear { None } else { self.broken(member, run) };
        if doubt.is_none() && options.estimate {
            doubt = self.rounded_off(member, run, &mut sizes);
        }
        Ok((read, options.estimate.then(|| differences.estimate(&self.metric)), doubt))
    }

    fn at(&mut self, run: &MemberRun, i: usize, t: f64, y: &[f64]) -> Result<Outputs, SolveError> {
        if let Some(unknowns) = run.unknowns.get(i) {
            self.compiled.set_guess(unknowns);
        }
        outputs(&mut self.compiled, t, y)
    }

    /// Where something is off by more than the two runs leave open.
    fn broken(&mut self, member: &EnsembleMember, run: &MemberRun) -> Option<Doubt> {
        let (mut from, mut sizes) = (member.t, Vec::new());
        for (i, (&(t, _), y)) in self.instants.iter().zip(&run.states).enumerate() {
            let kept = self.at(run, i, t, y).ok()?;
            let looser = outputs(&mut self.compiled, t, &subtract(y, run.differences.get(i)?)).ok()?;
            let mut terms = || terms(&mut self.compiled, &mut self.metric, member, &mut sizes, t, y);
            if let Some(because) = self.watch.complaint(t, [&kept, &looser], self.invariants, &mut terms) {
                return Some(Doubt { from, because });
            }
            from = t;
        }
        None
    }
}

impl Reader<'_> {
    /// As of a single motion, at the instants there are.
    fn rounded_off(&mut self, member: &EnsembleMember, run: &MemberRun, sizes: &mut Vec<f64>) -> Option<Doubt> {
        let reached = match run.ending {
            Ending::Completed => member.end,
            Ending::Stopped { t, .. } => member.t + BEFORE_THE_END * (t - member.t),
        };
        let length = (reached - member.t).abs();
        let count = self.instants.iter().take_while(|(t, _)| (t - member.t).abs() <= length).count();
        let count = count.min(run.states.len());
        let few: Vec<usize> = (1..=FEW).map(|k| k * count / FEW).filter(|&i| i > 0).map(|i| i - 1).collect();
        let looked = self.looked(member, run, few);
        if is_small(&looked, &largest(&looked, vec![0.0; member.y.len()]), length) {
            return None;
        }
        let sizes = sized(&mut self.compiled, &mut self.metric, member, sizes);
        if is_small(&looked, &largest(&looked, sizes.to_vec()), length) {
            return None;
        }
        let looked = self.looked(member, run, 0..count);
        let states = run.states.iter().zip(&run.differences).map(|(y, difference)| subtract(y, difference));
        let looser: Vec<Vec<f64>> = std::iter::once(member.y.clone()).chain(states).collect();
        let sizes = largest(&looked, sizes.to_vec());
        lost_digits::doubt(&mut self.compiled, self.states, &looked, &looser, &sizes)
    }

    /// The start and these instants, as far as it can be told what is added up to rates there.
    fn looked(
        &mut self,
        member: &EnsembleMember,
        run: &MemberRun,
        instants: impl IntoIterator<Item = usize>,
    ) -> Vec<Looked> {
        let instants = instants.into_iter().map(Some);
        let all = std::iter::once(None).chain(instants);
        all.map_while(|i| {
            let (t, y) = i.map_or((member.t, &member.y), |i| (self.instants[i].0, &run.states[i]));
            if let Some(unknowns) = i.and_then(|i| run.unknowns.get(i)) {
                self.compiled.set_guess(unknowns);
            }
            let terms = self.compiled.terms_of_rates(t, y).ok()?;
            Some((t, y.clone(), finite(terms)))
        })
        .collect()
    }
}

/// `sizes` are those of the member's states, once they are asked for.
fn sized<'a>(
    compiled: &mut Compiled,
    metric: &mut Metric,
    member: &EnsembleMember,
    sizes: &'a mut Vec<f64>,
) -> &'a [f64] {
    if sizes.is_empty() {
        *sizes = self::sizes(compiled, metric, member.t, &member.y, member.end - member.t);
    }
    sizes
}

/// What is added up to invariants.
fn terms(
    compiled: &mut Compiled,
    metric: &mut Metric,
    member: &EnsembleMember,
    sizes: &mut Vec<f64>,
    t: f64,
    y: &[f64],
) -> Option<Vec<f64>> {
    let sizes = sized(compiled, metric, member, sizes);
    terms_of_invariants(compiled, t, y, sizes)
}
