//! Signs and common factors of sums.

use crate::limits::FRACTION;
use crate::store::fraction::divisor;
use crate::store::number::{Number, Rational};
use crate::{Expr, Fraction};

/// c to a power, where that is an exact number
pub(crate) fn exact_power(c: Number, exponent: Rational) -> Option<Number> {
    match c {
        Number::Exact(r) => r.pow(exponent).map(Number::Exact),
        Number::Scaled(r, twos, fives) => {
            let times = |n: i16| exponent.mul(Rational::integer(n.into()))?.as_integer();
            let power = |base: i64, n: i16| Some(Number::integer(base).powi(times(n)?));
            Some(Number::Exact(r.pow(exponent)?).mul(power(2, twos)?).mul(power(5, fives)?))
        }
        Number::Float(_) => None,
    }
}

/// More negative terms than positive ones; of equally many, the last decides.
pub(crate) fn sign_is_negative(terms: &[(Expr, Number)]) -> bool {
    let negative = terms.iter().filter(|(_, c)| c.is_negative()).count();
    match (2 * negative).cmp(&terms.len()) {
        std::cmp::Ordering::Less => false,
        std::cmp::Ordering::Greater => true,
        std::cmp::Ordering::Equal => terms.last().is_some_and(|(_, c)| c.is_negative()),
    }
}

/// The number to take out of a sum: the greatest common divisor of its coefficients, with its sign;
/// the coefficient itself for a single term.
pub(crate) fn content(constant: Number, terms: &[(Expr, Number)]) -> Number {
    if let [(_, c)] = terms
        && constant.is_zero()
    {
        return *c;
    }
    let sign = if sign_is_negative(terms) { Number::MINUS_ONE } else { Number::ONE };
    let mut numerator = 0;
    let mut denominator = 1_i64;
    // powers of two and five of their own come out first
    let (mut twos, mut fives) = (0, 0);
    let numbers = || terms.iter().map(|(_, c)| *c).chain([constant]);
    if numbers().any(|c| matches!(c, Number::Scaled(..))) {
        let parts = numbers().filter(|c| !c.is_zero()).filter_map(Number::fraction).map(Fraction::parts);
        let least = parts.map(|(.., twos, fives)| (twos, fives)).reduce(|a, b| (a.0.min(b.0), a.1.min(b.1)));
        (twos, fives) = least.unwrap_or_default();
    }
    let unit = Number::integer(2).powi(twos.into()).mul(Number::integer(5).powi(fives.into()));
    for c in numbers() {
        let Number::Exact(r) = (if unit.is_one() { c } else { c.mul(unit.recip()) }) else { return sign };
        numerator = divisor(numerator, r.numerator().into());
        let shared = divisor(denominator.into(), r.denominator().into()) as i64;
        match (denominator / shared).checked_mul(r.denominator()) {
            Some(multiple) if multiple <= FRACTION => denominator = multiple,
            _ => return sign,
        }
    }
    let content = sign.mul(Number::ratio(numerator as i64, denominator)).mul(unit);
    // What remains has to fit as well.
    let exact = |n: Number| matches!(n.mul(content.recip()), Number::Exact(_));
    if numbers().all(exact) { content } else { sign }
}
