//! The one time loop: every method, forwards and backwards, with events, projection, checks and counters.

use crate::dense::{Basis, DenseOutput, evaluate_segment};
use crate::divisor_zeros::DivisorZeros;
use crate::events::{EventWatch, Found, Segment};
use crate::options::{Dense, Options, Projection};
use crate::problem::Start;
use crate::rank::{Lost, RankWatch};
use crate::stall_detector::StallDetector;
use crate::status::{ProjectionReport, Solution, Status, StopCause};
use crate::step_resolution::StepResolution;
use crate::stepper::{Attempt, Stepper};
use crate::system::{Failure, System, check_finite};
use crate::taylor_step::{DEFECT, LEAST_RELATIVE};

/// Maximum number of consecutive halvings of a step that cannot be evaluated.
pub(crate) const HALVINGS: usize = 60;
/// After this many consecutive steps refused for the move of their projection, a move that is over half the
/// last one is allowed.
const PERSISTENT: usize = 6;
/// No move is allowed that is over this part of a state: it leads to another branch of the manifold.
const JUMP: f64 = 0.05;

/// Integrates `system` from `start` to `end` with `stepper`, or reports that it could not be set up.
pub fn drive<S: Stepper>(
    system: &System,
    stepper: Result<S, impl Into<StopCause>>,
    start: &Start,
    end: f64,
    options: &Options,
) -> Solution {
    match stepper {
        Ok(mut stepper) => run(system, Ok(&mut stepper), start, end, options),
        Err(cause) => run(system, Err(cause.into()), start, end, options),
    }
}

/// [`drive`] with any stepper.
pub fn run(
    system: &System,
    stepper: Result<&mut dyn Stepper, StopCause>,
    start: &Start,
    end: f64,
    options: &Options,
) -> Solution {
    let (basis, degree) = stepper.as_ref().map_or((Basis::Nested, 1), |stepper| (stepper.basis(), stepper.degree()));
    let mut record = Record {
        system,
        dense: DenseOutput::new(start.t, &start.y, basis, degree, options.wanted.clone()),
        projection: options.before.as_ref().map_or(ProjectionReport::default(), |before| before.projection),
        stall: options.before.clone().map_or(StallDetector::new(start.t, end), |before| before.stall.on_to(end)),
        absolute: options.absolute_tolerances(start.y.len()),
        before: Vec::new(),
        moves: Moves { allowed: 1.0, last: f64::INFINITY, shorter: 0 },
        options,
    };
    let status = match stepper.and_then(|stepper| record.begin(stepper, start, end)) {
        Ok(()) => Status::Completed,
        Err(cause) => Status::Stopped { t: record.dense.end(), cause },
    };
    let Record { dense, projection, stall, .. } = record;
    Solution { status, dense, work: system.work(), projection, stall }
}

/// The solution so far, with its counters.
struct Record<'a, 'p> {
    system: &'a System<'p>,
    dense: DenseOutput,
    projection: ProjectionReport,
    stall: StallDetector,
    absolute: Vec<f64>,
    /// The candidate before it was projected.
    before: Vec<f64>,
    moves: Moves,
    options: &'a Options,
}

/// Checks inside of steps.
struct Inside {
    steep: StepResolution,
    poles: DivisorZeros,
    rank: RankWatch,
}

/// Moves of projections, relative to the allowed error of a step.
struct Moves {
    /// The largest move that is allowed.
    allowed: f64,
    /// The move of the last attempt, and the number of consecutive attempts refused for their move.
    last: f64,
    shorter: usize,
}

impl Record<'_, '_> {
    fn begin(&mut self, stepper: &mut dyn Stepper, start: &Start, end: f64) -> Result<(), StopCause> {
        let system = self.system;
        let mut inside = Inside {
            steep: StepResolution::new(system, start.t, &start.y)?,
            poles: DivisorZeros::new(system, start.t, &start.y, self.options)?,
            rank: RankWatch::new(system, start.t, &start.y, self.options)?,
        };
        self.walk(stepper, start, end, &mut inside).map_err(|cause| match cause {
            StopCause::Evaluation { .. }
            | StopCause::NotFinite { .. }
            | StopCause::NotSmooth { .. }
            | StopCause::OffConstraint { .. }
            | StopCause::StepTooSmall { .. }
            | StopCause::Creeping { .. }
                if inside.rank.is_near() =>
            {
                StopCause::LosesRank
            }
            cause => cause,
        })
    }

    fn walk(
        &mut self,
        stepper: &mut dyn Stepper,
        start: &Start,
        end: f64,
        inside: &mut Inside,
    ) -> Result<(), StopCause> {
        let system = self.system;
        let mut watch = EventWatch::new(system, start.t, &start.y)?;
        // The last failure since the last accepted step, and the number of them.
        let mut failure: Option<Failure> = None;
        let mut failures = 0;
        while stepper.time() != end {
            let work = system.work();
            let (t, interrupt) = (stepper.time(), self.options.interrupt.as_ref());
            if let Some(cause) = interrupt.and_then(|interrupt| interrupt.pass(t, work.steps)) {
                return Err(cause);
            }
            let (attempts, limit) = (work.steps + work.rejected, self.options.max_steps);
            if attempts >= limit {
                return Err(StopCause::TooManySteps { limit });
            }
            if let Some((steps, moved)) = self.stall.look(t, [work.steps, attempts, limit], || inside.rank.is_near()) {
                return Err(StopCause::Creeping { steps, moved });
            }
            // no other method gets past a loss of rank
            if let Some((ahead, moved)) = self.stall.is_over(self.options.patience)
                && !inside.rank.is_near()
            {
                return Err(StopCause::Slow { ahead, moved });
            }
            if self.options.dense == Dense::Everywhere {
                self.dense.has_memory().map_err(|bytes| StopCause::Memory { bytes })?;
            }
            let accepted = match stepper.attempt() {
                Attempt::Candidate { t, rejected } => {
                    system.count_rejected(rejected);
                    self.take(stepper, &mut watch, inside, t)
                }
                Attempt::Rejected => {
                    system.count_rejected(1);
                    continue;
                }
                Attempt::Failed(failure) => Err(failure),
                Attempt::GaveUp(cause) => return Err(failure.map_or(cause, StopCause::from)),
            };
            match accepted {
                Ok(None) => {
                    stepper.advance()?;
                    watch.advance();
                    inside.steep.advance();
                    inside.poles.advance();
                    inside.rank.advance();
                    (failure, failures) = (None, 0);
                }
                Ok(Some(cause)) => return Err(cause),
                Err(error) => {
                    system.count_rejected(1);
                    failures += 1;
                    if failures > HALVINGS || stepper.shrink().is_err() {
                        return Err(error.into());
                    }
                    failure = Some(error);
                }
            }
        }
        Ok(())
    }

    /// A step's error is about the tolerance: a step whose projection moves the state much farther hides
    /// another error, and is refused. A move that shorter steps do not reduce is round-off of nearly
    /// dependent constraints, and is allowed from then on. With a multistep method every move is allowed:
    /// several steps may have added it up.
    fn check_move(&mut self, candidate: &[f64]) -> Result<(), Failure> {
        let relative = self.options.relative_tolerance.max(LEAST_RELATIVE);
        let (mut component, mut worst) = (0, 0.0);
        for (i, (y, before)) in candidate.iter().zip(&self.before).enumerate() {
            let allowed = DEFECT * (self.absolute[i] + relative * y.abs().max(before.abs()));
            let part = (y - before).abs() / allowed;
            if part > worst {
                (component, worst) = (i, part);
            }
        }
        let Moves { allowed, last, shorter } = &mut self.moves;
        if worst * DEFECT * relative > JUMP {
            return Err(Failure::OffConstraint { component });
        }
        if worst <= *allowed || self.options.method.is_multistep() {
            *shorter = 0;
            return Ok(());
        }
        *shorter += 1;
        if *shorter > PERSISTENT && worst > 0.5 * *last {
            (*allowed, *shorter) = (4.0 * worst, 0);
            return Ok(());
        }
        *last = worst;
        Err(Failure::OffConstraint { component })
    }

    /// Checks, projects and stores the candidate that ends at `t`; returns what cuts it short.
    fn take(
        &mut self,
        stepper: &mut dyn Stepper,
        watch: &mut EventWatch,
        inside: &mut Inside,
        t: f64,
    ) -> Result<Option<StopCause>, Failure> {
        let begin = stepper.time();
        let candidate = stepper.candidate();
        check_finite(candidate)?;
        let mut moved = None;
        if self.options.projection == Projection::EveryStep {
            self.before.clear();
            self.before.extend_from_slice(candidate);
            moved = Some(self.system.project(t, candidate)?);
            self.check_move(candidate)?;
        }
        let watching = self.system.events() > 0;
        let looks = inside.steep.is_on() || inside.poles.is_on() || inside.rank.is_on();
        let has_room = watching || looks || self.options.dense == Dense::Everywhere;
        let room = if has_room { Some(self.dense.room()) } else { None };
        let found = stepper.finish(moved.is_some_and(|length| length != 0.0), room).and_then(|()| {
            if !watching && !looks {
                return Ok(None);
            }
            let coefficients = self.dense.last_room();
            let segment = Segment { basis: self.dense.basis(), coefficients, begin, width: t - begin, end: t };
            inside.steep.look(self.system, &segment)?;
            inside.poles.look(self.system, &segment, stepper.candidate())?;
            let lost = inside.rank.look(self.system, &segment, stepper.candidate())?;
            let event = if watching { watch.look(self.system, &segment)? } else { None };
            Ok(first(lost, event).map(|(cause, theta)| (cause, theta, segment.time(theta))))
        });
        let found = found.and_then(|found| self.system.accepted(t, stepper.candidate()).map(|()| found));
        if found.is_err() && has_room {
            self.dense.pop_room();
        }
        let found = found?;
        let mut end = t;
        if let Some((StopCause::LosesRank, 0.0, _)) = found {
            if has_room {
                self.dense.pop_room();
            }
            return Ok(Some(StopCause::LosesRank));
        }
        if let Some((_, theta, t_event)) = found {
            let mut state = vec![0.0; self.dense.dimension()];
            evaluate_segment(self.dense.basis(), self.dense.last_room(), theta, &mut state);
            stepper.candidate().copy_from_slice(&state);
            end = t_event;
        }
        if has_room && self.options.dense == Dense::EndOnly {
            self.dense.pop_room();
        }
        self.dense.push(begin, t - begin, end, stepper.candidate());
        self.system.count_step();
        if let Some(length) = moved {
            self.projection.record(length);
        }
        Ok(found.map(|(cause, ..)| cause))
    }
}

/// What comes first in a step, and in which part of it; at 0 the step is not taken. An event that is hardly
/// before a loss of rank is that: pivots vanish with the rows that they are taken from.
fn first(lost: Option<Lost>, event: Option<Found>) -> Option<(StopCause, f64)> {
    const HARDLY: f64 = 1e-3;
    match (lost, event) {
        (Some(Lost::Before), _) => Some((StopCause::LosesRank, 0.0)),
        (Some(Lost::Inside(theta)), event) if event.as_ref().is_none_or(|event| event.theta > theta - HARDLY) => {
            Some((StopCause::LosesRank, theta))
        }
        (_, event) => event.map(|Found { index, theta }| (StopCause::Event { index }, theta)),
    }
}
