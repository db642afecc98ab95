//! The number types a [`Tape`](crate::Tape) can be evaluated in.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::Fraction;

/// A real number type: what a [`Tape`](crate::Tape) needs to be evaluated in it.
///
/// Angles are in radians. Outside its domain a function gives the type's "not a number".
///
/// ```
/// use symbolic::Scalar;
/// assert_eq!(<f64 as Scalar>::from_ratio(981, 100), 9.81);
/// ```
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The number nearest to `x`.
    fn from_f64(x: f64) -> Self;
    /// `numerator / denominator`, rounded in this type.
    fn from_ratio(numerator: i64, denominator: i64) -> Self;
    /// A fraction beyond 64 bits, rounded in this type.
    fn from_fraction(x: Fraction) -> Self {
        Self::from_f64(x.to_f64())
    }
    /// A number of a formula that is known as this float only: with too many digits, or rounded by
    /// arithmetic.
    fn rounded(x: f64) -> Self {
        Self::from_f64(x)
    }
    /// √x
    fn sqrt(self) -> Self;
    /// sin x
    fn sin(self) -> Self;
    /// cos x
    fn cos(self) -> Self;
    /// (sin x, cos x)
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    /// tan x
    fn tan(self) -> Self;
    /// sinh x
    fn sinh(self) -> Self;
    /// cosh x
    fn cosh(self) -> Self;
    /// tanh x
    fn tanh(self) -> Self;
    /// arcsin x
    fn asin(self) -> Self;
    /// arccos x
    fn acos(self) -> Self;
    /// arctan x
    fn atan(self) -> Self;
    /// arsinh x
    fn asinh(self) -> Self;
    /// arcosh x
    fn acosh(self) -> Self;
    /// artanh x
    fn atanh(self) -> Self;
    /// eˣ
    fn exp(self) -> Self;
    /// 1/(1 + e⁻ˣ), between 0 and 1 for all x
    fn logistic(self) -> Self {
        Self::from_f64(1.0) / (Self::from_f64(1.0) + (-self).exp())
    }
    /// 1/cosh x, between 0 and 1 for all x
    fn sech(self) -> Self {
        Self::from_f64(1.0) / self.cosh()
    }
    /// natural logarithm of x
    fn log(self) -> Self;
    /// x to a real power
    fn powf(self, exponent: Self) -> Self;
    /// The angle of the point (x, y), with `self` as y.
    fn atan2(self, x: Self) -> Self;
    /// Runs `task`, which evaluates a tape, with the instructions that are best for this type.
    fn vectorize<F: FnOnce()>(task: F) {
        task();
    }
}

macro_rules! own_functions {
    ($($name:ident)*) => { $(
        #[inline]
        fn $name(self) -> f64 {
            f64::$name(self)
        }
    )* };
}

impl Scalar for f64 {
    #[inline]
    fn from_f64(x: f64) -> f64 {
        x
    }
    fn from_ratio(numerator: i64, denominator: i64) -> f64 {
        numerator as f64 / denominator as f64
    }
    own_functions!(sqrt sin cos tan sinh cosh tanh asin acos atan asinh acosh atanh exp);
    #[inline]
    fn sin_cos(self) -> (f64, f64) {
        f64::sin_cos(self)
    }
    fn log(self) -> f64 {
        f64::ln(self)
    }
    fn powf(self, exponent: f64) -> f64 {
        f64::powf(self, exponent)
    }
    fn atan2(self, x: f64) -> f64 {
        f64::atan2(self, x)
    }
}
