//! Numerical derivatives of a function that is smooth and accurate to the last digits, and detection of its
//! kinks.
//!
//! The derivative is a central difference of order 8 at the best of several distances,
//!
//! ```text
//! y'(x) = Σ_j w_j (y(x + jh) − y(x − jh))/h + O(h⁸) ,    w = 4/5, −1/5, 4/105, −1/280,
//! ```
//!
//! and its error is the difference from that of order 6, with round-off. A kink at x itself, where the slope
//! jumps by 2k, is even and has no part in these; it is
//!
//! ```text
//! k = Σ_j v_j (y(x + jh) + y(x − jh) − 2 y(x))/(2h) + O(h⁷) ,    v = 14/5, −7/5, 2/5, −1/20,
//! ```
//!
//! the same for all `h`, where that of what is smooth falls below round-off. Each part of `y` has its own
//! unit and is judged by its own size; its round-off is what it scatters by where x moves by its last digits.

use crate::band::limits::{BETWEEN, NEARLY_ZERO, ROUND_OFF};
use crate::{Settings, SolveError};
use symbolic::limits::OF_TERMS;

/// Weights of the differences of order 8 and of order 6.
const ORDER_8: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
const ORDER_6: [f64; 4] = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0, 0.0];
/// Weights of a kink.
const KINK: [f64; 4] = [14.0 / 5.0, -7.0 / 5.0, 2.0 / 5.0, -1.0 / 20.0];
/// Distances over the size of the number are these powers of 1/4: a start may have a pole nearby, as at a
/// heading of 90°.
const DISTANCES: std::ops::Range<i32> = 2..16;
/// A kink is looked for at these powers of 1/4, and is the same at three in turn.
const POWERS: std::ops::Range<i32> = 4..20;
const IN_TURN: usize = 3;

/// Error of a derivative over the largest one that is accepted: as of a motion at defaults.
fn limit() -> f64 {
    Settings::default().tolerance
}

type Values = Result<Vec<f64>, SolveError>;

/// The derivative at `x` of what is smooth in the number of this name.
pub(crate) fn derivative(name: &str, x: f64, at: &mut dyn FnMut(f64) -> Values) -> Values {
    let size = size(x);
    let here = at(x)?;
    let mut found = best(x, &here, &vec![0.0; here.len()], at)?;
    if found.error > limit() {
        let round_off = round_off(&here, &mut |s| at(x + s * size))?;
        found = best(x, &here, &round_off, at)?;
    }
    let refused = |what: String| {
        Err(SolveError::Member { reason: format!("the start does not move smoothly with {name}: {what}") })
    };
    if found.error > limit() {
        let error = found.error;
        return refused(format!("its derivative is known to {error:.1e} of itself, the limit is {:.0e}", limit()));
    }
    if found.even && has_kink(&mut |s| at(x + s * size)) {
        return refused("it has a kink there".into());
    }
    Ok(found.derivative)
}

/// The size of a number by which derivatives are taken.
pub(crate) fn size(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.abs() }
}

struct Found {
    derivative: Vec<f64>,
    /// Largest error of a part, over the size of that part.
    error: f64,
    /// Whether both sides differ by more than round-off.
    even: bool,
}

/// The difference at the best distance.
fn best(x: f64, here: &[f64], round_off: &[f64], at: &mut dyn FnMut(f64) -> Values) -> Result<Found, SolveError> {
    let (size, mut least, mut failure) = (size(x), None, None);
    for h in DISTANCES.map(|power| size * 0.25_f64.powi(power)) {
        let sums = match sums(x, h, here, at) {
            Ok(sums) => sums,
            Err(error) => {
                failure = Some(error);
                continue;
            }
        };
        let (mut error, mut even) = (0.0_f64, false);
        for (i, [high, low, kink]) in sums.iter().enumerate() {
            let digits = f64::EPSILON * here[i].abs() / h;
            let scale = high.abs() + here[i].abs() / size + round_off[i] / (h * limit());
            error = error.max(((high - low).abs() + digits) / scale.max(f64::MIN_POSITIVE));
            even |= kink.abs() > BETWEEN * digits;
        }
        if least.as_ref().is_none_or(|least: &Found| error < least.error) {
            least = Some(Found { derivative: sums.iter().map(|[high, ..]| *high).collect(), error, even });
        }
        if error <= OF_TERMS {
            break;
        }
    }
    least.ok_or_else(|| failure.expect("there are distances"))
}

/// For each part: the differences of order 8 and of order 6, and the kink.
fn sums(x: f64, h: f64, here: &[f64], at: &mut dyn FnMut(f64) -> Values) -> Result<Vec<[f64; 3]>, SolveError> {
    let mut sums = vec![[0.0; 3]; here.len()];
    for j in 0..4 {
        let step = h * (j + 1) as f64;
        let (after, before) = (x + step, x - step);
        // what lies between two numbers, as they are
        let width = (after - before) / (2.0 * step) * h;
        let (after, before) = (at(after)?, at(before)?);
        for (i, sums) in sums.iter_mut().enumerate() {
            let (odd, even) = (after[i] - before[i], after[i] + before[i] - 2.0 * here[i]);
            sums[0] += ORDER_8[j] * odd / width;
            sums[1] += ORDER_6[j] * odd / width;
            sums[2] += KINK[j] * even / (2.0 * width);
        }
    }
    Ok(sums)
}

/// Round-off of each part: its scatter when the number changes in its last digits, `s` times its size.
fn round_off(here: &[f64], at: &mut dyn FnMut(f64) -> Values) -> Values {
    let mut found: Vec<f64> = here.iter().map(|x| f64::EPSILON * x.abs()).collect();
    for j in 1..5 {
        let step = ROUND_OFF * f64::from(j);
        let (after, before) = (at(step)?, at(-step)?);
        for (i, found) in found.iter_mut().enumerate() {
            *found = found.max(BETWEEN * (after[i] + before[i] - 2.0 * here[i]).abs());
        }
    }
    Ok(found)
}

/// Whether some part of what is computed for `s` has a kink at 0.
pub(crate) fn has_kink(at: &mut dyn FnMut(f64) -> Values) -> bool {
    let Ok(here) = at(0.0) else { return false };
    let Ok(round_off) = round_off(&here, at) else { return false };
    // of each part that is not decided the kink at the distance before, and at how many in turn it was so
    let mut open: Vec<Option<(f64, usize)>> = vec![Some((0.0, 0)); here.len()];
    for h in POWERS.map(|power| 0.25_f64.powi(power)) {
        let Ok(sums) = sums(0.0, h, &here, at) else { continue };
        for (i, [_, _, kink]) in sums.into_iter().enumerate() {
            let Some((before, times)) = open[i] else { continue };
            if times > 0 && round_off[i] / h >= NEARLY_ZERO * before.abs() {
                if times >= IN_TURN {
                    return true;
                }
                open[i] = None;
                continue;
            }
            let is_alike = times > 0 && (kink - before).abs() <= NEARLY_ZERO * before.abs();
            open[i] = Some((kink, if is_alike { times + 1 } else { 1 }));
        }
        if open.iter().all(Option::is_none) {
            return false;
        }
    }
    open.into_iter().flatten().any(|(kink, times)| kink != 0.0 && times >= IN_TURN)
}
