//! Numbers of 107 bits: the unevaluated sum of two `f64`.

use std::ops::{Add, Div, Mul, Neg, Sub};

use symbolic::Scalar;
use twofloat::TwoFloat;

use crate::Wide;

mod functions;

/// A number of about 107 bits (32 decimal digits), the unevaluated sum of two `f64`.
///
/// Sums, differences and products are those of the crate `twofloat` (Joldes, Muller & Popescu 2017, algorithms 6 and 12, relative errors under
/// 3·2⁻¹⁰⁶ and 5·2⁻¹⁰⁶). Its quotient, root and functions are not: `tests/double_double.rs` measures what they lose.
///
/// ```
/// use reference::DoubleDouble;
/// use symbolic::Scalar;
/// let third = DoubleDouble::from_ratio(1, 3);
/// let rest = third * DoubleDouble::from_f64(3.0) - DoubleDouble::from_f64(1.0);
/// assert!(reference::Wide::to_f64(rest).abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble(TwoFloat);

impl DoubleDouble {
    /// 0
    pub const ZERO: DoubleDouble = DoubleDouble(TwoFloat::from_f64(0.0));
    /// 1
    pub const ONE: DoubleDouble = DoubleDouble(TwoFloat::from_f64(1.0));

    /// `high + low`, rounded.
    pub fn sum(high: f64, low: f64) -> Self {
        DoubleDouble(TwoFloat::new_add(high, low))
    }

    /// The `f64` nearest to the number, and what is left.
    pub fn parts(self) -> (f64, f64) {
        (self.0.hi(), self.0.lo())
    }

    fn hi(self) -> f64 {
        self.0.hi()
    }

    /// `self · 2ⁿ`, exact as long as it neither over- nor underflows.
    fn scaled(self, n: i32) -> Self {
        // in two halves: 2ⁿ itself may overflow where the product does not
        let (a, b) = (2.0_f64.powi(n / 2), 2.0_f64.powi(n - n / 2));
        DoubleDouble(self.0 * a * b)
    }

    fn times(self, x: f64) -> Self {
        DoubleDouble(self.0 * x)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        DoubleDouble(self.0 + other.0)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        DoubleDouble(self.0 - other.0)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        DoubleDouble(self.0 * other.0)
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    /// Long division with three digits of base 2⁵³.
    #[inline]
    fn div(self, other: Self) -> Self {
        let first = self.0.hi() / other.0.hi();
        let rest = self.0 - other.0 * first;
        let second = rest.hi() / other.0.hi();
        let rest = rest - other.0 * second;
        let third = rest.hi() / other.0.hi();
        DoubleDouble(TwoFloat::new_add(first, second) + third)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        DoubleDouble(-self.0)
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

impl Wide for DoubleDouble {
    const EPSILON: f64 = 1.0 / (1_u128 << 106) as f64;

    fn to_f64(self) -> f64 {
        self.hi()
    }

    fn is_finite(self) -> bool {
        self.0.hi().is_finite() && self.0.lo().is_finite()
    }
}

impl Scalar for DoubleDouble {
    fn from_f64(x: f64) -> Self {
        DoubleDouble(TwoFloat::from_f64(x))
    }
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        DoubleDouble::from(numerator) / DoubleDouble::from(denominator)
    }
    fn sqrt(self) -> Self {
        functions::sqrt(self)
    }
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
    fn sinh(self) -> Self {
        functions::sinh(self)
    }
    fn cosh(self) -> Self {
        functions::cosh(self)
    }
    fn tanh(self) -> Self {
        functions::tanh(self)
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
    fn asinh(self) -> Self {
        functions::asinh(self)
    }
    fn acosh(self) -> Self {
        functions::acosh(self)
    }
    fn atanh(self) -> Self {
        functions::atanh(self)
    }
    fn exp(self) -> Self {
        functions::exp(self)
    }
    fn log(self) -> Self {
        functions::log(self)
    }
    fn powf(self, exponent: Self) -> Self {
        functions::powf(self, exponent)
    }
    fn atan2(self, x: Self) -> Self {
        functions::atan2(self, x)
    }
}
