//! Dual numbers over the field: elements with their derivatives by one number.

use std::ops::{Add, Mul, Neg, Sub};

use symbolic::Function;

use super::{Coefficient, Entry, Exact, Flaw, Modular};

/// `value + slope ε` with `ε² = 0`: as a coefficient of a series, that of its derivative stands beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dual {
    /// The element.
    pub value: Modular,
    /// Its derivative.
    pub slope: Modular,
}

impl Dual {
    /// The number by which derivatives are taken, here `value`.
    pub fn variable(value: Modular) -> Self {
        Dual { value, slope: Modular::one() }
    }

    /// `f(self)`, for the value of `f` and its derivative there.
    fn through(self, value: Modular, derivative: Modular) -> Self {
        Dual { value, slope: derivative * self.slope }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Dual { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Dual { value: -self.value, slope: -self.slope }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Dual { value: self.value * other.value, slope: self.value * other.slope + self.slope * other.value }
    }
}

impl Entry for Dual {
    const ZERO: Self = Dual { value: Modular::ZERO, slope: Modular::ZERO };

    fn inverse(self) -> Option<Self> {
        let over = self.value.inverse()?;
        Some(self.through(over, -(over * over)))
    }

    /// What is 0 and has a slope is not a pivot, and is not 0.
    fn weight(self) -> f64 {
        if self.value.is_zero() { 0.5 * self.slope.weight() } else { 1.0 }
    }
}

impl Coefficient for Dual {
    const FOLLOWED: bool = true;

    fn of(x: Exact) -> Result<Self, Flaw> {
        Ok(Dual { value: Modular::of(x)?, slope: Modular::ZERO })
    }

    fn of_float(_: f64) -> Result<Self, Flaw> {
        Err(Flaw::Number)
    }

    fn convolution(a: &[Self], b: &[Self]) -> Self {
        a.iter().zip(b.iter().rev()).fold(Self::ZERO, |sum, (&a, &b)| sum + a * b)
    }

    fn sine_and_cosine(self, exact: Option<Exact>) -> Result<(Self, Self), Flaw> {
        let (sine, cosine) = self.value.sine_and_cosine(exact)?;
        Ok((self.through(sine, cosine), self.through(cosine, -sine)))
    }

    fn exponential(self, exact: Option<Exact>) -> Result<Self, Flaw> {
        let value = Coefficient::exponential(self.value, exact)?;
        Ok(self.through(value, value))
    }

    fn root(self, exact: Option<Exact>) -> Result<(Self, Option<Exact>), Flaw> {
        let (value, exact) = Coefficient::root(self.value, exact)?;
        match (value + value).inverse() {
            Some(over) => Ok((self.through(value, over), exact)),
            None if self.slope.is_zero() => Ok((Self::ZERO, exact)),
            None => Err(Flaw::Zero),
        }
    }

    fn inverse_function(self, function: Function, exact: Option<Exact>) -> Result<(Self, Option<Exact>), Flaw> {
        let (value, of_value) = self.value.inverse_function(function, exact)?;
        // the values are those at 0, of the logarithm and the inverse cosine at 1
        let derivative = match function {
            Function::Acos if self.value.is_zero() => -Modular::one(),
            Function::Acos | Function::Acosh if !self.slope.is_zero() => return Err(Flaw::InverseFunction),
            _ => Modular::one(),
        };
        Ok((self.through(value, derivative), of_value))
    }

    fn power(self, exact: Option<Exact>, exponent: Self) -> Result<Self, Flaw> {
        // that of 1
        let value = Coefficient::power(self.value, exact, exponent.value)?;
        Ok(self.through(value, exponent.value))
    }
}
