//! Exact numbers: `a + b π` with fractions `a` and `b`, among them angles.

use std::f64::consts::PI;
use std::fmt;

use symbolic::Fraction;

use super::Flaw;

/// Multiples of `π/PARTS` are known: of `π/d` for every d up to 16, of degrees and of their halves and
/// quarters.
pub const PARTS: i64 = 720_720;

/// `fraction + turns · π/PARTS`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exact {
    /// `a`.
    pub fraction: Fraction,
    /// `b`, in parts of which [`PARTS`] are 1.
    pub turns: i64,
}

impl Exact {
    /// 0.
    pub const ZERO: Exact = Exact { fraction: Fraction::ZERO, turns: 0 };
    /// 1.
    pub const ONE: Exact = Exact { fraction: Fraction::ONE, turns: 0 };
    /// π/2.
    pub(crate) const QUARTER: Exact = Exact { turns: PARTS / 2, ..Exact::ZERO };

    /// `None` where the reduced fraction would not fit, or the denominator is zero.
    pub fn ratio(numerator: i128, denominator: i128) -> Option<Self> {
        Fraction::new(numerator, denominator).map(Self::rational)
    }

    /// A fraction, without π.
    pub fn rational(fraction: Fraction) -> Self {
        Exact { fraction, turns: 0 }
    }

    /// `k`
    pub(crate) fn integer(k: usize) -> Result<Self, Flaw> {
        Self::ratio(k as i128, 1).ok_or(Flaw::Number)
    }

    /// `1/k`
    pub(crate) fn over(k: usize) -> Result<Self, Flaw> {
        Self::ratio(1, k as i128).ok_or(Flaw::Zero)
    }

    /// The decimal that `x` is written as.
    ///
    /// # Errors
    /// [`Flaw::Rounded`] for what is a multiple of π to all the digits of a double: neither that multiple nor
    /// these digits may be meant. [`Flaw::Number`] for what does not fit.
    pub fn of(x: f64) -> Result<Self, Flaw> {
        let text = format!("{x:e}");
        let digits = text.split('e').next().unwrap_or_default().bytes().filter(u8::is_ascii_digit).count();
        if digits >= f64::DIGITS as usize
            && (1..=360).any(|d| {
                let times = (x / PI * f64::from(d)).round();
                times != 0.0 && (x - times * PI / f64::from(d)).abs() <= f64::EPSILON * x.abs()
            })
        {
            return Err(Flaw::Rounded);
        }
        Fraction::decimal(&text).map(Self::rational).ok_or(Flaw::Number)
    }

    /// A number of a formula, in which π is the quotient [`symbolic::PI`] of two primes.
    ///
    /// # Errors
    /// [`Flaw::Pi`] for what is no `a + b π` with moderate fractions, [`Flaw::Turn`] for too fine a `b`.
    pub fn of_formula(x: Fraction) -> Result<Self, Flaw> {
        let (above, below) = (i128::from(symbolic::PI.0), i128::from(symbolic::PI.1));
        let (n, d, twos, fives) = x.parts();
        if d % above == 0 {
            return Err(Flaw::Pi);
        }
        if d % below != 0 {
            let fine = x.plain().is_some_and(|(_, d)| d > 10_i128.pow(13));
            let rounded = fine && Self::of(x.to_f64()) == Err(Flaw::Rounded);
            return if rounded { Err(Flaw::Rounded) } else { Ok(Self::rational(x)) };
        }
        if d / below % below == 0 {
            return Err(Flaw::Pi);
        }
        if n % above == 0 {
            return Self::of_pi(Fraction::with_powers(n / above, d / below, twos, fives).ok_or(Flaw::Number)?);
        }
        // n/rest = b·above modulo the prime `below`, b = r/s with r and s under the root of that
        let (n, d) = x.plain().ok_or(Flaw::Pi)?;
        let rest = d / below;
        let residue = n * inverse(rest % below * above % below, below) % below;
        let (mut r, mut s) = ((below, residue.rem_euclid(below)), (0_i128, 1_i128));
        while 2 * r.1 * r.1 > below {
            let quotient = r.0 / r.1;
            r = (r.1, r.0 - quotient * r.1);
            s = (s.1, s.0 - quotient * s.1);
        }
        let part = Fraction::new(r.1, s.1).filter(|_| 2 * s.1 * s.1 <= below).ok_or(Flaw::Pi)?;
        // the fraction beside it
        let pi = Fraction::new(above, below).and_then(|pi| part.checked_mul(pi)).ok_or(Flaw::Pi)?;
        let beside = x.checked_add(pi.minus()).filter(|beside| beside.parts().1 % below != 0).ok_or(Flaw::Pi)?;
        Ok(Exact { fraction: beside, ..Self::of_pi(part)? })
    }

    /// This many times π.
    fn of_pi(part: Fraction) -> Result<Self, Flaw> {
        Ok(Exact { turns: whole(part, PARTS).ok_or(Flaw::Turn)?, ..Exact::ZERO })
    }

    /// Whether no π is in it.
    pub(crate) fn is_rational(self) -> bool {
        self.turns == 0
    }

    pub(crate) fn is_zero(self) -> bool {
        self == Self::ZERO
    }

    pub(crate) fn add(self, other: Self) -> Option<Self> {
        let turns = self.turns.checked_add(other.turns)?;
        Some(Exact { fraction: self.fraction.checked_add(other.fraction)?, turns })
    }

    pub(crate) fn neg(self) -> Self {
        Exact { fraction: self.fraction.minus(), turns: -self.turns }
    }

    /// The product, where that is such a number and fits.
    pub fn checked_mul(self, other: Self) -> Option<Self> {
        let (angle, factor) = if self.is_rational() { (other, self) } else { (self, other) };
        if !factor.is_rational() {
            return None;
        }
        let turns = whole(factor.fraction, angle.turns)?;
        Some(Exact { fraction: angle.fraction.checked_mul(factor.fraction)?, turns })
    }

    /// `None` for zero, and where π is in it.
    pub fn recip(self) -> Option<Self> {
        if self.is_rational() { self.fraction.recip().map(Self::rational) } else { None }
    }

    /// `a`.
    pub fn fraction(self) -> Fraction {
        self.fraction
    }

    /// The nearest double.
    pub fn to_f64(self) -> f64 {
        self.fraction.to_f64() + self.turns as f64 * (PI / PARTS as f64)
    }
}

/// `times · x`, where that is a moderate integer.
fn whole(x: Fraction, times: i64) -> Option<i64> {
    let (n, d) = Fraction::new(times.into(), 1)?.checked_mul(x)?.plain()?;
    if d == 1 { i64::try_from(n).ok() } else { None }
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
        match Fraction::new(self.turns.into(), PARTS.into()).and_then(Fraction::plain) {
            Some((n, d)) if n != 0 => write!(f, "{} + {n}*pi/{d}", self.fraction),
            _ => write!(f, "{}", self.fraction),
        }
    }
}
