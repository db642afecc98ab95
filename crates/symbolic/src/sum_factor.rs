//! Signs and common factors of sums.

use crate::Expr;
use crate::number::{Number, Rational};

/// c to a power, where that is an exact number
pub(crate) fn exact_power(c: Number, exponent: Rational) -> Option<Number> {
    match c {
        Number::Exact(r) => r.pow(exponent).map(Number::Exact),
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

/// Larger denominators come from measured numbers and stay where they are.
const DENOMINATOR_LIMIT: i64 = 1_000_000;

/// The number to take out of a sum: the greatest common divisor of its coefficients, with its sign;
/// the coefficient itself for a single term.
pub(crate) fn content(constant: Number, terms: &[(Expr, Number)]) -> Number {
    if let [(_, c)] = terms
        && constant.is_zero()
    {
        return *c;
    }
    let sign = if sign_is_negative(terms) { Number::MINUS_ONE } else { Number::ONE };
    let mut numerator = 0_i64;
    let mut denominator = 1_i64;
    let numbers = || terms.iter().map(|(_, c)| *c).chain([constant]);
    for c in numbers() {
        let Number::Exact(r) = c else { return sign };
        numerator = greatest_common_divisor(numerator, r.numerator());
        let shared = greatest_common_divisor(denominator, r.denominator());
        match (denominator / shared).checked_mul(r.denominator()) {
            Some(multiple) if multiple <= DENOMINATOR_LIMIT => denominator = multiple,
            _ => return sign,
        }
    }
    let content = sign.mul(Number::ratio(numerator, denominator));
    // What remains has to fit as well.
    let exact = |n: Number| matches!(n.mul(content.recip()), Number::Exact(_));
    if numbers().all(exact) { content } else { sign }
}

fn greatest_common_divisor(a: i64, b: i64) -> i64 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
