//! Zero as a rational function: an expression in a finite field, its symbols and functions random elements.
//!
//! Symbols, roots and functions are taken for independent, only `sin² + cos² = 1` and `cosh² − sinh² = 1` are
//! known, and `tan`, `tanh` as their quotients. So what is zero here is zero for all values of the symbols,
//! wherever a `tanh` or a bump switches on, except with a chance of the degree over 2⁶¹, twice. No float
//! tells it.

use rustc_hash::FxHashMap;

use crate::limits::IN_FIELD;
use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use crate::{Expr, Function, SplitMix};

/// A prime.
const P: u64 = (1 << 61) - 1;

impl Arena {
    /// Whether `e` is zero as a rational function of its symbols, roots and functions; `false` where this is
    /// undecided.
    pub(crate) fn is_zero_rational(&self, e: Expr) -> bool {
        e == Arena::ZERO || (1..=IN_FIELD).all(|seed| self.in_field(e, seed) == Some(0))
    }

    /// Whether `e` is zero, sines and cosines of sums taken apart; `None` where it is not as a rational
    /// function, and has roots, other functions or rounded numbers that may obey more.
    pub(crate) fn is_zero_split(&mut self, e: Expr) -> Option<bool> {
        let e = self.with_split_angles(e);
        let zero = (1..=IN_FIELD).try_fold(true, |zero, seed| Some(zero && self.in_field(e, seed)? == 0))?;
        (zero || self.is_free(e)).then_some(zero)
    }

    /// Whether symbols, sines, cosines and hyperbolic ones are all that `e` is a rational function of.
    fn is_free(&self, e: Expr) -> bool {
        let whole = |exponent: &Rational| exponent.as_integer().is_some();
        self.reachable(&[e], |_| true).into_iter().all(|n| match self.node(n) {
            Node::Number(x) => !matches!(x, Number::Float(_)),
            Node::Symbol(_) => true,
            Node::Sum(constant, terms) => {
                let numbers = terms.iter().map(|(_, c)| c).chain([constant]);
                numbers.into_iter().all(|x| !matches!(x, Number::Float(_)))
            }
            Node::Product(factors) => factors.iter().all(|(_, exponent)| whole(exponent)),
            Node::Call(function, _) => {
                matches!(function, Function::Sin | Function::Cos | Function::Sinh | Function::Cosh)
            }
            Node::Power(..) | Node::Atan2(..) => false,
        })
    }

    /// The value at the point `seed`; `None` where something is divided by zero.
    fn in_field(&self, e: Expr, seed: u64) -> Option<u64> {
        let mut values: FxHashMap<Expr, u64> = FxHashMap::default();
        for n in self.reachable(&[e], |_| true) {
            let of = |n: Expr, kind: u64| random(seed, 4 * u64::from(n.place()) + kind);
            let own = |n: Expr| of(n, 0);
            let value = match self.node(n) {
                Node::Number(x) => number(*x, seed)?,
                Node::Symbol(_) | Node::Power(..) | Node::Atan2(..) => own(n),
                Node::Sum(constant, terms) => terms.iter().try_fold(number(*constant, seed)?, |sum, (t, c)| {
                    Some((sum + times(number(*c, seed)?, values[t])) % P)
                })?,
                Node::Product(factors) => factors.iter().try_fold(1, |product, &(base, exponent)| {
                    Some(times(product, power(values[&base], exponent, of(base, 1))?))
                })?,
                Node::Call(function, u) => {
                    // half an angle's tangent
                    let hyperbolic = matches!(function, Function::Sinh | Function::Cosh | Function::Tanh);
                    let t = of(*u, if hyperbolic { 3 } else { 2 });
                    let square = times(t, t);
                    let (sum, difference) = ((1 + square) % P, (1 + P - square) % P);
                    let over = |a: u64, b: u64| Some(times(a, inverse(b)?));
                    match function {
                        Function::Sin => over(2 * t % P, sum)?,
                        Function::Cos => over(difference, sum)?,
                        Function::Tan => over(2 * t % P, difference)?,
                        Function::Sinh => over(2 * t % P, difference)?,
                        Function::Cosh => over(sum, difference)?,
                        Function::Tanh => over(2 * t % P, sum)?,
                        _ => own(n),
                    }
                }
            };
            values.insert(n, value);
        }
        values.get(&e).copied()
    }
}

/// A number that is not exact is taken for an unknown one.
fn number(x: Number, seed: u64) -> Option<u64> {
    let signed = |size: u64, negative: bool| if negative { (P - size % P) % P } else { size % P };
    let of = |r: Rational| {
        let denominator = inverse(r.denominator().unsigned_abs() % P)?;
        Some(times(signed(r.numerator().unsigned_abs(), r.is_negative()), denominator))
    };
    match x {
        Number::Exact(r) => of(r),
        Number::Scaled(r, twos, fives) => {
            let power = |base: u64, exponent: i16| power(base, Rational::integer(exponent.into()), 0);
            Some(times(of(r)?, times(power(2, twos)?, power(5, fives)?)))
        }
        Number::Float(x) => Some(signed(random(!seed, x.abs().to_bits()), x < 0.0)),
    }
}

/// `base^exponent`, with an element for the root of the base.
fn power(base: u64, exponent: Rational, root: u64) -> Option<u64> {
    let (whole, part) = (exponent.floor(), exponent.numerator().rem_euclid(exponent.denominator()));
    let positive = raised(base, whole.unsigned_abs());
    let whole = if whole < 0 { inverse(positive)? } else { positive };
    let root =
        if part == 0 { 1 } else { raised(random(root, exponent.denominator().unsigned_abs()), part.unsigned_abs()) };
    Some(times(whole, root))
}

/// `a b` modulo `P`: `2⁶¹` is 1.
fn times(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    let sum = (product as u64 & P) + (product >> 61) as u64;
    if sum >= P { sum - P } else { sum }
}

fn raised(mut base: u64, mut exponent: u64) -> u64 {
    let mut power = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            power = times(power, base);
        }
        base = times(base, base);
        exponent >>= 1;
    }
    power
}

fn inverse(a: u64) -> Option<u64> {
    (a != 0).then(|| raised(a, P - 2))
}

/// A pure function of its arguments.
fn random(seed: u64, of: u64) -> u64 {
    SplitMix::new(SplitMix::new(seed).bits() ^ of).bits() % P
}
