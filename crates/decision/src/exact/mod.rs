//! Truncated power series over a finite field, or over doubles that know their round-off, and the expressions
//! of the graph evaluated on them.

mod dual;
mod element;
mod field;
mod jet;
mod linear;
mod modular;
mod rational;
mod small_fraction;

use symbolic::{Bounded, Scalar};

pub use dual::Dual;
pub use element::Modular;
pub use field::{FIELDS, Field, agreed, in_any_field, in_field};
pub use jet::{Jet, ORDERS};
pub use linear::{Echelon, inverse, nullspace};
pub(crate) use linear::{solve, subtract_product};
pub use mechanics::elimination::Entry;
pub use rational::{Exact, PARTS};

/// Why a number has no image in the finite field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Flaw {
    /// A number that is not a decimal fraction of moderate length, or was rounded.
    #[error("a number of the system is not a fraction of moderate size")]
    Number,
    /// A trigonometric or exponential function of a number that is not rational, or not followed as one.
    #[error("a sine, cosine or exponential is taken of a number at the start that is not known to be rational")]
    Angle,
    /// A root of something else than a product of small primes.
    #[error("a root is taken of a number at the start that is not a rational one made of small primes")]
    Root,
    /// A logarithm of a number other than 1.
    #[error("a logarithm is taken at the start")]
    Logarithm,
    /// An inverse function of a number at which its value is not known.
    #[error("an inverse trigonometric or hyperbolic function is taken at the start")]
    InverseFunction,
    /// A decimal that is a multiple of π in the digits of a double: it may be meant as either.
    #[error("a number is a multiple of pi rounded to a double: write it as a formula, as in \"pi/3\"")]
    Rounded,
    /// An angle that is too fine a part of π.
    #[error("a multiple of pi is not a multiple of pi/720720")]
    Turn,
    /// π outside of trigonometric functions.
    #[error("the number pi stands outside of sines and cosines")]
    Pi,
    /// A division by what is zero, or has the image zero.
    #[error("something at the start is divided by zero")]
    Zero,
}

/// Coefficients of a power series.
pub trait Coefficient: Entry {
    /// Whether functions of constants need these exactly.
    const FOLLOWED: bool;
    /// The image of an exact number.
    fn of(x: Exact) -> Result<Self, Flaw>;
    /// A double as it is.
    fn of_float(x: f64) -> Result<Self, Flaw>;
    /// `Σ a_i b_{m−1−i}`.
    fn convolution(a: &[Self], b: &[Self]) -> Self;
    /// `(sin x, cos x)`.
    fn sine_and_cosine(self, exact: Option<Exact>) -> Result<(Self, Self), Flaw>;
    /// `e^x`.
    fn exponential(self, exact: Option<Exact>) -> Result<Self, Flaw>;
    /// The square root, and that exactly where it is rational.
    fn root(self, exact: Option<Exact>) -> Result<(Self, Option<Exact>), Flaw>;
    /// The value of a function whose value is known at few points only.
    fn inverse_function(
        self,
        function: symbolic::Function,
        exact: Option<Exact>,
    ) -> Result<(Self, Option<Exact>), Flaw>;
    /// `self^exponent` where that is not an integer.
    fn power(self, exact: Option<Exact>, exponent: Self) -> Result<Self, Flaw>;
}

impl Entry for Modular {
    const ZERO: Self = Modular::ZERO;

    fn inverse(self) -> Option<Self> {
        Modular::inverse(self)
    }

    fn weight(self) -> f64 {
        if self.is_zero() { 0.0 } else { 1.0 }
    }

    fn subtract_multiples(into: &mut [Self], factors: &[Self], rows: &[Self]) {
        Modular::subtract_multiples(into, factors, rows);
    }
}

impl Coefficient for Modular {
    const FOLLOWED: bool = true;

    fn of(x: Exact) -> Result<Self, Flaw> {
        // a multiple of π stays outside of the value; it is known from the exact number
        Modular::fraction(x).ok_or(Flaw::Number)
    }

    fn of_float(_: f64) -> Result<Self, Flaw> {
        Err(Flaw::Number)
    }

    fn convolution(a: &[Self], b: &[Self]) -> Self {
        Modular::convolution(a, b)
    }

    fn sine_and_cosine(self, exact: Option<Exact>) -> Result<(Self, Self), Flaw> {
        Modular::sine_and_cosine(exact.ok_or(Flaw::Angle)?)
    }

    fn exponential(self, exact: Option<Exact>) -> Result<Self, Flaw> {
        Modular::exponential(exact.ok_or(Flaw::Angle)?)
    }

    fn root(self, exact: Option<Exact>) -> Result<(Self, Option<Exact>), Flaw> {
        Modular::root(exact.ok_or(Flaw::Root)?)
    }

    fn inverse_function(
        self,
        function: symbolic::Function,
        exact: Option<Exact>,
    ) -> Result<(Self, Option<Exact>), Flaw> {
        use symbolic::Function::{Acos, Log};
        let unknown = if function == Log { Flaw::Logarithm } else { Flaw::InverseFunction };
        let x = exact.ok_or(unknown)?;
        let one = Exact::ratio(1, 1);
        match function {
            Log | Acos if Some(x) == one => Ok((Self::ZERO, Some(Exact::ZERO))),
            Acos if x.is_zero() => Ok((Self::ZERO, Some(Exact::QUARTER))),
            Log | Acos => Err(unknown),
            _ if x.is_zero() => Ok((Self::ZERO, Some(Exact::ZERO))),
            _ => Err(unknown),
        }
    }

    fn power(self, exact: Option<Exact>, _: Self) -> Result<Self, Flaw> {
        if exact.is_some_and(|x| Some(x) == Exact::ratio(1, 1)) { Ok(Modular::one()) } else { Err(Flaw::Root) }
    }
}

/// Numbers that know what of them may be round-off.
impl Coefficient for Bounded {
    const FOLLOWED: bool = false;

    fn of(x: Exact) -> Result<Self, Flaw> {
        Ok(Bounded::from_f64(x.to_f64()))
    }

    fn of_float(x: f64) -> Result<Self, Flaw> {
        Ok(Bounded::from_f64(x))
    }

    fn convolution(a: &[Self], b: &[Self]) -> Self {
        a.iter().zip(b.iter().rev()).fold(Self::ZERO, |sum, (&a, &b)| sum + a * b)
    }

    fn sine_and_cosine(self, _: Option<Exact>) -> Result<(Self, Self), Flaw> {
        Ok(self.sin_cos())
    }

    fn exponential(self, _: Option<Exact>) -> Result<Self, Flaw> {
        Ok(self.exp())
    }

    fn root(self, _: Option<Exact>) -> Result<(Self, Option<Exact>), Flaw> {
        Ok((self.sqrt(), None))
    }

    fn inverse_function(self, function: symbolic::Function, _: Option<Exact>) -> Result<(Self, Option<Exact>), Flaw> {
        Ok((function.apply(self), None))
    }

    fn power(self, _: Option<Exact>, exponent: Self) -> Result<Self, Flaw> {
        Ok(self.powf(exponent))
    }
}
