//! Equidistant values, as the decimals that are meant.

use crate::TRUSTED;

/// Powers of ten up to this one are exact.
const EXACT: i32 = 22;

/// Value number `place`, from 0, of `count` from `from` to `to`: the ends as they are, those between to
/// fifteen digits of the larger end. 0.6 is meant, not 0.6000000000000001, and a proof is about the number as
/// it is written.
///
/// ```
/// let value = |place| motion::equidistant_value(-0.6, 0.6, 13, place);
/// assert_eq!([value(0), value(5), value(6), value(12)], [-0.6, -0.1, 0.0, 0.6]);
/// ```
pub fn equidistant_value(from: f64, to: f64, count: usize, place: usize) -> f64 {
    match place {
        0 => from,
        _ if place + 1 >= count => to,
        _ => {
            let part = place as f64 / (count - 1) as f64;
            let value = from * (1.0 - part) + to * part;
            let last = f64::DIGITS as i32 - 1 - from.abs().max(to.abs()).log10().floor().max(-400.0) as i32;
            let tens = 10_f64.powi(last.abs());
            let step = (to - from).abs() / (count - 1) as f64;
            // values that the last of these digits tells apart too badly are not rounded
            let digit = TRUSTED * step;
            match last {
                0..=EXACT if digit * tens >= 1.0 => (value * tens).round() / tens,
                ..0 if last >= -EXACT && digit / tens >= 1.0 => (value / tens).round() * tens,
                _ if last > EXACT && digit * tens >= 1.0 => {
                    format!("{value:.*}", last.unsigned_abs() as usize).parse().unwrap_or(value)
                }
                _ => value,
            }
        }
    }
}

/// All [`equidistant_value`]s, both ends included.
pub fn equidistant(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |place| equidistant_value(from, to, count, place))
}
