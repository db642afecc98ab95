//! Members integrated in lanes, over threads; those that have to be, alone.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use integrate::{Interrupt, LANES, Lane, LaneProblem, LaneStart, Options, ProjectionReport, Start, Work};
use mechanics::{Compiled, Equations, LaneEquations};

use super::{Ensemble, EnsembleMember};
use crate::motion::{ending, unconfirmed};
use crate::run::{Origin, Prepared, integrate_once, move_last_digits, sizes};
use crate::{Ending, SolveError, TIGHTER};

/// How an ensemble is run.
#[derive(Clone, Copy, Debug)]
pub struct EnsembleOptions {
    /// Number of threads; 0: as many as there are processors. Results do not depend on it.
    pub threads: usize,
    /// Whether each member is run twice, at the tolerance and at [`TIGHTER`] times it, as single motions are, for the sake of
    /// [`MemberRun::differences`]. Otherwise it is run at the tolerance, and nothing is known of its error but what that says.
    pub estimate: bool,
}

impl Default for EnsembleOptions {
    fn default() -> Self {
        EnsembleOptions { threads: 0, estimate: true }
    }
}

/// What became of a member.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberRun {
    /// The states at the times asked for, as far as the motion came.
    pub states: Vec<Vec<f64>>,
    /// States of the kept run minus those of the looser one at these times: what the looser run was wrong by, and a bound in practice for the kept one.
    /// Empty without [`EnsembleOptions::estimate`].
    pub differences: Vec<Vec<f64>>,
    /// How it ended.
    pub ending: Ending,
    /// Work of the kept run. What a member had cost before it was integrated alone is not in it.
    pub work: Work,
    /// What projection did in the kept run.
    pub projection: ProjectionReport,
    /// Why the kept run was integrated alone, if it was.
    pub alone: Option<String>,
}

type Outcome = Result<MemberRun, SolveError>;

impl Ensemble {
    /// Integrates `members`; states are read at `times`, which have to be in the order in which they are passed.
    ///
    /// The results are in the order of the members. Each is the same to the last bit whatever the other members, their order and the number of threads.
    /// An `Err` is a member that could not be started.
    pub fn run(&self, members: &[EnsembleMember], times: &[f64], options: &EnsembleOptions) -> Vec<Outcome> {
        let tolerance = self.settings.tolerance;
        if !options.estimate {
            return self.run_once(members, times, tolerance, Origin::Start, options.threads);
        }
        let looser = self.run_once(members, times, tolerance, Origin::LastDigit, options.threads);
        let kept = self.run_once(members, times, tolerance * TIGHTER, Origin::Start, options.threads);
        kept.into_iter().zip(looser).map(|(kept, looser)| Ok(confirmed(kept?, looser?))).collect()
    }

    fn run_once(
        &self,
        members: &[EnsembleMember],
        times: &[f64],
        tolerance: f64,
        origin: Origin,
        threads: usize,
    ) -> Vec<Outcome> {
        let settings = &self.settings;
        let mut options = Options::with_tolerance(tolerance);
        options.method = settings.method;
        options.projection = settings.projection;
        options.max_steps = settings.max_steps;
        options.interrupt = settings.interrupt.clone();
        let task = Task { members, times, origin, options: &options, next: AtomicUsize::new(0) };
        let threads = match threads {
            0 => std::thread::available_parallelism().map_or(1, usize::from),
            count => count,
        };
        let results: Vec<Mutex<Option<Outcome>>> = members.iter().map(|_| Mutex::new(None)).collect();
        if threads.min(members.len()) <= 1 {
            task.work(self.tools(), &results);
        } else {
            std::thread::scope(|scope| {
                for _ in 0..threads.min(members.len().div_ceil(LANES)) {
                    let tools = self.tools();
                    scope.spawn(|| task.work(tools, &results));
                }
            });
        }
        let interrupted = |member: &EnsembleMember| {
            let ending = Ending::Stopped { t: member.t, cause: integrate::StopCause::Interrupted.to_string() };
            Ok(MemberRun { ending, ..MemberRun::empty() })
        };
        let inner = |slot: Mutex<Option<Outcome>>| slot.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        results.into_iter().zip(members).map(|(slot, m)| inner(slot).unwrap_or_else(|| interrupted(m))).collect()
    }

    fn tools(&self) -> Tools {
        let Prepared { equations, compiled, .. } = &self.prepared;
        Tools { equations: equations.clone(), compiled: compiled.clone(), lanes: self.lanes.clone() }
    }
}

/// The tighter run with what the looser one says of it.
fn confirmed(mut kept: MemberRun, looser: MemberRun) -> MemberRun {
    kept.states.truncate(looser.states.len());
    let pairs = kept.states.iter().zip(&looser.states);
    kept.differences = pairs.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect();
    if let (Ending::Completed, Ending::Stopped { t, cause }) = (&kept.ending, looser.ending) {
        kept.ending = Ending::Stopped { t, cause: unconfirmed(&cause) };
    }
    kept
}

impl MemberRun {
    fn empty() -> Self {
        MemberRun {
            states: Vec::new(),
            differences: Vec::new(),
            ending: Ending::Completed,
            work: Work::default(),
            projection: ProjectionReport::default(),
            alone: None,
        }
    }
}

/// What a thread works with.
struct Tools {
    equations: Equations,
    compiled: Compiled,
    lanes: Result<LaneEquations, String>,
}

/// Members to be integrated once, taken by whichever thread has a free lane.
struct Task<'a> {
    members: &'a [EnsembleMember],
    times: &'a [f64],
    origin: Origin,
    options: &'a Options,
    next: AtomicUsize,
}

impl Task<'_> {
    fn work(&self, tools: Tools, results: &[Mutex<Option<Outcome>>]) {
        let put = |index: usize, outcome: Outcome| {
            *results[index].lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(outcome);
        };
        let Tools { equations, mut compiled, lanes } = tools;
        let mut left: Vec<(usize, String)> = Vec::new();
        match lanes {
            Err(why) => left.extend(std::iter::from_fn(|| self.take()).map(|index| (index, why.clone()))),
            Ok(lanes) => {
                let n = lanes.dimension();
                let mut problem = Riders { lanes, members: self.members };
                let mut next = || {
                    loop {
                        let index = self.take()?;
                        match self.start(&mut compiled, index) {
                            Ok(start) => return Some((index, start)),
                            Err(error) => put(index, Err(error)),
                        }
                    }
                };
                integrate::integrate_lanes(&mut problem, &mut next, self.times, self.options, &mut |index, outcome| {
                    match outcome {
                        Ok(run) => {
                            let states = run.states.chunks_exact(n).map(<[f64]>::to_vec).collect();
                            let (work, projection) = (run.work, run.projection);
                            put(index, Ok(MemberRun { states, work, projection, ..MemberRun::empty() }));
                        }
                        Err(why) => left.push((index, why.to_string())),
                    }
                });
            }
        }
        for (index, why) in left {
            if !self.is_interrupted() {
                put(index, self.alone(&equations, &mut compiled, index, why));
            }
        }
    }

    fn is_interrupted(&self) -> bool {
        self.options.interrupt.as_ref().is_some_and(Interrupt::is_raised)
    }

    fn take(&self) -> Option<usize> {
        let index = self.next.fetch_add(1, Ordering::Relaxed);
        (index < self.members.len() && !self.is_interrupted()).then_some(index)
    }

    fn states(&self, index: usize) -> Vec<f64> {
        let mut y = self.members[index].y.clone();
        if self.origin == Origin::LastDigit {
            move_last_digits(&mut y);
        }
        y
    }

    fn start(&self, compiled: &mut Compiled, index: usize) -> Result<LaneStart, SolveError> {
        let member = &self.members[index];
        let y = self.states(index);
        integrate::check_start(&Start { t: member.t, y: y.clone() }, member.end, self.options)?;
        member.set(compiled);
        let mut rates = vec![0.0; y.len()];
        compiled.rates(member.t, &y, &mut rates).map_err(SolveError::AtStart)?;
        let sizes = sizes(&y, &rates, member.end - member.t);
        Ok(LaneStart { t: member.t, y, end: member.end, sizes })
    }

    fn alone(&self, equations: &Equations, compiled: &mut Compiled, index: usize, why: String) -> Outcome {
        let member = &self.members[index];
        member.set(compiled);
        let start = Start { t: member.t, y: self.states(index) };
        let run = integrate_once(compiled, start, member.end, self.options)?;
        let solution = &run.solution;
        let (reached, direction) = (solution.dense.end(), member.end - member.t);
        let passed = self.times.iter().take_while(|&&t| (t - reached) * direction <= 0.0);
        let states = passed.map(|&t| {
            let mut y = vec![0.0; member.y.len()];
            solution.dense.evaluate(t, &mut y);
            y
        });
        Ok(MemberRun {
            states: states.collect(),
            ending: ending(equations, compiled, solution),
            work: solution.work,
            projection: solution.projection,
            alone: Some(why),
            ..MemberRun::empty()
        })
    }
}

/// Members in lanes, as the time integrator sees them.
struct Riders<'a> {
    lanes: LaneEquations,
    members: &'a [EnsembleMember],
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
    fn project(&mut self, t: &Lane, y: &mut [Lane]) -> Lane {
        self.lanes.project(t, y)
    }
    fn event_values(&mut self, t: &Lane, y: &[Lane], values: &mut [Lane]) {
        self.lanes.guard_values(t, y, values);
    }
}
