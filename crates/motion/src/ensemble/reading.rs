//! What members say at the times asked for, and how far they are to be trusted.

use equations::{Compiled, Outputs};
use integrate::DenseError;

use super::{Ensemble, EnsembleMember, EnsembleOptions, MemberRun};
use crate::band::accumulated_round_off::RoundOff;
use crate::band::invariant_monitor::{Breach, InvariantMonitor};
use crate::band::limits::{BEFORE_THE_END, SOME};
use crate::band::{Band, TwoRuns, round_off};
use crate::metric::subtract;
use crate::single_run::outputs;
use crate::state_scales::sizes;
use crate::{Doubt, Ending, ErrorEstimate, Metric, SolveError};

/// Reads members off.
#[derive(Clone)]
pub(super) struct Reader<'a> {
    multipliers: Vec<String>,
    compiled: Compiled,
    metric: Metric,
    monitor: InvariantMonitor,
    states: Vec<String>,
    /// Times of all states of a run, and whether they were asked for.
    pub(super) instants: &'a [(f64, bool)],
}

/// What was read off a member.
#[derive(Default)]
pub(super) struct Reading {
    pub(super) outputs: Vec<Outputs>,
    pub(super) estimate: Option<ErrorEstimate>,
    pub(super) doubt: Option<Doubt>,
    pub(super) breaches: Vec<Breach>,
    /// Round-off that has to be put into its rates.
    pub(super) offsets: Option<Vec<f64>>,
}

impl Ensemble {
    pub(super) fn reader<'a>(&'a self, instants: &'a [(f64, bool)]) -> Result<Reader<'a>, SolveError> {
        let equations = self.equations();
        Ok(Reader {
            multipliers: equations.multipliers.iter().map(|m| m.name.clone()).collect(),
            compiled: self.compiled().clone(),
            metric: self.metric.clone(),
            monitor: InvariantMonitor::new(&self.system, equations, &self.by_name.parameters())?,
            states: equations.states.iter().map(|state| equations.graph.name(state.symbol)).collect(),
            instants,
        })
    }
}

impl Reader<'_> {
    pub(super) fn read(
        &mut self,
        member: &EnsembleMember,
        run: &MemberRun,
        options: &EnsembleOptions,
    ) -> Result<Reading, SolveError> {
        member.set(&mut self.compiled);
        let parameters = &member.constants[member.constants.len() - self.metric.parameters()..];
        self.metric.set_parameters(parameters);
        let Reader { compiled, metric, monitor, instants, states, multipliers } = self;
        let mut of_sizes = metric.clone();
        let mut runs =
            Runs { compiled, metric: &mut of_sizes, member, run, instants, states, sizes: Vec::new(), place: 0 };
        let start = runs.kept(member.t)?;
        let mut band = Band::from(member.t, &start.coordinates);
        let mut kept = vec![(member.t, start)];
        let mut read = Vec::with_capacity(run.states.len());
        let every = (run.states.len() / SOME).max(1);
        for (i, &(t, asked)) in instants.iter().enumerate().take(run.states.len()) {
            let now = match asked && options.estimate {
                true => band.look(&mut runs, metric, t, i % every == 0),
                false => runs.kept(t),
            };
            match now {
                Ok(now) => {
                    read.extend(asked.then(|| now.clone()));
                    kept.push((t, now));
                }
                Err(error) if asked => return Err(error),
                Err(_) => {}
            }
        }
        let mut found = Reading { outputs: read, ..Reading::default() };
        if options.estimate {
            found.doubt = monitor.doubt(&mut runs, &kept, parameters);
            found.breaches = std::mem::take(&mut monitor.breaches);
            if found.doubt.is_none() {
                match round_off::round_off(&mut runs) {
                    RoundOff::Small => {}
                    RoundOff::Counts(offsets) => found.offsets = Some(offsets),
                    RoundOff::Doubted(doubt) => found.doubt = Some(doubt),
                }
            }
            found.estimate = Some(band.estimate(metric, multipliers));
        }
        Ok(found)
    }
}

/// Both runs of a member, at the instants there are.
struct Runs<'a> {
    compiled: &'a mut Compiled,
    metric: &'a mut Metric,
    member: &'a EnsembleMember,
    run: &'a MemberRun,
    instants: &'a [(f64, bool)],
    states: &'a [String],
    /// Of its states, once they are asked for.
    sizes: Vec<f64>,
    /// Of the last instant that was found.
    place: usize,
}

impl Runs<'_> {
    /// The place of an instant; `None` of the start.
    fn find(&mut self, t: f64) -> Option<usize> {
        let count = self.run.states.len();
        let places = (0..count).map(|i| (self.place + i) % count);
        let found = places.into_iter().find(|&i| self.instants[i].0 == t)?;
        self.place = found;
        Some(found)
    }

    /// Just before a singularity all terms are large.
    fn is_judged(&self, t: f64) -> bool {
        let EnsembleMember { t: start, end, .. } = *self.member;
        let length = match self.run.ending {
            Ending::Completed => (end - start).abs(),
            Ending::Stopped { t, .. } => BEFORE_THE_END * (t - start).abs(),
        };
        (t - start).abs() <= length
    }

    fn not_stored(&self, t: f64) -> DenseError {
        DenseError::NotStored { t, start: self.member.t, end: self.member.end }
    }

    fn difference(&mut self, t: f64) -> Option<&[f64]> {
        self.find(t).and_then(|i| self.run.differences.get(i)).map(Vec::as_slice)
    }
}

impl TwoRuns for Runs<'_> {
    fn kept(&mut self, t: f64) -> Result<Outputs, SolveError> {
        let y = self.states(t).ok_or(self.not_stored(t))?;
        outputs(self.compiled, t, &y)
    }
    fn looser(&mut self, t: f64) -> Result<Outputs, SolveError> {
        let y = self.looser_states(t).ok_or(self.not_stored(t))?;
        outputs(self.compiled, t, &y)
    }
    fn states(&mut self, t: f64) -> Option<Vec<f64>> {
        match self.find(t) {
            Some(i) => {
                // equations of the instant that have several roots start from that of the motion
                self.run.unknowns.get(i).into_iter().for_each(|unknowns| self.compiled.set_guess(unknowns));
                Some(self.run.states[i].clone())
            }
            None if t == self.member.t => {
                self.member.set(self.compiled);
                Some(self.member.y.clone())
            }
            None => {
                let (_, y) = self.run.shortest.iter().find(|(end, _)| *end == t)?;
                let nearest = |i: &usize| (self.instants[*i].0 - t).abs();
                let known = (0..self.run.unknowns.len()).min_by(|a, b| nearest(a).total_cmp(&nearest(b)));
                known.into_iter().for_each(|i| self.compiled.set_guess(&self.run.unknowns[i]));
                Some(y.clone())
            }
        }
    }
    fn looser_states(&mut self, t: f64) -> Option<Vec<f64>> {
        let kept = self.states(t)?;
        Some(self.difference(t).map_or(kept.clone(), |difference| subtract(&kept, difference)))
    }
    fn compiled(&mut self) -> &mut Compiled {
        self.compiled
    }
    fn sizes(&mut self) -> Vec<f64> {
        if self.sizes.is_empty() {
            let EnsembleMember { t, end, y, .. } = self.member;
            self.sizes = sizes(self.compiled, self.metric, *t, y, end - t);
        }
        self.sizes.clone()
    }
    fn names(&self) -> Vec<String> {
        self.states.to_vec()
    }
    fn equidistant(&self, _: usize) -> Vec<f64> {
        let within = self.instants.iter().take_while(|(t, _)| self.is_judged(*t));
        let (start, count) = (self.member.t, within.count().min(self.run.states.len()));
        let mut places: Vec<usize> = (1..=SOME).map(|k| k * count / SOME).filter(|&i| i > 0).collect();
        places.dedup();
        std::iter::once(start).chain(places.into_iter().map(|i| self.instants[i - 1].0)).collect()
    }
    fn ends_of_steps(&self) -> Vec<f64> {
        self.run.shortest.iter().map(|(t, _)| *t).filter(|t| self.is_judged(*t)).collect()
    }
}
