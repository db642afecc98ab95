//! Numbers of 107 bits: the unevaluated sum of two `f64`.

use std::ops::{Add, Div, Mul, Neg, Sub};

use mechanics::linear::Entry;
use symbolic::{Scalar, SeriesScalar};

mod functions;

/// About 107 bits (32 decimal digits): the unevaluated sum `high + low` of two `f64`, `|low| ≤ ½ ulp(high)`.
///
/// Sum and product are algorithms 6 and 10 of Joldes, Muller & Popescu 2017 (relative errors under 3·2⁻¹⁰⁶
/// and 5·2⁻¹⁰⁶), the quotient is long division. Why not the crate `twofloat` (0.8.4, against numbers of 300
/// bits): the relative error of its quotient is 1e-16, of exponential and logarithm 1e-11; its fused
/// multiply-add calls a function unless built for one processor: Dekker's exact product is 5 times as fast.
///
/// ```
/// use reference::DoubleDouble;
/// use symbolic::Scalar;
/// let third = DoubleDouble::from_ratio(1, 3);
/// let rest = third * DoubleDouble::from_f64(3.0) - DoubleDouble::from_f64(1.0);
/// assert!(reference::Entry::to_f64(rest).abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// `a + b = s + e` exactly (Knuth).
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let part = s - a;
    (s, (a - (s - part)) + (b - part))
}

/// `a + b = s + e` exactly for `|a| ≥ |b|` (Dekker).
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

/// `a b = p + e` exactly (Dekker), by halves of 26 bits.
#[inline(always)]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let halves = |x: f64| {
        let scaled = 134_217_729.0 * x;
        let upper = scaled - (scaled - x);
        (upper, x - upper)
    };
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    let p = a * b;
    (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
}

impl DoubleDouble {
    /// 0
    pub const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };
    /// 1
    pub const ONE: DoubleDouble = DoubleDouble { high: 1.0, low: 0.0 };

    /// `a + b`, exactly.
    pub fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        DoubleDouble { high, low }
    }

    /// The `f64` nearest to the number, and what is left.
    pub fn parts(self) -> (f64, f64) {
        (self.high, self.low)
    }

    fn hi(self) -> f64 {
        self.high
    }

    fn fast(high: f64, low: f64) -> Self {
        let (high, low) = fast_two_sum(high, low);
        DoubleDouble { high, low }
    }

    /// `self · 2ⁿ`, exact as long as it neither over- nor underflows.
    fn scaled(self, n: i32) -> Self {
        // in two halves: 2ⁿ itself may overflow where the product does not
        let (a, b) = (2.0_f64.powi(n / 2), 2.0_f64.powi(n - n / 2));
        DoubleDouble { high: self.high * a * b, low: self.low * a * b }
    }

    fn times(self, x: f64) -> Self {
        let (p, e) = two_product(self.high, x);
        DoubleDouble::fast(p, e + self.low * x)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = fast_two_sum(s, e + t);
        DoubleDouble::fast(s, e + f)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (p, e) = two_product(self.high, other.high);
        DoubleDouble::fast(p, e + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    /// Long division with three digits of base 2⁵³.
    #[inline]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other.times(first);
        let second = rest.high / other.high;
        let rest = rest - other.times(second);
        let third = rest.high / other.high;
        DoubleDouble::fast(first, second) + DoubleDouble::from_f64(third)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

impl From<i64> for DoubleDouble {
    /// Exact.
    fn from(n: i64) -> Self {
        let high = n as f64;
        let low = i128::from(n) - high as i128;
        DoubleDouble::sum(high, low as f64)
    }
}

impl Entry for DoubleDouble {
    fn size(self) -> f64 {
        self.high.abs()
    }

    const EPSILON: f64 = 1.0 / (1_u128 << 106) as f64;

    fn to_f64(self) -> f64 {
        self.high
    }
}

impl SeriesScalar for DoubleDouble {}

macro_rules! own_functions {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            functions::$name(self)
        }
    )* };
}

impl Scalar for DoubleDouble {
    fn from_f64(x: f64) -> Self {
        DoubleDouble { high: x, low: 0.0 }
    }
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        DoubleDouble::from(numerator) / DoubleDouble::from(denominator)
    }
    own_functions!(sqrt sinh cosh tanh asinh acosh atanh exp log);
    fn sin(self) -> Self {
        functions::sin_cos(self).0
    }
    fn cos(self) -> Self {
        functions::sin_cos(self).1
    }
    fn sin_cos(self) -> (Self, Self) {
        functions::sin_cos(self)
    }
    fn tan(self) -> Self {
        let (sine, cosine) = functions::sin_cos(self);
        sine / cosine
    }
    fn asin(self) -> Self {
        functions::atan2(self, functions::leg(self))
    }
    fn acos(self) -> Self {
        functions::atan2(functions::leg(self), self)
    }
    fn atan(self) -> Self {
        functions::atan2(self, Self::ONE)
    }
    fn powf(self, exponent: Self) -> Self {
        functions::powf(self, exponent)
    }
    fn atan2(self, x: Self) -> Self {
        functions::atan2(self, x)
    }
}
