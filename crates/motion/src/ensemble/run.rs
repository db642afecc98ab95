//! Members integrated in lanes, over threads; those that have to be, alone.

use std::cell::RefCell;
use std::sync::{Mutex, PoisonError};

use equations::{Compiled, Equations, LaneEquations, Plan};
use integrate::{
    Interrupt, LANES, Lane, LaneProblem, LaneStart, Options, ProjectionReport, Shortest, Start, Status, StopCause, Work,
};
use symbolic::caught;

use super::threads::{Take, shared};
use super::{Ensemble, EnsembleMember};
use crate::band::limits::UNITS;
use crate::band::perturbed_rates::perturbed_by_constants;
use crate::band::ulp_perturbation::move_digits;
use crate::lost_rank::column_factors;
use crate::metric::subtract;
use crate::single_run::SingleRun;
use crate::state_scales::sizes;
use crate::{Ending, Metric, Prepared, SolveError, TIGHTER};

/// How an ensemble is run.
#[derive(Clone, Copy, Debug)]
pub struct EnsembleOptions {
    /// Number of threads; 0: as many as there are processors. Results do not depend on it.
    pub threads: usize,
    /// Whether each member is run twice, at the tolerance and at [`TIGHTER`] times it, as single motions are,
    /// for [`MemberRun::differences`]. Otherwise only the tolerance tells its error.
    pub estimate: bool,
}

impl Default for EnsembleOptions {
    fn default() -> Self {
        EnsembleOptions { threads: 0, estimate: true }
    }
}

/// What became of a member.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MemberRun {
    /// The states at the times asked for, as far as the motion came.
    pub states: Vec<Vec<f64>>,
    /// States of the kept run minus those of the looser one at these times: what the looser run was wrong by,
    /// and a bound in practice for the kept one. Empty without [`EnsembleOptions::estimate`]. Of
    /// [`Ensemble::motions`] the looser run has round-off in its rates, where that is more.
    pub differences: Vec<Vec<f64>>,
    /// How it ended.
    pub ending: Ending,
    /// Work of the kept run. What a member had cost before it was integrated alone is not in it.
    pub work: Work,
    /// What projection did in the kept run.
    pub projection: ProjectionReport,
    /// Why the kept run was integrated alone, if it was.
    pub alone: Option<String>,
    /// Unknowns of the instant near these times, where its equations have several roots; otherwise empty.
    pub(super) unknowns: Vec<Vec<f64>>,
    /// Ends of the shortest steps of the kept run, and the states there.
    pub(super) shortest: Vec<(f64, Vec<f64>)>,
    /// Whether it stopped where its equations may be no good, and others might be.
    pub(super) left_chart: bool,
}

pub(super) type Outcome = Result<MemberRun, SolveError>;

impl Ensemble {
    /// Integrates `members`; states are read at `times`, in the order in which they are passed.
    ///
    /// The results are in the order of the members. Each is the same to the last bit whatever the other
    /// members, their order and the number of threads. An `Err` is a member that could not be started.
    pub fn run(&self, members: &[EnsembleMember], times: &[f64], options: &EnsembleOptions) -> Vec<Outcome> {
        let by = (&self.by_name.varying().prepared().compiled, self.lanes.as_ref());
        let run = |tolerance, origin| self.run_by(by, members, times, tolerance, origin, options.threads);
        let tolerance = self.settings.tolerance;
        if !options.estimate {
            return run(tolerance, Origin::Start);
        }
        let looser = run(tolerance, Origin::LastDigit);
        let kept = run(tolerance * TIGHTER, Origin::Start);
        let runs = kept.into_iter().zip(looser).zip(members);
        runs.map(|((kept, looser), member)| Ok(confirmed(kept?, looser?, member))).collect()
    }

    /// The looser runs of `members` once more, alone, with this round-off in their rates.
    pub(super) fn run_perturbed(
        &self,
        members: Vec<(&EnsembleMember, Vec<f64>)>,
        times: &[f64],
        threads: usize,
    ) -> Result<Vec<Outcome>, SolveError> {
        let Prepared { t, start, constants, .. } = self.by_name.varying().prepared();
        let parameters = constants.len() - self.by_name.varying().constants().len();
        let equations = perturbed_by_constants(self.equations(), parameters);
        let with = |constants: &[f64], offsets: &[f64]| {
            let (own, varied) = constants.split_at(constants.len() - parameters);
            [own, offsets, varied].concat()
        };
        let point = [&[*t], &start[..], &with(constants, &vec![0.0; 2 * start.len()])].concat();
        let plan = Plan::choose(&equations, Some(&point))?;
        let compiled = Compiled::with_plan(&equations, &plan)?.with_series(&equations, &plan)?;
        let perturbed = |(member, offsets): (&EnsembleMember, Vec<f64>)| EnsembleMember {
            constants: with(&member.constants, &offsets),
            ..member.clone()
        };
        let members: Vec<EnsembleMember> = members.into_iter().map(perturbed).collect();
        let why = String::from("round-off of its rates is put into them");
        let by = (&compiled, Err(&why));
        Ok(self.run_by(by, &members, times, self.settings.tolerance, Origin::LastDigit, threads))
    }

    /// By these equations, in company if they come in lanes, or else why not.
    fn run_by(
        &self,
        (compiled, lanes): (&Compiled, Result<&LaneEquations, &String>),
        members: &[EnsembleMember],
        times: &[f64],
        tolerance: f64,
        origin: Origin,
        threads: usize,
    ) -> Vec<Outcome> {
        let mut options = self.settings.options(tolerance);
        options.breakpoints.clone_from(&self.system.breakpoints);
        let task = Task {
            members,
            times,
            origin,
            options: &options,
            compiled,
            metric: &self.metric,
            lanes,
            words: &self.words,
            left: Mutex::default(),
        };
        let group = if task.lanes.is_ok() { LANES } else { 1 };
        let results = shared(threads, members.len(), group, |take| task.work(take));
        let interrupted = |member: &EnsembleMember| {
            let cause = options.interrupt.as_ref().and_then(Interrupt::cause).unwrap_or(StopCause::Interrupted);
            Ok(MemberRun { ending: Ending::Stopped { t: member.t, cause: cause.to_string() }, ..MemberRun::default() })
        };
        results.into_iter().zip(members).map(|(outcome, m)| outcome.unwrap_or_else(|| interrupted(m))).collect()
    }
}

/// The tighter run with what the looser one says of it.
fn confirmed(mut kept: MemberRun, looser: MemberRun, member: &EnsembleMember) -> MemberRun {
    kept.states.truncate(looser.states.len());
    kept.unknowns.truncate(looser.states.len());
    let pairs = kept.states.iter().zip(&looser.states);
    kept.differences = pairs.map(|(a, b)| subtract(a, b)).collect();
    kept.left_chart |= looser.left_chart;
    kept.ending = Ending::joint(kept.ending, looser.ending, [member.t, member.end]);
    kept
}

impl MemberRun {
    /// Where it stopped, if it did.
    pub(super) fn stopped(&self) -> Option<f64> {
        match self.ending {
            Ending::Stopped { t, .. } => Some(t),
            Ending::Completed => None,
        }
    }
}

/// Where members start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Origin {
    /// From their start.
    Start,
    /// From the start with its last digits changed, as [`crate::Prepared::second_run`] does.
    LastDigit,
}

/// Members to be integrated once, by whichever thread has a free lane.
struct Task<'a> {
    members: &'a [EnsembleMember],
    times: &'a [f64],
    origin: Origin,
    options: &'a Options,
    compiled: &'a Compiled,
    metric: &'a Metric,
    lanes: Result<&'a LaneEquations, &'a String>,
    words: &'a Mutex<Equations>,
    /// Those that have to go alone, and why: for whichever thread has no lanes to fill any more.
    left: Mutex<Vec<(usize, String)>>,
}

impl Task<'_> {
    fn work(&self, take: Take) -> Vec<(usize, Outcome)> {
        let mut compiled = self.compiled.clone();
        let mut done = Vec::new();
        match self.lanes {
            Err(why) => {
                while let Some(index) = take().filter(|_| !self.is_interrupted()) {
                    done.push((index, self.alone(&mut compiled, index, why.clone())));
                }
            }
            Ok(lanes) => loop {
                let under_way = RefCell::default();
                let work = || self.in_lanes(lanes.clone(), &mut compiled, take, &mut done, &under_way);
                let Err(broken) = caught("lanes", work) else { break };
                // which of them it was is seen where each is alone
                compiled = self.compiled.clone();
                let mut under_way: Vec<usize> = under_way.into_inner();
                if under_way.is_empty() {
                    let Some(next) = take() else { break };
                    under_way.push(next);
                }
                self.leave(under_way, &broken.to_string());
            },
        }
        while let Some((index, why)) = self.take_left() {
            done.push((index, self.alone(&mut compiled, index, why)));
        }
        done
    }

    /// Members in lanes until none is left to take; those that were begun and have not ended are `under_way`.
    fn in_lanes(
        &self,
        lanes: LaneEquations,
        compiled: &mut Compiled,
        take: Take,
        done: &mut Vec<(usize, Outcome)>,
        under_way: &RefCell<Vec<usize>>,
    ) {
        let n = lanes.dimension();
        let mut refused = Vec::new();
        let columns = match self.members.first() {
            Some(first) => {
                first.set(compiled);
                column_factors(compiled, &mut self.metric_of(first), first.t, &first.y)
            }
            None => Vec::new(),
        };
        let mut problem = Riders { lanes, members: self.members, columns };
        let mut next = || {
            loop {
                let index = take().filter(|_| !self.is_interrupted())?;
                under_way.borrow_mut().push(index);
                match self.start(compiled, index) {
                    Ok(start) => return Some((index, start)),
                    Err(error) => refused.push((index, Err(error))),
                }
            }
        };
        integrate::integrate_lanes(&mut problem, &mut next, self.times, self.options, &mut |index, outcome| {
            under_way.borrow_mut().retain(|&begun| begun != index);
            match outcome {
                Ok(run) => {
                    let states = run.states.chunks_exact(n).map(<[f64]>::to_vec).collect();
                    let (work, projection, shortest) = (run.work, run.projection, run.shortest.ends());
                    done.push((index, Ok(MemberRun { states, work, projection, shortest, ..MemberRun::default() })));
                }
                Err(why) => self.leave(vec![index], &why.to_string()),
            }
        });
        done.append(&mut refused);
    }

    fn leave(&self, indices: Vec<usize>, why: &str) {
        let mut left = self.left.lock().unwrap_or_else(PoisonError::into_inner);
        left.extend(indices.into_iter().map(|index| (index, why.to_owned())));
    }

    fn take_left(&self) -> Option<(usize, String)> {
        if self.is_interrupted() { None } else { self.left.lock().unwrap_or_else(PoisonError::into_inner).pop() }
    }

    fn is_interrupted(&self) -> bool {
        self.options.interrupt.as_ref().is_some_and(Interrupt::is_raised)
    }

    fn states(&self, index: usize) -> Vec<f64> {
        let mut y = self.members[index].y.clone();
        if self.origin == Origin::LastDigit {
            move_digits(&mut y, |_| UNITS);
        }
        y
    }

    fn metric_of(&self, member: &EnsembleMember) -> Metric {
        let mut metric = self.metric.clone();
        metric.set_parameters(&member.constants[member.constants.len() - metric.parameters()..]);
        metric
    }

    fn start(&self, compiled: &mut Compiled, index: usize) -> Result<LaneStart, SolveError> {
        let member = &self.members[index];
        let y = self.states(index);
        integrate::check_start(&Start { t: member.t, y: y.clone() }, member.end, self.options)?;
        member.set(compiled);
        let mut rates = vec![0.0; y.len()];
        compiled.rates(member.t, &y, &mut rates).map_err(SolveError::AtStart)?;
        let mut metric = self.metric_of(member);
        let sizes = sizes(compiled, &mut metric, member.t, &y, member.end - member.t);
        Ok(LaneStart { t: member.t, y, end: member.end, sizes })
    }

    fn alone(&self, compiled: &mut Compiled, index: usize, why: String) -> Outcome {
        caught("row", || self.run_alone(compiled, index, why)).unwrap_or_else(|broken| Err(broken.into()))
    }

    fn run_alone(&self, compiled: &mut Compiled, index: usize, why: String) -> Outcome {
        let member = &self.members[index];
        member.set(compiled);
        let start = Start { t: member.t, y: self.states(index) };
        let run = SingleRun::new(
            compiled,
            &mut self.metric_of(member),
            &start,
            member.end,
            self.options.clone(),
            (None, None),
        )?;
        let solution = &run.solution;
        let (reached, direction) = (run.end(), member.end - member.t);
        let passed = self.times.iter().take_while(|&&t| (t - reached) * direction <= 0.0);
        let states = passed.clone().map(|&t| {
            let mut y = vec![0.0; member.y.len()];
            solution.dense.evaluate(t, &mut y);
            y
        });
        let of_limits = |cause: &StopCause| {
            use StopCause::{Interrupted, Memory, TimeLimit, TooManySteps};
            matches!(cause, Interrupted | Memory { .. } | TimeLimit { .. } | TooManySteps { .. })
        };
        let stopped = matches!(&solution.status, Status::Stopped { cause, .. } if !of_limits(cause));
        let mut shortest = Shortest::default();
        for step in solution.dense.step_times().windows(2) {
            let state = || {
                let mut y = vec![0.0; member.y.len()];
                solution.dense.evaluate(step[1], &mut y);
                y
            };
            shortest.add((step[1] - step[0]).abs(), step[1], std::iter::once_with(state).flatten());
        }
        let words = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(MemberRun {
            states: states.collect(),
            unknowns: passed.filter_map(|&t| run.unknowns_near(t)).collect(),
            ending: Ending::of(&words, compiled, solution, &[]),
            work: solution.work,
            projection: solution.projection,
            shortest: shortest.ends(),
            alone: Some(why),
            left_chart: stopped && compiled.has_chart(),
            ..MemberRun::default()
        })
    }
}

/// Members in lanes, as the time integrator sees them.
struct Riders<'a> {
    lanes: LaneEquations,
    members: &'a [EnsembleMember],
    /// Factors of the columns of the constraints' rows.
    columns: Vec<f64>,
}

impl LaneProblem for Riders<'_> {
    fn dimension(&self) -> usize {
        self.lanes.dimension()
    }
    fn events(&self) -> usize {
        self.lanes.guards()
    }
    fn load(&mut self, lane: usize, member: usize) {
        self.lanes.set_constants(lane, &self.members[member].constants);
    }
    fn taylor(&mut self, t: &Lane, y: &[Lane], unit: &Lane, coefficients: &mut [Lane]) -> [bool; LANES] {
        self.lanes.taylor(t, y, unit, coefficients)
    }
    fn rates(&mut self, t: &Lane, y: &[Lane], rates: &mut [Lane]) {
        self.lanes.rates(t, y, rates);
    }
    fn project(&mut self, t: &Lane, y: &mut [Lane]) -> Lane {
        self.lanes.project(t, y)
    }
    fn event_values(&mut self, t: &Lane, y: &[Lane], values: &mut [Lane]) {
        self.lanes.guard_values(t, y, values);
    }
    fn divisors(&self) -> usize {
        self.lanes.divisors()
    }
    fn divided(&mut self, t: &Lane, y: &[Lane], values: &mut [Lane]) {
        self.lanes.divided(t, y, values);
    }
    fn rank(&self) -> (usize, usize) {
        self.lanes.rank()
    }
    fn rows(&mut self, t: &Lane, y: &[Lane], entries: &mut [Lane]) {
        self.lanes.rows(t, y, entries);
        for row in entries.chunks_mut(self.columns.len()) {
            row.iter_mut().zip(&self.columns).for_each(|(x, c)| x.iter_mut().for_each(|x| *x *= c));
        }
    }
}
