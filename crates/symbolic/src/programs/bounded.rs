//! Numbers with an estimate of their round-off: running error analysis.

use crate::Scalar;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Added in every product, so that what underflows counts as round-off.
const UNDERFLOW: f64 = 1e-300;

/// A value and its round-off measure: the sum of the magnitudes of all intermediate results, each times the
/// derivative of the value by it.
///
/// ```
/// use std::collections::HashMap;
/// use symbolic::{Bounded, Graph, Scalar};
/// let g = Graph::new();
/// let x = g.variable(g.symbol("x"));
/// // x(x + 2) + 1 − (x + 1)² is zero, and in numbers nearly so
/// let two = g.integer(2);
/// let rest = g.sum(&[g.mul(x, g.add(x, two)), g.one(), g.neg(g.powi(g.add(x, g.one()), 2))]);
/// let tape = g.compile(&[g.as_symbol(x).unwrap()], &[rest], &HashMap::new())?;
/// let mut value = [Bounded::from_f64(0.0)];
/// tape.evaluate(&[Bounded::from_f64(0.7)], &mut tape.workspace(), &mut value);
/// assert!(value[0].may_be_zero() && value[0].magnitude > 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    /// The value.
    pub value: f64,
    /// The sum of magnitudes behind it.
    pub magnitude: f64,
}

impl Bounded {
    /// A value below this fraction of its magnitude counts as round-off.
    pub const ROUND_OFF: f64 = 1e-11;

    /// Bound of the round-off in the value.
    pub fn round_off(self) -> f64 {
        Self::ROUND_OFF * self.magnitude
    }

    /// Whether the value is zero up to round-off.
    pub fn may_be_zero(self) -> bool {
        self.value.abs() <= self.round_off()
    }

    /// The magnitude; zero where it is what underflows.
    pub fn size(self) -> f64 {
        if self.magnitude * f64::EPSILON > UNDERFLOW { self.magnitude } else { 0.0 }
    }

    /// Whether value and magnitude are finite.
    pub fn is_finite(self) -> bool {
        self.value.is_finite() && self.magnitude.is_finite()
    }

    /// f(x), where `slope` is f'(x)
    fn mapped(self, value: f64, slope: f64) -> Self {
        Self { value, magnitude: value.abs() + slope.abs() * self.magnitude + UNDERFLOW }
    }
}

impl Add for Bounded {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self { value: self.value + b.value, magnitude: self.magnitude + b.magnitude }
    }
}

impl Sub for Bounded {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self { value: self.value - b.value, magnitude: self.magnitude + b.magnitude }
    }
}

impl Mul for Bounded {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let magnitude = self.magnitude * b.value.abs() + self.value.abs() * b.magnitude;
        Self { value: self.value * b.value, magnitude: magnitude + UNDERFLOW }
    }
}

impl Div for Bounded {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        let magnitude = (self.magnitude + value.abs() * b.magnitude) / b.value.abs();
        Self { value, magnitude: magnitude + UNDERFLOW }
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, magnitude: self.magnitude }
    }
}

/// Functions `y` of `x` with their slopes.
macro_rules! mapped {
    ($x:ident, $y:ident: $($name:ident $slope:expr;)*) => { $(
        #[allow(unused_variables)] // a slope may need one of the two only
        fn $name(self) -> Self {
            let $x = self.value;
            let $y = Scalar::$name($x);
            self.mapped($y, $slope)
        }
    )* };
}

impl Scalar for Bounded {
    fn from_f64(x: f64) -> Self {
        Self { value: x, magnitude: x.abs() }
    }
    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        Self::from_f64(numerator as f64 / denominator as f64)
    }
    mapped! { x, y:
        sqrt 0.5 / y;
        sin x.cos();
        cos x.sin();
        tan 1.0 + y * y;
        sinh x.cosh();
        cosh x.sinh();
        tanh 1.0 - y * y;
        asin 1.0 / (1.0 - x * x).sqrt();
        acos 1.0 / (1.0 - x * x).sqrt();
        atan 1.0 / (1.0 + x * x);
        asinh 1.0 / (1.0 + x * x).sqrt();
        acosh 1.0 / (x * x - 1.0).sqrt();
        atanh 1.0 / (1.0 - x * x);
        exp y;
        logistic y * (-x).logistic();
        sech y * x.tanh();
        log 1.0 / x;
    }
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let by_base = self.magnitude * (exponent.value * value / self.value).abs();
        let by_exponent = exponent.magnitude * (value * self.value.ln()).abs();
        let by_exponent = if by_exponent.is_nan() { 0.0 } else { by_exponent };
        Self { value, magnitude: value.abs() + by_base + by_exponent + UNDERFLOW }
    }
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        // Round-off decides on which side of the cut the angle is: the point says nothing.
        if self.may_be_zero() && (x.value < 0.0 || x.may_be_zero()) {
            return Self { value, magnitude: f64::INFINITY };
        }
        let square = x.value * x.value + self.value * self.value;
        let slopes = x.value.abs() * self.magnitude + self.value.abs() * x.magnitude;
        Self { value, magnitude: value.abs() + slopes / square }
    }
}
