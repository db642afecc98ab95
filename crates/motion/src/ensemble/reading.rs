//! What members say at the times asked for, and how far they are to be trusted.

use equations::{Compiled, Named, Outputs};

use super::{Ensemble, EnsembleMember, EnsembleOptions, MemberRun};
use crate::error_estimate::Differences;
use crate::last_digits::terms_of_invariants;
use crate::lost_digits::{self, Looked, RoundOff, largest};
use crate::metric::subtract;
use crate::round_off::BEFORE_THE_END;
use crate::single_run::outputs;
use crate::sizes::sizes;
use crate::watch::{Breach, Watch};
use crate::{Doubt, Ending, ErrorEstimate, Metric, SolveError};

/// Largest number of instants, beside the start, that are examined for round-off.
const LOOKED: usize = 16;

/// Reads members off.
#[derive(Clone)]
pub(super) struct Reader<'a> {
    names: Vec<String>,
    multipliers: Vec<String>,
    compiled: Compiled,
    metric: Metric,
    watch: Watch,
    invariants: &'a [Named],
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
    pub(super) disturbance: Option<Vec<f64>>,
}

impl Ensemble {
    pub(super) fn reader<'a>(&'a self, instants: &'a [(f64, bool)]) -> Result<Reader<'a>, SolveError> {
        let equations = self.equations();
        Ok(Reader {
            names: self.system.coordinates.iter().map(|c| c.name.clone()).collect(),
            multipliers: equations.multipliers.iter().map(|m| m.name.clone()).collect(),
            compiled: self.compiled().clone(),
            metric: self.metric.clone(),
            watch: Watch::new(&self.system, equations, &self.by_name.parameters())?,
            invariants: &equations.invariants,
            states: lost_digits::names_of_states(equations),
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
        let start = outputs(&mut self.compiled, member.t, &member.y)?;
        self.watch.begin(member.t, &start, parameters);
        let (names, multipliers) = (self.names.clone(), self.multipliers.clone());
        let mut differences = Differences::from(&names, &multipliers, &start.coordinates);
        let mut read = Vec::with_capacity(run.states.len());
        let every = (run.states.len() / LOOKED).max(1);
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
                if !multipliers.is_empty() && i % every == 0 {
                    differences.add_round_off(&mut self.compiled, t, y);
                }
            }
            read.push(now);
        }
        let mut doubt = if is_clear { None } else { self.broken(member, run) };
        let breaches = if is_clear { Vec::new() } else { self.watch.breaches.clone() };
        let mut disturbance = None;
        if doubt.is_none() && options.estimate {
            match self.round_off(member, run, &mut sizes) {
                RoundOff::Small => {}
                RoundOff::Counts(found) => disturbance = Some(found),
                RoundOff::Doubted(found) => doubt = Some(found),
            }
        }
        let estimate = options.estimate.then(|| differences.estimate(&self.metric));
        Ok(Reading { outputs: read, estimate, doubt, breaches, disturbance })
    }

    fn at(&mut self, run: &MemberRun, i: usize, t: f64, y: &[f64]) -> Result<Outputs, SolveError> {
        guess(&mut self.compiled, run, i);
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
    fn round_off(&mut self, member: &EnsembleMember, run: &MemberRun, sizes: &mut Vec<f64>) -> RoundOff {
        let reached = match run.ending {
            Ending::Completed => member.end,
            Ending::Stopped { t, .. } => member.t + BEFORE_THE_END * (t - member.t),
        };
        let length = (reached - member.t).abs();
        let count = self.instants.iter().take_while(|(t, _)| (t - member.t).abs() <= length).count();
        let count = count.min(run.states.len());
        let mut places: Vec<usize> =
            (1..=LOOKED).map(|k| k * count / LOOKED).filter(|&i| i > 0).map(|i| i - 1).collect();
        places.dedup();
        let looser = places.iter().map(|&i| subtract(&run.states[i], &run.differences[i]));
        let looser: Vec<Vec<f64>> = std::iter::once(member.y.clone()).chain(looser).collect();
        let mut looked = self.looked(member, run, places.clone());
        let none = vec![0.0; member.y.len()];
        if lost_digits::is_small(&looked, &looser, &largest(&looked, none.clone()), 1.0) {
            return RoundOff::Small;
        }
        let roots = std::iter::once(None).chain(places.into_iter().map(Some));
        for (looked, root) in looked.iter_mut().zip(roots) {
            set_root(&mut self.compiled, member, run, root);
            lost_digits::look_closer(&mut self.compiled, looked);
        }
        if lost_digits::is_small(&looked, &looser, &largest(&looked, none), 1.0) {
            return RoundOff::Small;
        }
        let sizes = sized(&mut self.compiled, &mut self.metric, member, sizes);
        let sizes = largest(&looked, sizes.to_vec());
        let names = || self.states.clone();
        let (compiled, instants) = (&mut self.compiled, self.instants);
        let mut rates = |t: f64, y: &[f64], rates: &mut [f64]| {
            set_root(compiled, member, run, instants.iter().position(|(instant, _)| *instant == t));
            compiled.rates(t, y, rates).is_ok()
        };
        lost_digits::round_off(&mut rates, &names, &looked, &looser, &sizes)
    }

    /// States and sums of terms behind rates at the start and at these instants, up to the first at which
    /// they cannot be evaluated.
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
            set_root(&mut self.compiled, member, run, i);
            lost_digits::look(&mut self.compiled, t, y)
        })
        .collect()
    }
}

/// Equations of the instant that have several roots start from that of the motion at an instant.
fn guess(compiled: &mut Compiled, run: &MemberRun, i: usize) {
    run.unknowns.get(i).into_iter().for_each(|unknowns| compiled.set_guess(unknowns));
}

/// As [`guess`] at an instant, or at the start.
fn set_root(compiled: &mut Compiled, member: &EnsembleMember, run: &MemberRun, instant: Option<usize>) {
    match instant {
        None => member.set(compiled),
        Some(i) => guess(compiled, run, i),
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
