//! Numbers that stay known exactly: `a + b π/2` with a rational `a` and an integer `b`.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// Multiples of π/2 up to this one are recognized.
const TURNS: i32 = 8;
/// A number with fewer digits than this is meant as the decimal it is.
const LONG: usize = 14;

/// `numerator / denominator + quarters · π/2`, reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exact {
    pub(crate) numerator: i128,
    pub(crate) denominator: i128,
    pub(crate) quarters: i32,
}

fn divisor(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Exact {
    pub(crate) const ZERO: Exact = Exact { numerator: 0, denominator: 1, quarters: 0 };

    /// `None` where the reduced fraction would not fit, or the denominator is zero.
    pub(crate) fn ratio(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator == 0 {
            return None;
        }
        let shared = divisor(numerator, denominator) * denominator.signum();
        Some(Exact { numerator: numerator / shared, denominator: denominator / shared, quarters: 0 })
    }

    /// The decimal that `x` is written as; the multiple of π/2 where it is that, to all its digits.
    pub(crate) fn of(x: f64) -> Option<Self> {
        let text = format!("{x:e}");
        let (mantissa, exponent) = text.split_once('e')?;
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let quarters = (x / FRAC_PI_2).round();
        let turned = quarters != 0.0 && quarters.abs() <= f64::from(TURNS);
        if turned && whole.len() + fraction.len() >= LONG && (x - quarters * FRAC_PI_2).abs() <= f64::EPSILON * x.abs()
        {
            return Some(Exact { quarters: quarters as i32, ..Exact::ZERO });
        }
        let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
        let scale = exponent.parse::<i32>().ok()? - i32::try_from(fraction.len()).ok()?;
        let power = 10_i128.checked_pow(scale.unsigned_abs())?;
        if scale >= 0 { Self::ratio(digits.checked_mul(power)?, 1) } else { Self::ratio(digits, power) }
    }

    /// Whether no π is in it.
    pub(crate) fn is_rational(self) -> bool {
        self.quarters == 0
    }

    pub(crate) fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    pub(crate) fn add(self, other: Self) -> Option<Self> {
        let a = self.numerator.checked_mul(other.denominator)?;
        let b = other.numerator.checked_mul(self.denominator)?;
        let sum = Self::ratio(a.checked_add(b)?, self.denominator.checked_mul(other.denominator)?)?;
        Some(Exact { quarters: self.quarters.checked_add(other.quarters)?, ..sum })
    }

    pub(crate) fn neg(self) -> Self {
        Exact { numerator: -self.numerator, denominator: self.denominator, quarters: -self.quarters }
    }

    pub(crate) fn mul(self, other: Self) -> Option<Self> {
        let (angle, factor) = if self.is_rational() { (other, self) } else { (self, other) };
        if !factor.is_rational() {
            return None;
        }
        let numerator = angle.numerator.checked_mul(factor.numerator)?;
        let product = Self::ratio(numerator, angle.denominator.checked_mul(factor.denominator)?)?;
        let quarters = i128::from(angle.quarters).checked_mul(factor.numerator)?;
        if quarters % factor.denominator != 0 {
            return None;
        }
        Some(Exact { quarters: i32::try_from(quarters / factor.denominator).ok()?, ..product })
    }

    /// `None` for zero, and where π is in it.
    pub(crate) fn recip(self) -> Option<Self> {
        if self.is_rational() { Self::ratio(self.denominator, self.numerator) } else { None }
    }

    pub(crate) fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64 + f64::from(self.quarters) * FRAC_PI_2
    }
}

impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.numerator, self.denominator, self.quarters) {
            (0, _, quarters) if quarters != 0 => write!(f, "{quarters}*pi/2"),
            (n, 1, 0) => write!(f, "{n}"),
            (n, d, 0) => write!(f, "{n}/{d}"),
            (n, d, quarters) => write!(f, "{n}/{d} + {quarters}*pi/2"),
        }
    }
}

#[cfg(test)]
#[expect(clippy::approx_constant, reason = "decimals as a scene has them")]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        assert_eq!(Exact::of(0.05), Exact::ratio(1, 20));
        assert_eq!(Exact::of(-1.5e3), Exact::ratio(-1500, 1));
        assert_eq!(Exact::of(1.5707963267948966), Some(Exact { quarters: 1, ..Exact::ZERO }));
        assert_eq!(Exact::of(1.5708).and_then(|x| x.recip()), Exact::ratio(2500, 3927));
        let sum = Exact::of(3.141592653589793).and_then(|pi| pi.add(Exact::ratio(1, 3)?));
        assert_eq!(sum, Some(Exact { numerator: 1, denominator: 3, quarters: 2 }));
        assert_eq!(sum.and_then(|x| x.mul(Exact::ratio(1, 2)?)).map(|x| x.quarters), Some(1));
    }
}
