//! Roots and minima of scalar functions.

use std::f64::consts::GOLDEN_RATIO;

/// Sections of the bracket of a minimum, which becomes shorter by eight digits: half of those of a number.
pub(crate) const SECTIONS: usize = 40;

/// Where a function is least between `a` and `d`, and its value there, by golden sections.
///
/// # Errors
/// The first one of `f`.
pub fn least<E>(mut f: impl FnMut(f64) -> Result<f64, E>, [mut a, mut d]: [f64; 2]) -> Result<(f64, f64), E> {
    let (mut b, mut c) = (d - (d - a) / GOLDEN_RATIO, a + (d - a) / GOLDEN_RATIO);
    let (mut at_b, mut at_c) = (f(b)?, f(c)?);
    for _ in 0..SECTIONS {
        if at_b <= at_c {
            (d, c, at_c) = (c, b, at_b);
            b = d - (d - a) / GOLDEN_RATIO;
            at_b = f(b)?;
        } else {
            (a, b, at_b) = (b, c, at_c);
            c = a + (d - a) / GOLDEN_RATIO;
            at_c = f(c)?;
        }
    }
    Ok(if at_b <= at_c { (b, at_b) } else { (c, at_c) })
}

/// Root of a scalar function between `a` and `b`: `f(x) = 0`, for events and for "when does the gap pass ε".
///
/// Brent's method: inverse quadratic interpolation and secant steps, safeguarded by bisection. The root is
/// bracketed to `tolerance + 4ε|x|`, with `tolerance ≥ 0`; 0 asks for round-off.
///
/// Returns `None` where `f(a)` and `f(b)` are finite and of one sign, where either is NaN or infinite, or
/// where a NaN turns up between them. With several roots in the interval, one of them is returned.
///
/// Source: R. P. Brent, *Algorithms for Minimization without Derivatives*, Prentice-Hall 1973, chapter 4.
///
/// ```
/// let root = integrate::find_root(&mut |x| x * x - 2.0, 0.0, 2.0, 0.0).unwrap();
/// assert!((root - 2.0f64.sqrt()).abs() < 1e-15);
/// assert_eq!(integrate::find_root(&mut |x| x * x + 1.0, 0.0, 2.0, 0.0), None);
/// ```
pub fn find_root(f: &mut dyn FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Option<f64> {
    let (fa, fb) = (f(a), f(b));
    find_root_between(f, (a, fa), (b, fb), tolerance)
}

/// As [`find_root`], the values at the two ends being known.
pub(crate) fn find_root_between(
    f: &mut dyn FnMut(f64) -> f64,
    (mut a, mut fa): (f64, f64),
    (mut b, mut fb): (f64, f64),
    tolerance: f64,
) -> Option<f64> {
    if !(a.is_finite() && b.is_finite() && fa.is_finite() && fb.is_finite()) {
        return None;
    }
    if fa == 0.0 {
        return Some(a);
    }
    if fb != 0.0 && (fa > 0.0) == (fb > 0.0) {
        return None;
    }
    // b: best estimate; a: the one before; c: the other end of the bracket.
    let (mut c, mut fc) = (a, fa);
    let mut step = b - a;
    let mut step_before = step;
    loop {
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let limit = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance.max(f64::MIN_POSITIVE);
        let half = 0.5 * (c - b);
        if fb == 0.0 || half.abs() <= limit {
            return Some(b);
        }
        if step_before.abs() < limit || fa.abs() <= fb.abs() {
            step = half;
            step_before = half;
        } else {
            let s = fb / fa;
            let (mut p, mut q) = if a == c {
                (2.0 * half * s, 1.0 - s)
            } else {
                let (q, r) = (fa / fc, fb / fc);
                (s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)), (q - 1.0) * (r - 1.0) * (s - 1.0))
            };
            if p > 0.0 {
                q = -q;
            } else {
                p = -p;
            }
            if 2.0 * p < (3.0 * half * q - (limit * q).abs()).min((step_before * q).abs()) {
                step_before = step;
                step = p / q;
            } else {
                step = half;
                step_before = half;
            }
        }
        (a, fa) = (b, fb);
        b += if step.abs() > limit { step } else { limit.copysign(half) };
        fb = f(b);
        if !fb.is_finite() {
            return None;
        }
        if (fb > 0.0) == (fc > 0.0) {
            (c, fc) = (a, fa);
            step = b - a;
            step_before = step;
        }
    }
}
