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

    /// What is 0 and has a slope is no pivot, and is not 0.
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

#[cfg(test)]
mod tests {
    use super::super::{FIELDS, Jet, in_field};
    use super::*;
    use symbolic::Scalar;

    fn at(x: Exact) -> Jet<Dual> {
        Jet::constant(Dual::variable(Modular::of(x).unwrap()), Some(x))
    }

    fn value(n: i128, d: i128) -> Modular {
        Modular::of(Exact::ratio(n, d).unwrap()).unwrap()
    }

    /// Against derivatives by hand, at 9/4 and at 1.
    #[test]
    fn slopes_are_derivatives() {
        in_field(&FIELDS[1], || {
            let x = at(Exact::ratio(9, 4).unwrap());
            let slope = |y: Jet<Dual>| (y.coefficient(0).slope, y.flaw());
            let one = Jet::<Dual>::from_f64(1.0);
            assert_eq!(slope(x.sqrt()), (value(1, 3), None));
            assert_eq!(slope(one / x), (value(-16, 81), None));
            assert_eq!(slope(x * x * x), (value(243, 16), None));
            let (sine, cosine) = x.sin_cos();
            assert_eq!(slope(sine), (cosine.coefficient(0).value, None));
            assert_eq!(slope(cosine), (-sine.coefficient(0).value, None));
            assert_eq!(slope(x.tan() * cosine * cosine).0, slope(sine * cosine).0);
            assert_eq!(slope(x.exp()).0, x.exp().coefficient(0).value);
            let unit = at(Exact::ONE);
            assert_eq!(slope(unit.log()), (Modular::one(), None));
            assert_eq!(slope(unit.powf(Jet::of(2.5))), (value(5, 2), None));
            let zero = at(Exact::ZERO);
            assert_eq!(slope(zero.acos()).0, -Modular::one());
            assert_eq!(slope(zero.atan()), (Modular::one(), None));
            assert!(slope(unit.acos()).1.is_some() && slope(zero.sqrt()).1.is_some());
        });
    }
}
