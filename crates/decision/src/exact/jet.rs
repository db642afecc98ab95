//! Truncated power series as numbers that a tape can be evaluated in.

use std::ops::{Add, Div, Mul, Neg, Sub};

use symbolic::{Fraction, Function, Scalar};

use super::rational::{Exact, PARTS};
use super::{Coefficient, Flaw};

/// Coefficients a series can have, unless it is said otherwise.
pub const ORDERS: usize = 48;

/// `Σ c_k s^k`, known up to `s^{known − 1}`, with no coefficient but zero from `terms` on.
///
/// A constant is known to all orders; its exact value, for functions of it, while rational and moderate.
#[derive(Clone, Copy, Debug)]
pub struct Jet<C, const N: usize = ORDERS> {
    coefficients: [C; N],
    known: usize,
    terms: usize,
    exact: Option<Exact>,
    flaw: Option<Flaw>,
}

impl<C: Coefficient, const N: usize> Jet<C, N> {
    /// The constant `value`.
    pub fn constant(value: C, exact: Option<Exact>) -> Self {
        let mut coefficients = [C::ZERO; N];
        coefficients[0] = value;
        Jet { coefficients, known: N, terms: 1, exact: exact.filter(|_| C::FOLLOWED), flaw: None }
    }

    fn number(x: Result<C, Flaw>, exact: Option<Exact>) -> Self {
        match x {
            Ok(value) => Self::constant(value, exact),
            Err(flaw) => Self::flawed(flaw),
        }
    }

    fn flawed(flaw: Flaw) -> Self {
        Jet { flaw: Some(flaw), ..Self::constant(C::ZERO, None) }
    }

    /// The decimal that `x` is written as.
    pub fn of(x: f64) -> Self {
        if !C::FOLLOWED {
            return Self::number(C::of_float(x), None);
        }
        match Exact::of(x) {
            Ok(exact) => Self::number(C::of(exact), Some(exact)),
            Err(flaw) => Self::flawed(flaw),
        }
    }

    /// The series with these coefficients, all known ones; the first is exactly `exact`, if that is known.
    pub fn series(coefficients: &[C], exact: Option<Exact>) -> Self {
        let known = coefficients.len().min(N);
        let mut all = [C::ZERO; N];
        all[..known].copy_from_slice(&coefficients[..known]);
        Jet { coefficients: all, known, terms: known, exact: exact.filter(|_| C::FOLLOWED), flaw: None }
    }

    /// The same with room for `M` coefficients, as far as they are known.
    pub(crate) fn resized<const M: usize>(&self) -> Jet<C, M> {
        let known = if self.terms == 1 && self.known == N { M } else { self.known.min(M) };
        let coefficients = std::array::from_fn(|k| if k < N { self.coefficients[k] } else { C::ZERO });
        Jet { coefficients, known, terms: self.terms.min(M), exact: self.exact, flaw: self.flaw }
    }

    /// Of `s^k`.
    pub fn coefficient(&self, k: usize) -> C {
        self.coefficients[k]
    }

    /// The constant, where it is known exactly.
    pub fn exact(&self) -> Option<Exact> {
        self.exact
    }

    /// Why its coefficients are not images, if they are none; π in its constant counts.
    pub fn flaw(&self) -> Option<Flaw> {
        self.flaw.or(self.has_pi().then_some(Flaw::Pi))
    }

    /// A flaw that is there already, π in a followed constant not counted.
    pub(crate) fn own_flaw(&self) -> Option<Flaw> {
        self.flaw
    }

    fn has_pi(&self) -> bool {
        self.exact.is_some_and(|x| !x.is_rational())
    }

    /// The result of an operation on `self` and `other` that follows exact constants to `exact`.
    fn combined(&self, other: &Self, terms: usize, exact: Option<Exact>) -> Self {
        let (known, has_pi) = (self.known.min(other.known), self.has_pi() || other.has_pi());
        let flaw = self.flaw.or(other.flaw).or((exact.is_none() && has_pi).then_some(Flaw::Pi));
        Jet { coefficients: [C::ZERO; N], known, terms: terms.min(known).max(1), exact, flaw }
    }

    /// `y` with `y' = u' w` or so: coefficients from 1 on, each from earlier ones; `next(k, y, y')` is
    /// `k y_k`, the rates shifted as [`Jet::slopes`] are.
    fn integrated(&self, first: Result<(C, Option<Exact>), Flaw>, next: impl Fn(usize, &[C; N], &[C; N]) -> C) -> Self {
        let (value, exact) = match first {
            Ok(first) => first,
            Err(flaw) => return Jet { flaw: self.flaw.or(Some(flaw)), ..self.combined(self, 1, self.exact) },
        };
        let mut result = Jet { exact, ..self.combined(self, N, self.exact) };
        result.coefficients[0] = value;
        if self.terms == 1 {
            return Jet { terms: 1, ..result };
        }
        let mut slopes = [C::ZERO; N];
        for k in 1..result.known {
            let Ok(over) = Exact::over(k).and_then(C::of) else {
                return Jet { flaw: self.flaw.or(Some(Flaw::Zero)), ..result };
            };
            slopes[k] = next(k, &result.coefficients, &slopes);
            result.coefficients[k] = slopes[k] * over;
        }
        result
    }

    /// Coefficients of `u'`, shifted: entry k is `k u_k`.
    fn slopes(&self) -> [C; N] {
        let mut slopes = [C::ZERO; N];
        for (k, slope) in slopes.iter_mut().enumerate().take(self.terms).skip(1) {
            if let Ok(times) = Exact::integer(k).and_then(C::of) {
                *slope = self.coefficients[k] * times;
            }
        }
        slopes
    }

    fn recip(self) -> Self {
        Self::constant_one() / self
    }

    fn constant_one() -> Self {
        let one = Exact::ONE;
        Self::number(C::of(one), Some(one))
    }

    fn one_half() -> Self {
        let half = Exact::over(2);
        Self::number(half.and_then(C::of), half.ok())
    }

    fn half(self) -> Self {
        self * Self::one_half()
    }

    /// `u^α` for a constant `α`, from `u y' = α u' y`.
    fn to_power(self, first: Result<(C, Option<Exact>), Flaw>, exponent: Self) -> Self {
        let Some(over) = self.coefficients[0].inverse() else {
            return Jet { flaw: self.flaw.or(Some(Flaw::Zero)), ..self };
        };
        let (alpha, slopes) = (exponent.coefficients[0], self.slopes());
        self.integrated(first, |k, y, rates| {
            // k u₀ y_k = α Σ_j j u_j y_{k−j} − Σ_{j<k} j y_j u_{k−j}
            let sum = alpha * C::convolution(&slopes[1..=k], &y[..k]);
            (sum - C::convolution(&rates[1..k], &self.coefficients[1..k])) * over
        })
    }

    /// A function with the derivative `slope` (a series in the same variable) and the known value `first`.
    fn with_slope(self, first: Result<(C, Option<Exact>), Flaw>, slope: Self) -> Self {
        let slopes = self.slopes();
        let result = self.integrated(first, |k, _, _| C::convolution(&slopes[1..=k], &slope.coefficients[..k]));
        Jet { flaw: result.flaw.or(slope.flaw), ..result }
    }
}

impl<C: Coefficient, const N: usize> Add for Jet<C, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let exact = self.exact.zip(other.exact).and_then(|(a, b)| a.add(b));
        let mut sum = self.combined(&other, self.terms.max(other.terms), exact);
        for k in 0..sum.terms {
            sum.coefficients[k] = self.coefficients[k] + other.coefficients[k];
        }
        sum
    }
}

impl<C: Coefficient, const N: usize> Neg for Jet<C, N> {
    type Output = Self;
    fn neg(self) -> Self {
        let mut negative = Jet { exact: self.exact.map(Exact::neg), ..self };
        for c in &mut negative.coefficients[..self.terms] {
            *c = -*c;
        }
        negative
    }
}

impl<C: Coefficient, const N: usize> Sub for Jet<C, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<C: Coefficient, const N: usize> Mul for Jet<C, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let exact = self.exact.zip(other.exact).and_then(|(a, b)| a.checked_mul(b));
        let mut product = self.combined(&other, self.terms + other.terms - 1, exact);
        // π in a constant would be lost where it meets a coefficient that varies
        let meets = |a: &Self, b: &Self| a.has_pi() && b.terms > 1;
        if meets(&self, &other) || meets(&other, &self) {
            product.flaw = product.flaw.or(Some(Flaw::Pi));
        }
        for k in 0..product.terms {
            let (from, to) = ((k + 1).saturating_sub(other.terms), k.min(self.terms - 1));
            let (a, b) = (&self.coefficients[from..=to], &other.coefficients[k - to..=k - from]);
            product.coefficients[k] = C::convolution(a, b);
        }
        product
    }
}

impl<C: Coefficient, const N: usize> Div for Jet<C, N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let exact = self.exact.zip(other.exact).and_then(|(a, b)| a.checked_mul(b.recip()?));
        let constant = other.terms == 1;
        let mut quotient = self.combined(&other, if constant { self.terms } else { N }, exact);
        let Some(over) = other.coefficients[0].inverse() else {
            quotient.flaw = quotient.flaw.or(Some(Flaw::Zero));
            return quotient;
        };
        if other.has_pi() || (self.has_pi() && !constant) {
            quotient.flaw = quotient.flaw.or(Some(Flaw::Pi));
        }
        for k in 0..quotient.terms {
            let mut rest = self.coefficients[k];
            if k > 0 && !constant {
                rest = rest - C::convolution(&other.coefficients[1..=k], &quotient.coefficients[..k]);
            }
            quotient.coefficients[k] = rest * over;
        }
        quotient
    }
}

/// Functions by their derivatives.
macro_rules! inverse_functions {
    ($($name:ident $function:ident |$x:ident, $one:ident| $slope:expr;)*) => { $(
        fn $name(self) -> Self {
            let ($x, $one) = (self, Self::constant_one());
            let first = self.coefficients[0].inverse_function(Function::$function, self.exact);
            self.with_slope(first, $slope)
        }
    )* };
}

impl<C: Coefficient, const N: usize> Scalar for Jet<C, N> {
    fn from_f64(x: f64) -> Self {
        if x == 1.0 { Self::constant_one() } else { Self::of(x) }
    }

    fn rounded(x: f64) -> Self {
        if C::FOLLOWED { Self::flawed(Flaw::Number) } else { Self::of(x) }
    }

    fn from_ratio(numerator: i64, denominator: i64) -> Self {
        if !C::FOLLOWED {
            return Self::number(C::of_float(numerator as f64 / denominator as f64), None);
        }
        match Fraction::new(numerator.into(), denominator.into()) {
            Some(x) => Self::from_fraction(x),
            None => Self::flawed(Flaw::Zero),
        }
    }

    fn from_fraction(x: Fraction) -> Self {
        if !C::FOLLOWED {
            return Self::of(x.to_f64());
        }
        match Exact::of_formula(x) {
            Ok(exact) => Self::number(C::of(exact), Some(exact)),
            Err(flaw) => Self::flawed(flaw),
        }
    }

    fn sqrt(self) -> Self {
        self.to_power(self.coefficients[0].root(self.exact), Self::one_half())
    }

    fn sin(self) -> Self {
        self.sin_cos().0
    }

    fn cos(self) -> Self {
        self.sin_cos().1
    }

    fn sin_cos(self) -> (Self, Self) {
        let slopes = self.slopes();
        let first = self.coefficients[0].sine_and_cosine(self.exact);
        let begun = |f: fn((C, C)) -> C| {
            let begun = self.integrated(first.map(|values| (f(values), None)), |_, _, _| C::ZERO);
            Jet { terms: 1, ..begun }
        };
        let (mut sine, mut cosine) = (begun(|v| v.0), begun(|v| v.1));
        if let Some(x) = self.exact.filter(|x| x.fraction.is_zero()) {
            // twice the sine of multiples of π/6, where that is an integer
            let value = |turns: i64| {
                let sixths = Some(turns).filter(|turns| turns % (PARTS / 6) == 0)? / (PARTS / 6);
                let twice = [Some(0), Some(1), None, Some(2), None, Some(1)][sixths.rem_euclid(6) as usize]?;
                Exact::ratio(if sixths.rem_euclid(12) < 6 { twice } else { -twice }, 2)
            };
            sine.exact = value(x.turns);
            cosine.exact = value(x.turns + PARTS / 2);
        }
        if self.terms == 1 {
            return (sine, cosine);
        }
        for k in 1..self.known {
            let Ok(over) = Exact::over(k).and_then(C::of) else { continue };
            let forward = C::convolution(&slopes[1..=k], &cosine.coefficients[..k]);
            let backward = C::convolution(&slopes[1..=k], &sine.coefficients[..k]);
            sine.coefficients[k] = forward * over;
            cosine.coefficients[k] = -(backward * over);
        }
        (Jet { terms: self.known, ..sine }, Jet { terms: self.known, ..cosine })
    }

    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    fn sinh(self) -> Self {
        let (up, down) = (self.exp(), (-self).exp());
        (up - down).half()
    }

    fn cosh(self) -> Self {
        let (up, down) = (self.exp(), (-self).exp());
        (up + down).half()
    }

    fn tanh(self) -> Self {
        let (up, down) = (self.exp(), (-self).exp());
        (up - down) / (up + down)
    }

    inverse_functions! {
        asin Asin |x, one| (one - x * x).sqrt().recip();
        acos Acos |x, one| -(one - x * x).sqrt().recip();
        atan Atan |x, one| (one + x * x).recip();
        asinh Asinh |x, one| (one + x * x).sqrt().recip();
        acosh Acosh |x, one| (x * x - one).sqrt().recip();
        atanh Atanh |x, one| (one - x * x).recip();
        log Log |x, _one| x.recip();
    }

    fn exp(self) -> Self {
        let slopes = self.slopes();
        let one = self.exact.filter(|x| x.is_zero()).and_then(|_| Exact::ratio(1, 1));
        let first = self.coefficients[0].exponential(self.exact).map(|x| (x, one));
        self.integrated(first, |k, y, _| C::convolution(&slopes[1..=k], &y[..k]))
    }

    fn powf(self, exponent: Self) -> Self {
        if exponent.terms > 1 || exponent.flaw().is_some() {
            return (exponent * self.log()).exp();
        }
        let first = self.coefficients[0].power(self.exact, exponent.coefficients[0]);
        self.to_power(first.map(|y| (y, None)), exponent)
    }

    fn atan2(self, x: Self) -> Self {
        // the angle of (x, y) has the rate (x y' − y x')/(x² + y²); its value for x > 0 is that of atan(y/x)
        let positive = x.exact.is_some_and(|x| x.is_rational() && !x.is_zero() && !x.fraction.is_negative());
        if positive { (self / x).atan() } else { Jet { flaw: self.flaw.or(Some(Flaw::InverseFunction)), ..self } }
    }
}
