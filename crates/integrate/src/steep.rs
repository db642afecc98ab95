//! Steps over what is switched on and off within them.
//!
//! A method knows its rates at a few points of a step. A function that is constant at all of these may still
//! change between them: a force for half a second within a step of ten. So arguments of such functions, which
//! are smooth, are read off the step's polynomial at five points, and a step is refused along which a
//! function's gauge ([`crate::Problem::gauges`]) grows by more than [`LIMIT`]: the method has to look closer.

use crate::dense::evaluate_segment;
use crate::events::Segment;
use crate::problem::Gauge;
use crate::system::{Failure, System};

/// A gauge may grow by so much along a step.
const LIMIT: f64 = 4.0;
/// Arguments are read off at so many places of equal distance, both ends among them.
const NODES: usize = 5;
/// The polynomial through these is looked at in so many parts.
const PARTS: usize = 16;

/// Arguments of gauges, at the time reached and along the step.
pub(crate) struct SteepWatch {
    gauges: Vec<Gauge>,
    along: [Vec<f64>; NODES],
    state: Vec<f64>,
}

impl SteepWatch {
    pub(crate) fn new(system: &System, t: f64, y: &[f64]) -> Result<Self, Failure> {
        let gauges = system.gauges();
        let mut along = std::array::from_fn(|_| vec![0.0; gauges.len()]);
        if !gauges.is_empty() {
            system.gauged(t, y, &mut along[0])?;
        }
        Ok(SteepWatch { gauges, along, state: vec![0.0; y.len()] })
    }

    pub(crate) fn is_on(&self) -> bool {
        !self.gauges.is_empty()
    }

    /// Refuses a step along which a gauge grows by more than [`LIMIT`].
    pub(crate) fn look(&mut self, system: &System, segment: &Segment) -> Result<(), Failure> {
        if !self.is_on() {
            return Ok(());
        }
        for (k, arguments) in self.along.iter_mut().enumerate().skip(1) {
            let theta = k as f64 / (NODES - 1) as f64;
            evaluate_segment(segment.basis, segment.coefficients, theta, &mut self.state);
            system.gauged(segment.time(theta), &self.state, arguments)?;
        }
        for (j, gauge) in self.gauges.iter().enumerate() {
            let x = std::array::from_fn(|k| self.along[k][j]);
            if growth(*gauge, &x) > LIMIT {
                return Err(Failure::Steep { t: segment.begin });
            }
        }
        Ok(())
    }

    pub(crate) fn advance(&mut self) {
        self.along.swap(0, NODES - 1);
    }
}

/// How much a gauge grows between the least and the largest value of the polynomial through `x`.
fn growth(gauge: Gauge, x: &[f64; NODES]) -> f64 {
    let (low, high) = ends(x.iter().copied());
    let margin = high - low;
    // no polynomial through these goes farther, or nearly so
    if gauge(high + margin) - gauge(low - margin) <= LIMIT {
        return 0.0;
    }
    let at = |theta: f64| through(x, theta);
    let width = 1.0 / PARTS as f64;
    let values: Vec<f64> = (0..=PARTS).map(|i| at(i as f64 * width)).collect();
    // beside the ends it may turn between the last two values
    let turns = |i: usize| (values[i] - values[i - 1]) * (values[i + 1] - values[i]) <= 0.0;
    let turns = (1..PARTS).filter(|&i| i == 1 || i == PARTS - 1 || turns(i));
    let vertices: Vec<f64> = turns.map(|i| at(vertex(&at, i as f64 * width, width))).collect();
    let (low, high) = ends(values.iter().copied().chain(vertices));
    gauge(high) - gauge(low)
}

/// Where a function turns near `theta`: the vertex of parabolas through three points, closer and closer.
fn vertex(at: &impl Fn(f64) -> f64, mut theta: f64, mut width: f64) -> f64 {
    for _ in 0..3 {
        let [a, b, c] = [-width, 0.0, width].map(|d| at(theta + d));
        let bend = a - 2.0 * b + c;
        if bend == 0.0 {
            break;
        }
        theta = (theta + (0.5 * width * (a - c) / bend).clamp(-width, width)).clamp(0.0, 1.0);
        width *= 0.1;
    }
    theta
}

fn ends(x: impl Iterator<Item = f64>) -> (f64, f64) {
    x.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// The polynomial through equidistant values on [0, 1], by Newton's forward differences.
fn through(x: &[f64; NODES], theta: f64) -> f64 {
    let s = theta * (NODES - 1) as f64;
    let mut differences = *x;
    let (mut sum, mut factor) = (x[0], 1.0);
    for k in 1..NODES {
        for i in 0..NODES - k {
            differences[i] = differences[i + 1] - differences[i];
        }
        factor *= (s - (k - 1) as f64) / k as f64;
        sum += factor * differences[0];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(gauge: Gauge, x: impl Fn(f64) -> f64) -> f64 {
        growth(gauge, &std::array::from_fn(|k| x(k as f64 / (NODES - 1) as f64)))
    }

    #[test]
    fn what_is_passed_over_is_seen_and_what_is_constant_is_not() {
        let tanh: Gauge = |x| x.clamp(-20.0, 20.0);
        let exp: Gauge = |x| x.max(-40.0);
        assert_eq!(of(tanh, |t| 1000.0 * t - 500.0), 40.0);
        assert_eq!(of(tanh, |t| 100.0 * t - 500.0), 0.0);
        assert!(of(tanh, |t| 3.0 * t) <= 3.0);
        // a bell a thousandth of the step wide, at any place
        for place in (1..100).map(|i| f64::from(i) / 100.0) {
            let grown = of(exp, |t| -((t - place) / 1e-3).powi(2));
            assert!((grown - 40.0).abs() < 1e-3, "{place}: {grown}");
        }
        let root: Gauge = |x| x.max(1e-20).ln();
        assert!(of(root, |t| (t - 0.3).powi(2) + 1e-16) > 20.0);
    }
}
