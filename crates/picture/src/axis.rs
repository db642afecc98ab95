//! From values to lengths along an axis, and the ticks that stand there.
//!
//! Everything works in the *measure* of an axis: the value, or on a logarithmic axis its decimal logarithm.

use super::error::PictureError;
use super::plot::{Axis, Scale};
use super::text::{decimal, power_of_ten, width};

/// Values beyond are treated as not finite, so that differences of two values stay finite; on a logarithmic
/// axis those below its inverse as zero.
const LARGEST: f64 = 1e300;
/// Font size of tick labels, in pixels.
pub const TICK_SIZE: f64 = 12.0;

/// Why a value has no place on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    NotFinite,
    NotPositive,
}

/// A range in the measure of an axis; `low < high`, both finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

/// Which way an axis runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Horizontal,
    Vertical,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Place in the measure of the axis.
    pub at: f64,
    pub label: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    pub labelled: Vec<Tick>,
    /// Places of the short ticks without label.
    pub minor: Vec<f64>,
    /// What every label is to be multiplied by: `×10⁻⁷`.
    pub factor: Option<String>,
}

impl Interval {
    pub fn span(self) -> f64 {
        self.high - self.low
    }

    pub fn contains(self, at: f64) -> bool {
        (self.low..=self.high).contains(&at)
    }

    /// Place of a measure as a fraction of the length.
    pub fn fraction(self, at: f64) -> f64 {
        (at - self.low) / self.span()
    }

    /// The interval with the same middle and this span.
    pub fn with_span(self, span: f64) -> Self {
        let middle = self.low / 2.0 + self.high / 2.0;
        Self { low: middle - span / 2.0, high: middle + span / 2.0 }
    }
}

pub fn measure(scale: Scale, value: f64) -> Result<f64, LeftOut> {
    if !value.is_finite() || value.abs() > LARGEST {
        return Err(LeftOut::NotFinite);
    }
    match scale {
        Scale::Linear => Ok(value),
        Scale::Log if value >= LARGEST.recip() => Ok(value.log10()),
        Scale::Log => Err(LeftOut::NotPositive),
    }
}

/// The range an axis was given.
pub fn given(axis: &Axis) -> Result<Option<Interval>, PictureError> {
    let Some((low, high)) = axis.range else {
        return Ok(None);
    };
    let refusal = || PictureError::Range { axis: axis.label.clone(), low, high };
    let interval = Interval {
        low: measure(axis.scale, low).map_err(|_| refusal())?,
        high: measure(axis.scale, high).map_err(|_| refusal())?,
    };
    if high - low < 1e-9 * low.abs().max(high.abs()) || interval.span() < 1e-290 {
        return Err(refusal());
    }
    Ok(Some(interval))
}

/// A runaway alone makes an axis longer, by this factor, than all others do.
const RUNAWAY: f64 = 5.0;
/// Ranges of so small a part of another are round-off.
const NEGLIGIBLE: f64 = 1e-6;

/// The range of what is compared, of the `measures` of some curves: that of all, or on a linear axis of the
/// first and at least another one, without runaways; with `margin` of its span on both sides.
pub fn around(scale: Scale, measures: impl Iterator<Item = Vec<f64>>, margin: f64) -> Option<Interval> {
    let hull = |a: Interval, b: Interval| Interval { low: a.low.min(b.low), high: a.high.max(b.high) };
    let each = |curve: Vec<f64>| curve.into_iter().map(|at| Interval { low: at, high: at }).reduce(hull);
    let mut curves: Vec<Interval> = measures.filter_map(each).collect();
    let all = |curves: &[Interval]| curves.iter().copied().reduce(hull);
    let without = |curves: &[Interval], i: usize| all(&[&curves[..i], &curves[i + 1..]].concat());
    let runs_away = |curves: &[Interval], i: usize| {
        let spans = without(curves, i).zip(all(curves)).map(|(rest, all)| rest.span() / all.span());
        spans.is_some_and(|part| part > NEGLIGIBLE && part < 1.0 / RUNAWAY)
    };
    while scale == Scale::Linear
        && curves.len() > 2
        && let Some(i) = (1..curves.len()).find(|&i| runs_away(&curves, i))
    {
        curves.remove(i);
    }
    let interval = all(&curves)?;
    let Interval { low, high } = interval;
    let magnitude = low.abs().max(high.abs());
    let span = interval.span();
    let one_value = match scale {
        Scale::Linear => span <= NEGLIGIBLE * magnitude || span < 1e-290,
        Scale::Log => span < 1e-6,
    };
    Some(match (one_value, scale) {
        (false, _) => interval.with_span(span * (1.0 + 2.0 * margin)),
        (true, Scale::Linear) if magnitude < 1e-290 => interval.with_span(2.0),
        (true, Scale::Linear) => interval.with_span(0.1 * magnitude),
        (true, Scale::Log) => interval.with_span(1.0),
    })
}

/// Ticks for an axis of this length in pixels.
pub fn ticks(scale: Scale, interval: Interval, length: f64, direction: Direction) -> Ticks {
    match scale {
        Scale::Linear => linear_ticks(interval, length, direction),
        Scale::Log => log_ticks(interval, length, direction),
    }
}

/// How many labels a length has room for.
fn room(length: f64, direction: Direction) -> usize {
    let each = match direction {
        Direction::Horizontal => 70.0,
        Direction::Vertical => 34.0,
    };
    let count = (length / each) as usize;
    count.clamp(2, 8)
}

/// Do the labels stand apart?
pub fn apart(labelled: &[Tick], interval: Interval, length: f64, direction: Direction) -> bool {
    labelled.windows(2).all(|pair| {
        let distance = (interval.fraction(pair[1].at) - interval.fraction(pair[0].at)) * length;
        match direction {
            Direction::Vertical => distance >= 18.0,
            Direction::Horizontal => {
                let widths = width(&pair[0].label, TICK_SIZE) + width(&pair[1].label, TICK_SIZE);
                distance >= widths / 2.0 + 10.0
            }
        }
    })
}

fn linear_ticks(interval: Interval, length: f64, direction: Direction) -> Ticks {
    let mut ticks = Ticks::default();
    for count in (1..=room(length, direction)).rev() {
        ticks = linear_ticks_at_most(interval, count);
        if apart(&ticks.labelled, interval, length, direction) {
            break;
        }
    }
    ticks
}

/// Multiples of 1, 2 or 5 times a power of ten, with at most `count` steps between them.
fn linear_ticks_at_most(interval: Interval, count: usize) -> Ticks {
    let least = interval.span() / count as f64;
    let power = least.log10().floor() as i32;
    let (digit, power) = [(1, power), (2, power), (5, power), (1, power + 1), (2, power + 1)]
        .into_iter()
        .find(|&(digit, power)| f64::from(digit) * ten_to(power) >= least * (1.0 - 1e-9))
        .unwrap_or((5, power + 1));
    let step = f64::from(digit) * ten_to(power);
    let magnitude = interval.low.abs().max(interval.high.abs());
    let exponent = magnitude.log10().floor() as i32;
    let exponent = if (-3..5).contains(&exponent) { 0 } else { exponent };
    let decimals = usize::try_from(exponent - power).unwrap_or(0);
    // A hair of slack, so that a range that ends on a tick shows it.
    let first = (interval.low / step - 1e-9).ceil() as i64;
    let last = (interval.high / step + 1e-9).floor() as i64;
    let labelled = (first..=last)
        .map(|i| {
            let digits = (i * i64::from(digit)) as f64;
            Tick {
                at: (i as f64 * step).clamp(interval.low, interval.high),
                label: decimal(digits * ten_to(power - exponent), decimals),
            }
        })
        .collect();
    Ticks { labelled, minor: Vec::new(), factor: (exponent != 0).then(|| format!("×{}", power_of_ten(exponent))) }
}

/// 10ⁿ to the last bit, which repeated multiplication is not.
fn ten_to(n: i32) -> f64 {
    format!("1e{n}").parse().unwrap_or(f64::NAN)
}

fn log_ticks(interval: Interval, length: f64, direction: Direction) -> Ticks {
    let first = (interval.low - 1e-9).ceil() as i32;
    let last = (interval.high + 1e-9).floor() as i32;
    let clamp = |at: f64| at.clamp(interval.low, interval.high);
    if last - first < 2 {
        return short_log_ticks(interval, length, direction);
    }
    let decades = |stride: i32| {
        (first..=last)
            .filter(move |exponent| exponent.rem_euclid(stride) == 0)
            .map(move |exponent| Tick { at: clamp(f64::from(exponent)), label: power_of_ten(exponent) })
            .collect::<Vec<_>>()
    };
    let (stride, labelled) = [1, 2, 3, 4, 5, 10, 20, 50, 100]
        .into_iter()
        .map(|stride| (stride, decades(stride)))
        .find(|(_, labelled)| labelled.len() <= room(length, direction) && apart(labelled, interval, length, direction))
        .unwrap_or_else(|| (1000, decades(1000)));
    // Between labelled decades: 2 to 9 where they are neighbours and wide, else the decades themselves.
    let minor: Vec<f64> = if stride > 1 {
        (first..=last).map(f64::from).collect()
    } else if length / interval.span() >= 30.0 {
        (first - 1..=last)
            .flat_map(|exponent| (2..10).map(move |digit| f64::from(exponent) + f64::from(digit).log10()))
            .collect()
    } else {
        Vec::new()
    };
    Ticks { labelled, minor: minor.into_iter().filter(|at| interval.contains(*at)).collect(), factor: None }
}

/// Ticks of under two decades: 1, 2, 5 times powers of ten if three of them, else those of a linear axis.
fn short_log_ticks(interval: Interval, length: f64, direction: Direction) -> Ticks {
    let exponents = (interval.low - 1.0).floor() as i32..=(interval.high + 1.0).floor() as i32;
    let plain = exponents.clone().all(|exponent| (-4..=4).contains(&exponent));
    let label = |digit: i32, exponent: i32| match (plain, digit) {
        (true, _) => decimal(f64::from(digit) * ten_to(exponent), usize::try_from(-exponent).unwrap_or(0)),
        (false, 1) => power_of_ten(exponent),
        (false, _) => format!("{digit}×{}", power_of_ten(exponent)),
    };
    let place = |digit: i32, exponent: i32| f64::from(exponent) + f64::from(digit).log10();
    let labelled: Vec<Tick> = exponents
        .clone()
        .flat_map(|exponent| [1, 2, 5].map(|digit| (digit, exponent)))
        .filter(|&(digit, exponent)| interval.contains(place(digit, exponent)))
        .map(|(digit, exponent)| Tick { at: place(digit, exponent), label: label(digit, exponent) })
        .collect();
    if labelled.len() < 3 || !apart(&labelled, interval, length, direction) {
        return narrow_log_ticks(interval, length, direction);
    }
    let minor = exponents
        .flat_map(|exponent| (2..10).map(move |digit| place(digit, exponent)))
        .filter(|at| interval.contains(*at))
        .collect();
    Ticks { labelled, minor, factor: None }
}

/// Equally spaced values on a logarithmic axis, for a range of less than a decade.
fn narrow_log_ticks(interval: Interval, length: f64, direction: Direction) -> Ticks {
    let values = Interval { low: 10f64.powf(interval.low), high: 10f64.powf(interval.high) };
    for count in (1..=room(length, direction)).rev() {
        let mut ticks = linear_ticks_at_most(values, count);
        for tick in &mut ticks.labelled {
            tick.at = tick.at.log10().clamp(interval.low, interval.high);
        }
        if apart(&ticks.labelled, interval, length, direction) {
            return ticks;
        }
    }
    Ticks::default()
}
