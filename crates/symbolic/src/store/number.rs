//! Numbers of the graph: exact rationals while they fit, `f64` beyond.

use crate::Fraction;
use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul};
use std::hash::{Hash, Hasher};

/// Integers up to here are exact in `f64`, so a quotient of two of them is rounded once.
const EXACT_IN_F64: i64 = 1 << 53;

/// The π of `f64` as a quotient of two primes, off by 4e-18: so it differs from every number that is written
/// without π.
pub const PI: (i64, i64) = (29_111_083_649, 9_266_345_723);

/// A reduced fraction; compared and hashed by its two parts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Rational(Ratio<i64>);

impl Hash for Rational {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.numerator(), self.denominator()).hash(state);
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.cmp(&other.0)
    }
}

impl Rational {
    pub(crate) const ONE: Rational = Rational(Ratio::new_raw(1, 1));

    /// `None` for a zero denominator, or where the reduced fraction does not fit.
    pub(crate) fn new(numerator: i64, denominator: i64) -> Option<Self> {
        if denominator == 0 || numerator == i64::MIN || denominator == i64::MIN {
            return None;
        }
        Some(Self(Ratio::new(numerator, denominator)))
    }

    pub(crate) fn integer(n: i64) -> Self {
        Self(Ratio::new_raw(n, 1))
    }

    fn fitting(ratio: Ratio<i64>) -> Option<Self> {
        (*ratio.numer() != i64::MIN).then_some(Self(ratio))
    }

    pub(crate) fn numerator(self) -> i64 {
        *self.0.numer()
    }

    pub(crate) fn denominator(self) -> i64 {
        *self.0.denom()
    }

    pub(crate) fn is_zero(self) -> bool {
        self.numerator() == 0
    }

    pub(crate) fn is_negative(self) -> bool {
        self.numerator() < 0
    }

    pub(crate) fn as_integer(self) -> Option<i64> {
        (self.denominator() == 1).then_some(self.numerator())
    }

    pub(crate) fn floor(self) -> i64 {
        self.numerator().div_euclid(self.denominator())
    }

    /// `self − floor(self)`, in [0, 1).
    pub(crate) fn fraction(self) -> Self {
        Self(Ratio::new(self.numerator().rem_euclid(self.denominator()), self.denominator()))
    }

    pub(crate) fn add(self, other: Self) -> Option<Self> {
        self.0.checked_add(&other.0).and_then(Self::fitting)
    }

    pub(crate) fn mul(self, other: Self) -> Option<Self> {
        self.0.checked_mul(&other.0).and_then(Self::fitting)
    }

    pub(crate) fn neg(self) -> Self {
        Self(-self.0)
    }

    pub(crate) fn recip(self) -> Option<Self> {
        (!self.is_zero()).then(|| Self(self.0.recip()))
    }

    pub(crate) fn powi(self, exponent: i64) -> Option<Self> {
        let base = if exponent < 0 { self.recip()? } else { self };
        let n = u32::try_from(exponent.unsigned_abs()).ok();
        match (base.numerator(), base.denominator()) {
            (0, _) => return Some(if exponent == 0 { Self::ONE } else { base }),
            (1, 1) => return Some(Self::ONE),
            (-1, 1) => return Some(if exponent % 2 == 0 { Self::ONE } else { base }),
            _ => {}
        }
        let n = n?;
        Self::new(base.numerator().checked_pow(n)?, base.denominator().checked_pow(n)?)
    }

    /// The exact `root`-th root of a positive fraction, if it is rational.
    fn root(self, root: i64) -> Option<Self> {
        let exact = |n: i64| {
            let guess = (n as f64).powf(1.0 / root as f64).round() as i64;
            let power = u32::try_from(root).ok()?;
            (guess - 1..=guess + 1).find(|g| *g > 0 && g.checked_pow(power) == Some(n))
        };
        Self::new(exact(self.numerator())?, exact(self.denominator())?)
    }

    /// `self^exponent` where that is rational, for a positive fraction.
    pub(crate) fn pow(self, exponent: Self) -> Option<Self> {
        if let Some(n) = exponent.as_integer() {
            return self.powi(n);
        }
        if self == Self::ONE {
            return Some(self);
        }
        if self.numerator() <= 0 {
            return None;
        }
        self.root(exponent.denominator())?.powi(exponent.numerator())
    }

    /// Rounded once.
    pub(crate) fn to_f64(self) -> f64 {
        let (n, d) = (self.numerator(), self.denominator());
        if n.abs().max(d) <= EXACT_IN_F64 {
            return n as f64 / d as f64;
        }
        // a quotient of at least 64 digits, in whose last one all that is left counts
        let shift = 127 - u32::min(127, 128 - u128::from(n.unsigned_abs()).leading_zeros());
        let (above, below) = (u128::from(n.unsigned_abs()) << shift, d as u128);
        let quotient = (above / below) | u128::from(above % below != 0);
        quotient as f64 * f64::from(-(shift as i32)).exp2() * n.signum() as f64
    }
}

/// An exact rational, or a float where no exact one fits. Zero is always exact, and so is every float whose
/// shortest decimal is a fraction that converts back to the same float, or has few digits.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Number {
    Exact(Rational),
    /// This fraction, free of factors 2 and 5, times `2^twos 5^fives`: where [`Number::Exact`] does not fit.
    Scaled(Rational, i16, i16),
    Float(f64),
}

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Number::Exact(a), Number::Exact(b)) => a == b,
            (Number::Scaled(a, twos, fives), Number::Scaled(b, c, d)) => (a, twos, fives) == (b, c, d),
            (Number::Float(a), Number::Float(b)) => a.to_bits() == b.to_bits(),
            _ => false,
        }
    }
}

impl Eq for Number {}

impl Hash for Number {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Number::Exact(r) => r.hash(state),
            Number::Scaled(r, twos, fives) => (r, twos, fives).hash(state),
            Number::Float(x) => x.to_bits().hash(state),
        }
    }
}

impl Number {
    pub(crate) const ZERO: Number = Number::Exact(Rational(Ratio::new_raw(0, 1)));
    pub(crate) const ONE: Number = Number::Exact(Rational::ONE);
    pub(crate) const MINUS_ONE: Number = Number::Exact(Rational(Ratio::new_raw(-1, 1)));
    pub(crate) const UNDEFINED: Number = Number::Float(f64::NAN);
    pub(crate) const PI: Number = Number::Exact(Rational(Ratio::new_raw(PI.0, PI.1)));

    pub(crate) fn integer(n: i64) -> Self {
        Self::ratio(n, 1)
    }

    pub(crate) fn ratio(numerator: i64, denominator: i64) -> Self {
        match Rational::new(numerator, denominator) {
            Some(r) => Number::Exact(r),
            None => Self::rounded(numerator as f64 / denominator as f64),
        }
    }

    /// What arithmetic has rounded: never taken for an exact number again, except for zero.
    pub(crate) fn rounded(x: f64) -> Self {
        match x {
            0.0 => Self::ZERO,
            x if x.is_nan() => Self::UNDEFINED,
            x => Number::Float(x),
        }
    }

    pub(crate) fn from_f64(x: f64) -> Self {
        if x.is_nan() {
            return Self::UNDEFINED;
        }
        if x.is_infinite() {
            return Number::Float(x);
        }
        if x == x.trunc() && x.abs() <= EXACT_IN_F64 as f64 {
            return Number::Exact(Rational::integer(x as i64));
        }
        exact_decimal(&format!("{x:e}")).filter(|n| n.to_f64() == x).unwrap_or(Number::Float(x))
    }

    /// A decimal literal such as `9.81` or `1e-3`, exact where it fits; `None` beyond the range of `f64`.
    ///
    /// The digits before `e-0` are those of a float that was rounded, as it is printed.
    pub(crate) fn from_decimal(literal: &str) -> Option<Self> {
        let rounded = literal.ends_with("e-0");
        let x: f64 = literal.parse().ok()?;
        let mantissa = literal.split(['e', 'E']).next().unwrap_or(literal);
        let lost = x == 0.0 && mantissa.bytes().any(|c| matches!(c, b'1'..=b'9'));
        let exact = || Fraction::decimal(literal).and_then(Self::of).filter(|_| !rounded);
        (x.is_finite() && !lost).then(|| exact().unwrap_or(Self::rounded(x)))
    }

    pub(crate) fn to_f64(self) -> f64 {
        match self {
            Number::Exact(r) => r.to_f64(),
            Number::Float(x) => x,
            Number::Scaled(..) => self.fraction().map_or(f64::NAN, Fraction::to_f64),
        }
    }

    /// The number, where it is exact.
    pub(crate) fn fraction(self) -> Option<Fraction> {
        let (r, twos, fives) = match self {
            Number::Exact(r) => (r, 0, 0),
            Number::Scaled(r, twos, fives) => (r, twos, fives),
            Number::Float(_) => return None,
        };
        Fraction::with_powers(r.numerator().into(), r.denominator().into(), twos.into(), fives.into())
    }

    /// `None` where it does not fit.
    pub(crate) fn of(x: Fraction) -> Option<Self> {
        let fitting = |n: i128, d: i128| Rational::new(i64::try_from(n).ok()?, i64::try_from(d).ok()?);
        if let Some(r) = x.plain().and_then(|(n, d)| fitting(n, d)) {
            return Some(Number::Exact(r));
        }
        let (n, d, twos, fives) = x.parts();
        Some(Number::Scaled(fitting(n, d)?, i16::try_from(twos).ok()?, i16::try_from(fives).ok()?))
    }

    pub(crate) fn is_exact(self) -> bool {
        !matches!(self, Number::Float(_))
    }

    pub(crate) fn is_zero(self) -> bool {
        matches!(self, Number::Exact(r) if r.is_zero())
    }

    pub(crate) fn is_one(self) -> bool {
        self == Self::ONE
    }

    pub(crate) fn is_finite(self) -> bool {
        !matches!(self, Number::Float(x) if !x.is_finite())
    }

    pub(crate) fn is_negative(self) -> bool {
        match self {
            Number::Exact(r) | Number::Scaled(r, ..) => r.is_negative(),
            Number::Float(x) => x < 0.0,
        }
    }

    pub(crate) fn abs(self) -> Self {
        if self.is_negative() { self.neg() } else { self }
    }

    fn combine(
        self,
        other: Self,
        exact: fn(Rational, Rational) -> Option<Rational>,
        scaled: fn(Fraction, Fraction) -> Option<Fraction>,
        float: fn(f64, f64) -> f64,
    ) -> Self {
        if let (Number::Exact(a), Number::Exact(b)) = (self, other)
            && let Some(r) = exact(a, b)
        {
            return Number::Exact(r);
        }
        let exact = self.fraction().zip(other.fraction()).and_then(|(a, b)| scaled(a, b)).and_then(Self::of);
        exact.unwrap_or_else(|| Self::rounded(float(self.to_f64(), other.to_f64())))
    }

    pub(crate) fn add(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return if self.is_zero() { other } else { self };
        }
        self.combine(other, Rational::add, Fraction::checked_add, |a, b| a + b)
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        if self.is_one() || other.is_one() {
            return if self.is_one() { other } else { self };
        }
        self.combine(other, Rational::mul, Fraction::checked_mul, |a, b| a * b)
    }

    pub(crate) fn neg(self) -> Self {
        match self {
            Number::Exact(r) => Number::Exact(r.neg()),
            Number::Scaled(r, twos, fives) => Number::Scaled(r.neg(), twos, fives),
            Number::Float(x) => Number::Float(-x),
        }
    }

    /// `1/self`; infinite for zero.
    pub(crate) fn recip(self) -> Self {
        self.powi(-1)
    }

    /// `self^exponent`; infinite for zero to a negative power, and `0^0 = 1`.
    pub(crate) fn powi(self, exponent: i64) -> Self {
        if let Number::Exact(r) = self
            && let Some(power) = r.powi(exponent)
        {
            return Number::Exact(power);
        }
        match exponent {
            0 => return Self::ONE,
            1 => return self,
            _ => {}
        }
        if let Some(power) = self.fraction().and_then(|x| x.powi(exponent)).and_then(Self::of) {
            return power;
        }
        Self::rounded(match i32::try_from(exponent) {
            Ok(n) => self.to_f64().powi(n),
            Err(_) => self.to_f64().powf(exponent as f64),
        })
    }
}

/// `digits[.digits][e±digits]`, where that is an integer, a fraction exact in `f64`, or has few digits: what
/// arithmetic has rounded has more.
fn exact_decimal(literal: &str) -> Option<Number> {
    let n = Fraction::decimal(literal).and_then(Number::of)?;
    let fits =
        |r: Rational| r.denominator() == 1 || r.numerator().abs() <= EXACT_IN_F64 && r.denominator() <= EXACT_IN_F64;
    let mantissa = literal.split(['e', 'E']).next().unwrap_or(literal);
    let digits = || mantissa.replace('.', "").trim_matches('0').len();
    (matches!(n, Number::Exact(r) if fits(r)) || digits() <= f64::DIGITS as usize).then_some(n)
}
