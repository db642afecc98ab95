//! Numbers that stay known exactly: `a + b π` with fractions `a` and `b`, the angles among them.

use std::f64::consts::PI;
use std::fmt;

use super::Flaw;

/// Multiples of `π/PARTS` are known: of `π/d` for every d up to 16, of degrees and of their halves and
/// quarters.
pub(crate) const PARTS: i64 = 720_720;
/// Decimals of so many digits may be multiples of π in the digits of a double.
const LONG: usize = 15;

/// `numerator / denominator + turns · π/PARTS`, reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exact {
    pub(crate) numerator: i128,
    pub(crate) denominator: i128,
    pub(crate) turns: i64,
}

fn divisor(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        // a long division takes ten times as long
        (a, b) = match (u64::try_from(a), u64::try_from(b)) {
            (Ok(short), Ok(by)) => (b, i128::from(short % by)),
            _ => (b, a % b),
        };
    }
    a
}

impl Exact {
    pub(crate) const ZERO: Exact = Exact { numerator: 0, denominator: 1, turns: 0 };
    pub(crate) const ONE: Exact = Exact { numerator: 1, denominator: 1, turns: 0 };
    /// π/2.
    pub(crate) const QUARTER: Exact = Exact { numerator: 0, denominator: 1, turns: PARTS / 2 };

    /// `None` where the reduced fraction would not fit, or the denominator is zero.
    pub(crate) fn ratio(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator == 0 {
            return None;
        }
        if denominator == 1 {
            return Some(Exact { numerator, denominator, turns: 0 });
        }
        let shared = divisor(numerator, denominator) * denominator.signum();
        Some(Exact { numerator: numerator / shared, denominator: denominator / shared, turns: 0 })
    }

    /// The decimal that `x` is written as.
    ///
    /// # Errors
    /// [`Flaw::Rounded`] for what is a multiple of π to all the digits of a double: neither that multiple nor
    /// these digits may be meant. [`Flaw::Number`] for what does not fit.
    pub(crate) fn of(x: f64) -> Result<Self, Flaw> {
        let text = format!("{x:e}");
        let (mantissa, exponent) = text.split_once('e').ok_or(Flaw::Number)?;
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        if whole.len() + fraction.len() >= LONG
            && (1..=360).any(|d| {
                let times = (x / PI * f64::from(d)).round();
                times != 0.0 && (x - times * PI / f64::from(d)).abs() <= f64::EPSILON * x.abs()
            })
        {
            return Err(Flaw::Rounded);
        }
        let decimal = || {
            let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
            let scale = exponent.parse::<i32>().ok()? - i32::try_from(fraction.len()).ok()?;
            let power = 10_i128.checked_pow(scale.unsigned_abs())?;
            if scale >= 0 { Self::ratio(digits.checked_mul(power)?, 1) } else { Self::ratio(digits, power) }
        };
        decimal().ok_or(Flaw::Number)
    }

    /// A number of a formula, in which π is the quotient [`symbolic::PI`] of two primes.
    ///
    /// # Errors
    /// [`Flaw::Pi`] for what is no `a + b π` with moderate fractions, [`Flaw::Turn`] for too fine a `b`.
    pub(crate) fn of_formula(numerator: i64, denominator: i64) -> Result<Self, Flaw> {
        let (above, below) = (i128::from(symbolic::PI.0), i128::from(symbolic::PI.1));
        let (n, d) = (i128::from(numerator), i128::from(denominator));
        if d % above == 0 {
            return Err(Flaw::Pi);
        }
        if d % below != 0 {
            let rounded = d > 10_i128.pow(13) && Self::of(n as f64 / d as f64) == Err(Flaw::Rounded);
            return if rounded { Err(Flaw::Rounded) } else { Self::ratio(n, d).ok_or(Flaw::Number) };
        }
        let rest = d / below;
        if rest % below == 0 {
            return Err(Flaw::Pi);
        }
        if n % above == 0 {
            return Self::ratio(n / above, rest).ok_or(Flaw::Number)?.of_pi();
        }
        // n/rest = b·above modulo the prime `below`, b = r/s with r and s under the root of that
        let residue = n * inverse(rest % below * above % below, below) % below;
        let (mut r, mut s) = ((below, residue.rem_euclid(below)), (0_i128, 1_i128));
        while 2 * r.1 * r.1 > below {
            let quotient = r.0 / r.1;
            r = (r.1, r.0 - quotient * r.1);
            s = (s.1, s.0 - quotient * s.1);
        }
        let part = Self::ratio(r.1, s.1).filter(|_| 2 * s.1 * s.1 <= below).ok_or(Flaw::Pi)?;
        // the fraction beside it
        let beside = Self::ratio(
            n * part.denominator - part.numerator * above * rest,
            d.checked_mul(part.denominator).ok_or(Flaw::Pi)?,
        );
        let beside = beside.filter(|beside| beside.denominator % below != 0).ok_or(Flaw::Pi)?;
        part.of_pi()?.add(beside).ok_or(Flaw::Number)
    }

    /// This many times π.
    fn of_pi(self) -> Result<Self, Flaw> {
        let turns = self.numerator.checked_mul(PARTS.into()).filter(|turns| turns % self.denominator == 0);
        let turns = turns.and_then(|turns| i64::try_from(turns / self.denominator).ok()).ok_or(Flaw::Turn)?;
        Ok(Exact { turns, ..Exact::ZERO })
    }

    /// Whether no π is in it.
    pub(crate) fn is_rational(self) -> bool {
        self.turns == 0
    }

    pub(crate) fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    pub(crate) fn add(self, other: Self) -> Option<Self> {
        let a = self.numerator.checked_mul(other.denominator)?;
        let b = other.numerator.checked_mul(self.denominator)?;
        let sum = Self::ratio(a.checked_add(b)?, self.denominator.checked_mul(other.denominator)?)?;
        Some(Exact { turns: self.turns.checked_add(other.turns)?, ..sum })
    }

    pub(crate) fn neg(self) -> Self {
        Exact { numerator: -self.numerator, denominator: self.denominator, turns: -self.turns }
    }

    pub(crate) fn mul(self, other: Self) -> Option<Self> {
        let (angle, factor) = if self.is_rational() { (other, self) } else { (self, other) };
        if !factor.is_rational() {
            return None;
        }
        let numerator = angle.numerator.checked_mul(factor.numerator)?;
        let product = Self::ratio(numerator, angle.denominator.checked_mul(factor.denominator)?)?;
        if angle.is_rational() {
            return Some(product);
        }
        let turns = i128::from(angle.turns).checked_mul(factor.numerator)?;
        if turns % factor.denominator != 0 {
            return None;
        }
        Some(Exact { turns: i64::try_from(turns / factor.denominator).ok()?, ..product })
    }

    /// `None` for zero, and where π is in it.
    pub(crate) fn recip(self) -> Option<Self> {
        if self.is_rational() { Self::ratio(self.denominator, self.numerator) } else { None }
    }

    pub(crate) fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64 + self.turns as f64 * (PI / PARTS as f64)
    }
}

/// `1/a` modulo the prime `p`.
pub(crate) fn inverse(a: i128, p: i128) -> i128 {
    let (mut r, mut s) = ((p, a.rem_euclid(p)), (0_i128, 1_i128));
    while r.1 != 0 {
        let quotient = match (u64::try_from(r.0), u64::try_from(r.1)) {
            (Ok(short), Ok(by)) => i128::from(short / by),
            _ => r.0 / r.1,
        };
        r = (r.1, r.0 - quotient * r.1);
        s = (s.1, s.0 - quotient * s.1);
    }
    s.0.rem_euclid(p)
}

impl fmt::Display for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (n, d) = (self.numerator, self.denominator);
        match Exact::ratio(self.turns.into(), PARTS.into()) {
            Some(pi) if self.turns != 0 => write!(f, "{n}/{d} + {}*pi/{}", pi.numerator, pi.denominator),
            _ if d == 1 => write!(f, "{n}"),
            _ => write!(f, "{n}/{d}"),
        }
    }
}

#[cfg(test)]
#[expect(clippy::approx_constant, reason = "decimals as a scene has them")]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        assert_eq!(Exact::of(0.05).ok(), Exact::ratio(1, 20));
        assert_eq!(Exact::of(-1.5e3).ok(), Exact::ratio(-1500, 1));
        assert_eq!(Exact::of(1.5707963267948966), Err(Flaw::Rounded));
        assert_eq!(Exact::of(1.0471975511965976), Err(Flaw::Rounded));
        assert_eq!(Exact::of(1.5708).ok().and_then(|x| x.recip()), Exact::ratio(2500, 3927));
        let read = |text: &str| {
            let g = symbolic::Graph::new();
            let (n, d) = g.as_ratio(g.parse(text, &|_| None, &[]).unwrap()).unwrap();
            Exact::of_formula(n, d)
        };
        let of = |n, d, turns| Ok(Exact { turns, ..Exact::ratio(n, d).unwrap() });
        assert_eq!(read("30*pi/180"), of(0, 1, PARTS / 6));
        assert_eq!(read("pi + 1/3"), of(1, 3, PARTS));
        assert_eq!(read("0.2 - 7*pi/12"), of(1, 5, -7 * PARTS / 12));
        assert_eq!(read("pi/17"), Err(Flaw::Turn));
        assert_eq!(read("1/pi"), Err(Flaw::Pi));
        assert_eq!(read("pi + 1/3").ok().and_then(|x| x.mul(Exact::ratio(1, 2)?)).map(|x| x.turns), Some(PARTS / 2));
    }
}
