//! Many motions of one problem at once by Taylor series, eight at a time, one per lane.
//!
//! Each lane has a time, a step and an end of its own, chosen as [`crate::Method::Taylor`] chooses them for a
//! single motion; a lane whose motion is complete goes on with the next one. Lanes do not know of each other:
//! what comes out for a motion is the same to the last bit, whichever motions run beside it.
//!
//! [`crate::integrate`] takes over, as every lane would wait, where the problem does not trust the rates, a
//! coefficient is not finite, an event function may vanish, or steps get too short or too many: all rare.

mod defect_check;
mod divisor_zeros;
mod events;
mod problem;
mod rank;

use std::array::from_fn;

use crate::interrupt::Interrupt;
use crate::options::{Options, Projection};
use crate::stall_detector::StallDetector;
use crate::status::{ProjectionReport, Work};
use crate::stepper::shortest_step;
use crate::taylor_step::{Ends, each, longest_step, once, order};
use crate::time_loop::HALVINGS;
use defect_check::finite;
use divisor_zeros::LaneDivisorZeros;
use events::Events;
pub use problem::{LANES, Lane, LaneProblem, LaneRun, LaneStart, Left, Shortest};
use rank::Ranks;

/// Takes a member and what became of it.
type Done<'a> = &'a mut dyn FnMut(usize, Result<LaneRun, Left>);

/// One motion under way.
#[derive(Clone, Debug)]
struct Rider {
    member: usize,
    end: f64,
    /// Its series starts a motion: no step leads to it.
    fresh: bool,
    failures: usize,
    stall: StallDetector,
    /// Times that have been passed.
    read: usize,
    run: LaneRun,
}

struct Lanes<'a, P> {
    problem: &'a mut P,
    times: &'a [f64],
    options: &'a Options,
    orders: usize,
    riders: [Option<Rider>; LANES],
    t: Lane,
    unit: Lane,
    coefficients: Vec<Lane>,
    next_unit: Lane,
    next_coefficients: Vec<Lane>,
    absolute_tolerances: Vec<Lane>,
    sizes: Vec<Lane>,
    powers: Vec<Lane>,
    step: Lane,
    taken: Lane,
    taken_to: Lane,
    candidate: Vec<Lane>,
    reached: Vec<Lane>,
    slope: Vec<Lane>,
    moved: Lane,
    trusted: [bool; LANES],
    finite: [bool; LANES],
    smooth: [bool; LANES],
    inner: Vec<Lane>,
    inner_slope: Vec<Lane>,
    inner_rates: Vec<Lane>,
    events: Events,
    poles: LaneDivisorZeros,
    ranks: Ranks,
}

/// Integrates the motions that `next` names (with their starts) until it names none, by Taylor series to the
/// tolerances of `options`. `done` gets each, with its states at the `times` passed or why it was left.
///
/// `options` must suit [`crate::integrate`]; their sizes, breakpoints and what they say of dense output do
/// not count.
pub fn integrate_lanes<P: LaneProblem>(
    problem: &mut P,
    next: &mut dyn FnMut() -> Option<(usize, LaneStart)>,
    times: &[f64],
    options: &Options,
    done: Done,
) {
    let mut lanes = Lanes::new(problem, times, options);
    loop {
        for lane in 0..LANES {
            if lanes.riders[lane].is_none()
                && let Some((member, start)) = next()
            {
                lanes.board(lane, member, &start);
            }
        }
        if lanes.riders.iter().all(Option::is_none) {
            return;
        }
        if options.interrupt.as_ref().is_some_and(Interrupt::is_raised) {
            for lane in 0..LANES {
                lanes.leave(lane, Left::Interrupted, done);
            }
            return;
        }
        lanes.expand();
        lanes.look_at_events();
        lanes.check_defects();
        lanes.look_at_rank();
        let adopted = from_fn(|lane| lanes.judge(lane, done));
        lanes.adopt(&adopted);
        lanes.adopt_events(&adopted);
        lanes.poles.adopt(&adopted);
        lanes.ranks.adopt(&adopted);
        for lane in 0..LANES {
            lanes.choose(lane, done);
        }
        lanes.advance();
    }
}

impl<'a, P: LaneProblem> Lanes<'a, P> {
    fn new(problem: &'a mut P, times: &'a [f64], options: &'a Options) -> Self {
        let (n, orders, events) = (problem.dimension(), order(options.relative_tolerance) + 1, problem.events());
        let (zeros, divisors) = (|count: usize| vec![[0.0; LANES]; count], problem.divisors());
        let rank = problem.rank();
        Lanes {
            problem,
            times,
            options,
            orders,
            riders: from_fn(|_| None),
            t: [0.0; LANES],
            unit: [1.0; LANES],
            coefficients: zeros(n * orders),
            next_unit: [1.0; LANES],
            next_coefficients: zeros(n * orders),
            absolute_tolerances: vec![[1.0; LANES]; n],
            sizes: zeros(orders),
            powers: zeros(orders),
            step: [0.0; LANES],
            taken: [0.0; LANES],
            taken_to: [0.0; LANES],
            candidate: zeros(n),
            reached: zeros(n),
            slope: zeros(n),
            moved: [0.0; LANES],
            trusted: [true; LANES],
            finite: [true; LANES],
            smooth: [true; LANES],
            inner: zeros(n),
            inner_slope: zeros(n),
            inner_rates: zeros(n),
            events: Events::new(events),
            poles: LaneDivisorZeros::new(divisors),
            ranks: Ranks::new(rank),
        }
    }

    fn board(&mut self, lane: usize, member: usize, start: &LaneStart) {
        self.problem.load(lane, member);
        (self.t[lane], self.taken_to[lane]) = (start.t, start.t);
        (self.taken[lane], self.moved[lane]) = (0.0, 0.0);
        self.next_unit[lane] = (start.end - start.t).abs();
        self.events.board(lane);
        self.ranks.board(lane);
        for (i, y) in start.y.iter().enumerate() {
            self.candidate[i][lane] = *y;
            self.reached[i][lane] = *y;
            self.slope[i][lane] = 0.0;
            self.absolute_tolerances[i][lane] = self.options.absolute_tolerance_of(start.sizes[i]);
        }
        let states = Vec::with_capacity(self.times.len() * start.y.len());
        let (work, projection, shortest) = (Work::default(), ProjectionReport::default(), Shortest::default());
        let run = LaneRun { states, work, projection, shortest };
        let stall = StallDetector::new(start.t, start.end);
        self.riders[lane] = Some(Rider { member, end: start.end, fresh: true, failures: 0, stall, read: 0, run });
    }

    /// The coefficients at the ends of the candidates, and all that tells whether these are to be kept.
    fn expand(&mut self) {
        let problem = &mut *self.problem;
        self.trusted = problem.taylor(&self.taken_to, &self.candidate, &self.next_unit, &mut self.next_coefficients);
        let (coefficients, share) = (&self.next_coefficients, each(|l| self.taken[l] / self.next_unit[l]));
        let (reached, candidate, slope) = (&self.reached, &self.candidate, &self.slope);
        let ends = Ends { reached, candidate, slope, next_coefficients: coefficients, share };
        let (absolute, relative) = (&self.absolute_tolerances, self.options.relative_tolerance);
        (self.finite, self.smooth) = pulp::Arch::new().dispatch(
            #[inline(always)]
            move || {
                let ends = once(ends);
                let defect = ends.defect(absolute, relative);
                (finite(coefficients), each(|l| defect.component(l).is_none() && !defect.is_far(l)))
            },
        );
    }

    /// Whether the lane goes on from its candidate: not if its motion is over or left, or the step too long.
    fn judge(&mut self, lane: usize, done: Done) -> bool {
        let Some(rider) = &mut self.riders[lane] else { return false };
        if self.finite[lane] {
            rider.run.work.evaluations += 1;
            rider.run.work.orders += self.orders - 1;
        }
        if !self.trusted[lane] || self.moved[lane].is_nan() {
            return self.leave(lane, Left::Untrusted, done);
        }
        if !self.finite[lane] {
            return self.leave(lane, Left::NotFinite, done);
        }
        if rider.fresh {
            rider.fresh = false;
            self.read(lane);
            return true;
        }
        if !self.smooth[lane] {
            rider.failures += 1;
            rider.run.work.rejected += 1;
            self.step[lane] = 0.5 * self.taken[lane].abs();
            return if rider.failures > HALVINGS { self.leave(lane, Left::StepTooSmall, done) } else { false };
        }
        if self.ranks.suspected[lane] {
            return self.leave(lane, Left::Rank, done);
        }
        if !self.events.none[lane] || self.poles.suspected[lane] {
            let why = if self.events.none[lane] { Left::Divisor } else { Left::Event };
            return self.leave(lane, why, done);
        }
        rider.failures = 0;
        rider.run.work.steps += 1;
        let end = self.candidate.iter().map(|y| y[lane]);
        rider.run.shortest.add(self.taken[lane].abs(), self.taken_to[lane], end);
        if self.options.projection == Projection::EveryStep {
            rider.run.projection.record(self.moved[lane]);
        }
        self.read(lane);
        let complete = self.riders[lane].take_if(|rider| self.taken_to[lane] == rider.end);
        if let Some(rider) = complete {
            done(rider.member, Ok(rider.run));
            self.park(lane);
            return false;
        }
        true
    }

    fn leave(&mut self, lane: usize, why: Left, done: Done) -> bool {
        if let Some(rider) = self.riders[lane].take() {
            done(rider.member, Err(why));
            self.park(lane);
        }
        false
    }

    /// What is computed in an idle lane counts for nothing.
    fn park(&mut self, lane: usize) {
        for row in [&mut self.candidate, &mut self.reached, &mut self.slope, &mut self.coefficients] {
            row.iter_mut().for_each(|x| x[lane] = 0.0);
        }
        (self.taken[lane], self.step[lane]) = (0.0, 0.0);
    }

    /// The states at those times that the step passes.
    fn read(&mut self, lane: usize) {
        let (from, to) = (self.t[lane], self.taken_to[lane]);
        let Some(rider) = &mut self.riders[lane] else { return };
        while let Some(&time) = self.times.get(rider.read)
            && (time - to) * (rider.end - from) <= 0.0
        {
            rider.read += 1;
            let ends = self.reached.iter().zip(&self.candidate);
            if time == to || from == to {
                rider.run.states.extend(ends.map(|(_, y)| y[lane]));
                continue;
            }
            let (share, theta) = ((time - from) / self.unit[lane], (time - from) / self.taken[lane]);
            let last = theta.powi(self.orders as i32 - 1);
            let rows = self.coefficients.chunks_exact(self.orders);
            rider.run.states.extend(rows.zip(ends).map(|(row, (reached, y))| {
                let sum = row.iter().rev().fold(0.0, |sum, c| c[lane] + share * sum);
                sum + last * (y[lane] - reached[lane])
            }));
        }
    }

    /// Goes on from the candidates of these lanes, whose steps are chosen from their coefficients.
    fn adopt(&mut self, lanes: &[bool; LANES]) {
        let (coefficients, next) = (&mut self.coefficients, &self.next_coefficients);
        let (absolute, relative, sizes) = (&self.absolute_tolerances, self.options.relative_tolerance, &mut self.sizes);
        if lanes.contains(&false) {
            for (c, next) in coefficients.iter_mut().zip(next) {
                *c = each(|l| if lanes[l] { next[l] } else { c[l] });
            }
        } else {
            std::mem::swap(coefficients, &mut self.next_coefficients);
        }
        let theta = pulp::Arch::new().dispatch(
            #[inline(always)]
            move || {
                let sizes = once(sizes);
                longest_step(coefficients, absolute, relative, sizes)
            },
        );
        for l in (0..LANES).filter(|&l| lanes[l]) {
            (self.t[l], self.unit[l]) = (self.taken_to[l], self.next_unit[l]);
            self.step[l] = theta[l] * self.unit[l];
        }
    }

    /// The next step of a lane.
    fn choose(&mut self, lane: usize, done: Done) {
        let Some(rider) = &mut self.riders[lane] else { return };
        let (t, step) = (self.t[lane], self.step[lane].min(self.options.max_step));
        let remaining = rider.end - t;
        let last = step >= remaining.abs();
        let (work, limit) = (&rider.run.work, self.options.max_steps);
        let attempts = work.steps + work.rejected;
        let creeps = rider.stall.look(t, [work.steps, attempts, limit], || false).is_some();
        if attempts >= limit {
            self.leave(lane, Left::TooManySteps, done);
        } else if !last && (creeps || step <= shortest_step(t) || step.is_nan()) {
            self.leave(lane, Left::StepTooSmall, done);
        } else {
            self.taken_to[lane] = if last { rider.end } else { t + step * remaining.signum() };
            self.taken[lane] = self.taken_to[lane] - t;
            self.next_unit[lane] = self.taken[lane].abs();
        }
    }

    /// The states inside the step, at this share of the unit of time.
    fn look_inside(&mut self, share: &Lane) {
        let rows = self.inner.iter_mut().zip(self.coefficients.chunks_exact(self.orders));
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || {
                for (y, row) in once(rows) {
                    *y = [0.0; LANES];
                    for c in row.iter().rev() {
                        *y = each(|l| c[l] + share[l] * y[l]);
                    }
                }
            },
        );
    }

    /// The candidates: the polynomials at the ends of the steps, projected.
    fn advance(&mut self) {
        let theta: Lane = each(|l| self.taken[l] / self.unit[l]);
        let (powers, coefficients) = (&mut self.powers, &self.coefficients);
        let (reached, slope) = (&mut self.reached, &mut self.slope);
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || {
                let powers = once(powers);
                evaluate(coefficients, &theta, powers, reached, slope);
            },
        );
        self.candidate.copy_from_slice(&self.reached);
        if self.options.projection == Projection::EveryStep {
            self.moved = self.problem.project(&self.taken_to, &mut self.candidate);
        }
    }
}

/// Values of the polynomials, and their slopes times `theta`.
#[inline(always)]
fn evaluate(coefficients: &[Lane], theta: &Lane, powers: &mut [Lane], values: &mut [Lane], slopes: &mut [Lane]) {
    let mut power = [1.0; LANES];
    for x in powers.iter_mut() {
        *x = power;
        power = each(|l| power[l] * theta[l]);
    }
    let rows = coefficients.chunks_exact(powers.len());
    for ((row, value), slope) in rows.zip(values).zip(slopes) {
        let (mut sum, mut weighted) = ([0.0; LANES], [0.0; LANES]);
        for ((c, power), k) in row.iter().zip(&*powers).zip(0..).skip(1) {
            let k = f64::from(k);
            for l in 0..LANES {
                let term = c[l] * power[l];
                sum[l] += term;
                weighted[l] += term * k;
            }
        }
        *value = each(|l| row[0][l] + sum[l]);
        *slope = weighted;
    }
}
