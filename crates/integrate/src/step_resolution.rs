//! Detects functions that are switched on and off within a step.
//!
//! A method knows its rates at a few points of a step. A function that is constant at all of these may still
//! change between them: a force for half a second within a step of ten. So the arguments of such functions,
//! which are smooth, are evaluated on the step's polynomial at five points, or at nine where five do not
//! suffice, and a step is refused along which a function's gauge ([`crate::Problem::gauges`]) grows by more
//! than [`GAUGE_LIMIT`]: the method has to look closer. So is one along which it would if arguments were off
//! by their round-off, and a first step along whose tangent it would: a polynomial that does not have the
//! rates of the start as its slope there, as that of an implicit method, may miss what follows from them.

use crate::dense::Basis;
use crate::events::Segment;
use crate::limits::{HUGE, ROUNDINGS};
use crate::problem::Gauge;
use crate::system::{Failure, System};

/// Maximum growth of a gauge along one step.
pub const GAUGE_LIMIT: f64 = 4.0;
/// Number of equidistant places, ends included, at which arguments are evaluated; every other one first.
pub const GAUGE_NODES: usize = 9;
/// Number of parts in which the polynomial through these is sampled.
const PARTS: usize = 16;
/// Round-off of differences of arguments, in parts of the largest argument.
const ARGUMENT_DIGITS: f64 = 64.0 * f64::EPSILON;

/// Arguments of gauges, at the time reached and along the step.
pub(crate) struct StepResolution {
    gauges: Vec<Gauge>,
    along: [Vec<f64>; GAUGE_NODES],
    state: Vec<f64>,
    /// What is added up to arguments at a place, and the largest such sums along the step.
    terms: Vec<f64>,
    most: Vec<f64>,
    /// Whether no step has been accepted.
    at_start: bool,
}

impl StepResolution {
    pub(crate) fn new(system: &System, t: f64, y: &[f64]) -> Result<Self, Failure> {
        let gauges = system.gauges();
        let mut along = std::array::from_fn(|_| vec![0.0; gauges.len()]);
        if !gauges.is_empty() {
            system.gauged(t, y, &mut along[0])?;
        }
        let (terms, most) = (vec![0.0; gauges.len()], vec![0.0; gauges.len()]);
        Ok(StepResolution { gauges, along, state: vec![0.0; y.len()], terms, most, at_start: true })
    }

    pub(crate) fn is_on(&self) -> bool {
        !self.gauges.is_empty()
    }

    /// Refuses a step along which a gauge grows by more than [`GAUGE_LIMIT`].
    pub(crate) fn look(&mut self, system: &System, segment: &Segment) -> Result<(), Failure> {
        if !self.is_on() {
            return Ok(());
        }
        if self.at_start && segment.basis == Basis::Nested {
            self.look_along_tangent(system, segment)?;
        }
        let along = |theta: f64, y: &mut [f64]| segment.state(theta, y);
        self.read(system, segment, 2, &along)?;
        if (0..self.gauges.len()).all(|j| is_flat(self.gauges[j], &self.arguments(j))) {
            return Ok(());
        }
        self.read(system, segment, 1, &along)?;
        self.refuse_growth(segment)?;
        self.most.fill(0.0);
        for theta in [0.0, 0.5, 1.0] {
            segment.state(theta, &mut self.state);
            system.terms_of_gauged(segment.time(theta), &self.state, &mut self.terms)?;
            self.most.iter_mut().zip(&self.terms).for_each(|(most, terms)| *most = most.max(*terms));
        }
        let is_blurred = |j: usize| {
            growth(self.gauges[j], &self.arguments(j), ROUNDINGS * f64::EPSILON * self.most[j]) > GAUGE_LIMIT
        };
        match (0..self.gauges.len()).any(is_blurred) {
            true => Err(Failure::Blurred { t: segment.begin }),
            false => Ok(()),
        }
    }

    /// Refuses a step along whose tangent at the start a gauge grows as much, as far as that has arguments.
    fn look_along_tangent(&mut self, system: &System, segment: &Segment) -> Result<(), Failure> {
        let [mut start, mut rates] = [(); 2].map(|()| vec![0.0; self.state.len()]);
        segment.state(0.0, &mut start);
        system.rates(segment.begin, &start, &mut rates)?;
        let along = |theta: f64, y: &mut [f64]| {
            let tangent = start.iter().zip(&rates).map(|(y, rate)| y + theta * segment.width * rate);
            y.iter_mut().zip(tangent).for_each(|(y, there)| *y = there);
        };
        match [1, 2].into_iter().try_for_each(|first| self.read(system, segment, first, &along)) {
            Ok(()) => self.refuse_growth(segment),
            Err(_) => Ok(()),
        }
    }

    /// The arguments at every second place behind the start, or at those between, of states along a way.
    fn read(
        &mut self,
        system: &System,
        segment: &Segment,
        first: usize,
        along: &impl Fn(f64, &mut [f64]),
    ) -> Result<(), Failure> {
        for k in (first..GAUGE_NODES).step_by(2) {
            let theta = k as f64 / (GAUGE_NODES - 1) as f64;
            along(theta, &mut self.state);
            system.gauged(segment.time(theta), &self.state, &mut self.along[k])?;
        }
        Ok(())
    }

    /// Refuses a step along which a gauge grows too much, by the arguments read.
    fn refuse_growth(&self, segment: &Segment) -> Result<(), Failure> {
        match (0..self.gauges.len()).any(|j| gauge_growth(self.gauges[j], &self.arguments(j)) > GAUGE_LIMIT) {
            true => Err(Failure::Steep { t: segment.begin }),
            false => Ok(()),
        }
    }

    fn arguments(&self, gauge: usize) -> [f64; GAUGE_NODES] {
        std::array::from_fn(|k| self.along[k][gauge])
    }

    pub(crate) fn advance(&mut self) {
        self.along.swap(0, GAUGE_NODES - 1);
        self.at_start = false;
    }
}

fn every_other(x: &[f64; GAUGE_NODES]) -> [f64; GAUGE_NODES / 2 + 1] {
    std::array::from_fn(|k| x[2 * k])
}

/// Whether no polynomial through every other of these makes the gauge grow, or nearly so.
fn is_flat(gauge: Gauge, x: &[f64; GAUGE_NODES]) -> bool {
    let (low, high) = ends(every_other(x).map(bounded).into_iter());
    let margin = high - low;
    gauge(high + margin) - gauge(low - margin) <= GAUGE_LIMIT
}

/// How much a gauge grows between the least and the largest value of the polynomial through `x`, which are
/// arguments at equal distances, and as far beyond them as that through every other one misses the rest.
///
/// At least that where it is over [`GAUGE_LIMIT`]; infinite where an argument is NaN.
///
/// ```
/// use integrate::{GAUGE_NODES, gauge_growth};
/// // a bell a hundredth of a step wide, at its middle
/// let bell = std::array::from_fn(|k| -(100.0 * (k as f64 / (GAUGE_NODES - 1) as f64 - 0.5)).powi(2));
/// assert!((gauge_growth(|x| x.max(-40.0), &bell) - 40.0).abs() < 1e-9);
/// ```
pub fn gauge_growth(gauge: Gauge, x: &[f64; GAUGE_NODES]) -> f64 {
    growth(gauge, x, 0.0)
}

/// The same, of arguments that may be off by `blur`.
fn growth(gauge: Gauge, x: &[f64; GAUGE_NODES], blur: f64) -> f64 {
    let x = x.map(bounded);
    if x.iter().any(|x| x.is_nan()) {
        return f64::INFINITY;
    }
    if is_flat(gauge, &x) {
        return 0.0;
    }
    let (fine, coarse) = (differences(x), differences(every_other(&x)));
    let at = |theta: f64| through(&fine, theta);
    let place = |k: usize| k as f64 / (GAUGE_NODES - 1) as f64;
    let missed = (1..GAUGE_NODES).step_by(2).map(|k| (x[k] - through(&coarse, place(k))).abs()).fold(0.0, f64::max);
    let missed = missed + blur + ARGUMENT_DIGITS * x.iter().fold(0.0, |largest, x| x.abs().max(largest));
    let width = 1.0 / PARTS as f64;
    let values: Vec<f64> = (0..=PARTS).map(|i| at(i as f64 * width)).collect();
    let grown = |(low, high): (f64, f64), beyond: f64| gauge(high + beyond) - gauge(low - beyond);
    let bend = values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).abs()).fold(0.0, f64::max);
    let around = ends(values.iter().copied());
    let (least, most) = (grown(around, missed), grown(around, missed + bend));
    if most <= GAUGE_LIMIT || least > GAUGE_LIMIT {
        return least;
    }
    // where it turns between the values, and beside the ends, where it may turn before the second one
    let between = |i: usize, j: usize, sign: f64| extreme(&at, i as f64 * width, j as f64 * width, sign);
    let slope = |i: usize| values[i] - values[i - 1];
    let turns = (1..PARTS).filter(|&i| slope(i) * slope(i + 1) <= 0.0).map(|i| between(i - 1, i + 1, slope(i)));
    let beside = [between(0, 1, -slope(1)), between(PARTS - 1, PARTS, slope(PARTS))];
    grown(ends(values.iter().copied().chain(turns).chain(beside)), missed)
}

fn bounded(x: f64) -> f64 {
    x.clamp(-HUGE, HUGE)
}

/// The largest value on an interval where a function rises and then falls; with `sign < 0` the least one.
fn extreme(at: &impl Fn(f64) -> f64, mut from: f64, mut to: f64, sign: f64) -> f64 {
    // by thirds, to the last digits: tops may be flat
    for _ in 0..60 {
        let third = (to - from) / 3.0;
        match sign * at(from + third) < sign * at(to - third) {
            true => from += third,
            false => to -= third,
        }
    }
    at(0.5 * (from + to))
}

fn ends(x: impl Iterator<Item = f64>) -> (f64, f64) {
    x.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Newton's forward differences of values at equal distances on [0, 1].
fn differences<const N: usize>(mut x: [f64; N]) -> [f64; N] {
    for k in 1..N {
        for i in (k..N).rev() {
            x[i] -= x[i - 1];
        }
    }
    x
}

/// The polynomial with these differences.
fn through<const N: usize>(differences: &[f64; N], theta: f64) -> f64 {
    let s = theta * (N - 1) as f64;
    let (mut sum, mut factor) = (differences[0], 1.0);
    for (k, difference) in differences.iter().enumerate().skip(1) {
        factor *= (s - (k - 1) as f64) / k as f64;
        sum += factor * difference;
    }
    sum
}
