//! Detects poles within steps: zeros of divisors.
//!
//! A wall c/x² with c below the tolerance does not show in a series that begins far from it, and a method
//! evaluates its rates at a few points only. So divisors ([`crate::Problem::divisors`]) are evaluated at both
//! ends and in the middle of each step. Where one changes its sign, or the parabola through its values comes
//! near zero, points closer and closer to this zero are taken on the step's polynomial: the step is refused
//! if its slope differs from the rates there. A removable singularity, as in (sin x)/x, refuses no step.

use crate::dense::segment_with_slope;
use crate::events::Segment;
use crate::limits::{HUGE, ROUNDINGS};
use crate::options::{Method, Options};
use crate::root::SECTIONS;
use crate::system::{Failure, System};
use crate::taylor_step::{DEFECT, LEAST_RELATIVE};
use std::f64::consts::GOLDEN_RATIO;

/// The parabola comes near zero where it comes under this part of the smaller end.
const NEAR: f64 = 0.02;
/// Approaches on the straight line between two states, to their last digits.
const LAST_DIGITS: usize = 1200;
/// Slopes of polynomials that other methods leave behind are not as good as their ends.
const OTHERS: f64 = 1e4;

/// Whether a function with these values at the begin, in the middle and at the end of a step may vanish.
pub fn may_vanish([begin, middle, end]: [f64; 3]) -> bool {
    let sign = begin.signum();
    if begin == 0.0 || middle * sign <= 0.0 || end * sign <= 0.0 {
        return true;
    }
    vertex([begin, middle, end]).is_some_and(|(_, value)| value * sign < NEAR * begin.abs().min(end.abs()))
}

/// Where in the step the parabola through these values turns towards zero, and its value there.
fn vertex([begin, middle, end]: [f64; 3]) -> Option<(f64, f64)> {
    let (bend, slope) = (2.0 * (begin - 2.0 * middle + end), 4.0 * middle - 3.0 * begin - end);
    let theta = -0.5 * slope / bend;
    let turns = bend * begin > 0.0 && theta > 0.0 && theta < 1.0;
    turns.then_some((theta, begin + 0.5 * slope * theta))
}

/// Divisors at the time reached and along the step.
pub(crate) struct DivisorZeros {
    reached: Vec<f64>,
    middle: Vec<f64>,
    end: Vec<f64>,
    place: Place,
    terms: Vec<f64>,
    absolute: Vec<f64>,
    relative: f64,
}

/// A point of the polynomial: its state, its slope times the step, and the rates.
#[derive(Clone)]
struct Place {
    t: f64,
    y: Vec<f64>,
    slope: Vec<f64>,
    rates: Vec<f64>,
    divisors: Vec<f64>,
}

impl Place {
    /// The time and state so far on the straight line to another.
    fn towards(&self, other: &Place, share: f64) -> Place {
        let between = |a: f64, b: f64| a + share * (b - a);
        let y = self.y.iter().zip(&other.y).map(|(a, b)| between(*a, *b)).collect();
        Place { t: between(self.t, other.t), y, ..self.clone() }
    }

    fn is_at(&self, other: &Place) -> bool {
        self.t == other.t && self.y == other.y
    }
}

/// Two places that divide an interval by the golden section: not halves, which may hit a zero.
fn inner(low: f64, high: f64) -> [f64; 2] {
    [high - (high - low) / GOLDEN_RATIO, low + (high - low) / GOLDEN_RATIO]
}

/// Whether a zero is before the second of two places, or what has none is less at the first one.
fn goes_left(values: [f64; 2], crosses: bool, differs: impl Fn(f64) -> bool) -> bool {
    if crosses { values.into_iter().any(differs) } else { values[0].abs() < values[1].abs() }
}

impl DivisorZeros {
    pub(crate) fn new(system: &System, t: f64, y: &[f64], options: &Options) -> Result<Self, Failure> {
        let (n, count) = (y.len(), system.divisors());
        let zeros = |n: usize| vec![0.0; n];
        let mut reached = zeros(count);
        if count > 0 {
            system.divided(t, y, &mut reached)?;
        }
        let factor = DEFECT * if options.method == Method::Taylor { 1.0 } else { OTHERS };
        let place = Place { t, y: zeros(n), slope: zeros(n), rates: zeros(n), divisors: zeros(count) };
        let absolute = options.absolute_tolerances(n).iter().map(|x| factor * x).collect();
        let relative = factor * options.relative_tolerance.max(LEAST_RELATIVE);
        Ok(DivisorZeros {
            reached,
            middle: zeros(count),
            end: zeros(count),
            place,
            terms: zeros(n),
            absolute,
            relative,
        })
    }

    pub(crate) fn is_on(&self) -> bool {
        !self.reached.is_empty()
    }

    /// Refuses a step, to the state `end`, over a zero of a divisor at which the rates are not its slope.
    pub(crate) fn look(&mut self, system: &System, segment: &Segment, end: &[f64]) -> Result<(), Failure> {
        if !self.is_on() {
            return Ok(());
        }
        system.divided(segment.end, end, &mut self.end)?;
        segment.state(0.5, &mut self.place.y);
        system.divided(segment.time(0.5), &self.place.y, &mut self.middle)?;
        for j in 0..self.reached.len() {
            let values = [self.reached[j], self.middle[j], self.end[j]];
            if may_vanish(values) {
                self.approach(system, segment, j, values)?;
            }
        }
        Ok(())
    }

    pub(crate) fn advance(&mut self) {
        std::mem::swap(&mut self.reached, &mut self.end);
    }

    /// Looks at places that are closer to the zero of a divisor, or to where it is least, each time.
    fn approach(&mut self, system: &System, segment: &Segment, j: usize, values: [f64; 3]) -> Result<(), Failure> {
        let [begin, middle, end] = values;
        let differs = |value: f64| value * begin.signum() <= 0.0;
        let (mut low, mut high) = match vertex(values) {
            _ if differs(middle) => (0.0, 0.5),
            Some((theta, _)) if !differs(end) => ((theta - 0.25).max(0.0), (theta + 0.25).min(1.0)),
            _ => (0.5, 1.0),
        };
        let mut crosses = differs(middle) || differs(end);
        for _ in 0..SECTIONS {
            let [left, right] = inner(low, high);
            let values = [self.at(system, segment, left, j)?, self.at(system, segment, right, j)?];
            crosses |= values.into_iter().any(differs);
            if goes_left(values, crosses, differs) { high = right } else { low = left }
        }
        self.at(system, segment, low, j)?;
        let mut before = self.place.clone();
        self.at(system, segment, high, j)?;
        let mut beyond = self.place.clone();
        for _ in 0..LAST_DIGITS {
            let [left, right] = [2.0 - GOLDEN_RATIO, GOLDEN_RATIO - 1.0].map(|share| before.towards(&beyond, share));
            if [&left, &right].into_iter().any(|place| place.is_at(&before) || place.is_at(&beyond)) {
                break;
            }
            let mut values = [0.0; 2];
            for (value, place) in values.iter_mut().zip([&left, &right]) {
                self.place.t = place.t;
                self.place.y.copy_from_slice(&place.y);
                *value = self.judge(system, segment.width, j)?;
            }
            if values.iter().any(|value| value.abs() < HUGE.recip() * begin.abs()) {
                break;
            }
            crosses |= values.into_iter().any(differs);
            if goes_left(values, crosses, differs) { beyond = right } else { before = left }
        }
        Ok(())
    }

    /// The value of a divisor on the polynomial, where the rates have to be its slope.
    fn at(&mut self, system: &System, segment: &Segment, theta: f64, j: usize) -> Result<f64, Failure> {
        let Place { t, y, slope, .. } = &mut self.place;
        *t = segment.time(theta);
        segment_with_slope(segment.basis, segment.coefficients, theta, y, slope);
        self.judge(system, segment.width, j)
    }

    fn judge(&mut self, system: &System, width: f64, j: usize) -> Result<f64, Failure> {
        let Place { t, y, slope, rates, divisors } = &mut self.place;
        system.divided(*t, y, divisors)?;
        let value = divisors[j];
        if value == 0.0 {
            return Ok(value);
        }
        system.rates(*t, y, rates)?;
        let off = |i: usize, terms: f64| {
            let allowed = self.absolute[i] + self.relative * y[i].abs().max(slope[i].abs());
            let apart = (slope[i] - rates[i] * width).abs();
            apart > allowed + ROUNDINGS * f64::EPSILON * terms * width.abs()
        };
        if (0..y.len()).any(|i| off(i, 0.0)) {
            system.terms_of_rates(*t, y, &mut self.terms)?;
            if (0..y.len()).any(|i| off(i, self.terms[i])) {
                return Err(Failure::Pole { t: *t });
            }
        }
        Ok(value)
    }
}
