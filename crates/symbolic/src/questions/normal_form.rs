//! Normal forms in which an identity becomes the number zero.

use crate::limits::{LONG, PRIMES};
use crate::store::arena::{Arena, Node};
use crate::store::expand::Shifts;
use crate::store::number::{Number, Rational};
use crate::{Expr, Function, Graph};
use rustc_hash::FxHashMap;

/// sin(n u) is taken apart up to this n.
const MULTIPLE_LIMIT: i64 = 8;
/// Rounds of clearing denominators.
const ROUNDS: usize = 4;

impl Graph {
    /// A formula of numbers in the simplest form that is known: a number, where multiples of π/12 under sines
    /// and roots of numbers cancel to one.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let half = g.call(symbolic::Function::Cos, g.mul(g.ratio(1, 3), g.pi()));
    /// assert_eq!(g.constant(half), g.ratio(1, 2));
    /// ```
    pub fn constant(&self, e: Expr) -> Expr {
        let mut arena = self.arena.borrow_mut();
        let split = arena.with_split_angles(e);
        let number = arena.expand(split, LONG, Shifts::Expanded);
        if arena.as_number(number).is_some_and(Number::is_exact) { number } else { e }
    }
}

impl Arena {
    /// The numerator of `e` in sines, cosines, roots and symbols, sin² = 1 − cos²; `None` over `limit` terms.
    ///
    /// It is zero only if `e` is; an identity between other functions it may miss.
    pub(crate) fn normal_numerator(&mut self, e: Expr, limit: usize) -> Option<Expr> {
        let mut e = self.with_split_angles(e);
        for _ in 0..ROUNDS {
            e = self.expand(e, limit, Shifts::Expanded);
            e = self.without_even_sines(e);
            e = self.expand(e, limit, Shifts::Expanded);
            if self.term_count(e) > limit {
                return None;
            }
            let cleared = self.cleared(e);
            if cleared == e {
                break;
            }
            e = cleared;
        }
        Some(e)
    }

    pub(crate) fn term_count(&self, e: Expr) -> usize {
        match self.node(e) {
            Node::Sum(_, terms) => terms.len(),
            _ => 1,
        }
    }

    /// tan = sin/cos, and sines and cosines of sums by the addition theorems; in the same way hyperbolic
    /// ones. Those of multiples of π/12 are made of √2 and √3, and roots of numbers of those of primes.
    pub(crate) fn with_split_angles(&mut self, e: Expr) -> Expr {
        let split = |arena: &mut Arena, e: Expr| match arena.node(e) {
            &Node::Call(function, argument) => arena.split_call(function, argument).unwrap_or(e),
            Node::Product(factors) => {
                let factors = factors.clone();
                arena.with_prime_roots(&factors).unwrap_or(e)
            }
            _ => e,
        };
        self.rewritten(&[e], split)[0]
    }

    /// The product, if a number stands under a root in it.
    fn with_prime_roots(&mut self, factors: &[(Expr, Rational)]) -> Option<Expr> {
        let whole = |arena: &Arena, base: Expr| match arena.as_number(base) {
            Some(Number::Exact(r)) => r.as_integer(),
            _ => None,
        };
        factors.iter().find(|(base, _)| whole(self, *base).is_some())?;
        let mut all = Vec::new();
        for &(base, exponent) in factors {
            let Some(mut rest) = whole(self, base) else {
                all.push((base, exponent));
                continue;
            };
            for prime in 2..PRIMES {
                while rest % prime == 0 && rest != 0 {
                    rest /= prime;
                    all.push((self.number(Number::integer(prime)), exponent));
                }
            }
            all.push((self.number(Number::integer(rest)), exponent));
        }
        Some(self.power_product(Number::ONE, all))
    }

    fn split_call(&mut self, function: Function, argument: Expr) -> Option<Expr> {
        let hyperbolic = match function {
            Function::Sin | Function::Cos | Function::Tan => false,
            Function::Sinh | Function::Cosh | Function::Tanh => true,
            _ => return None,
        };
        let (sine, cosine) = self.sine_and_cosine(argument, hyperbolic);
        Some(match function {
            Function::Sin | Function::Sinh => sine,
            Function::Cos | Function::Cosh => cosine,
            _ => self.power_product(Number::ONE, vec![(sine, Rational::ONE), (cosine, Rational::integer(-1))]),
        })
    }

    /// (sin u, cos u) or (sinh u, cosh u) in terms of those of the parts of u.
    fn sine_and_cosine(&mut self, u: Expr, hyperbolic: bool) -> (Expr, Expr) {
        let Node::Sum(constant, terms) = self.node(u).clone() else {
            return self.plain_pair(u, hyperbolic);
        };
        // cosh(250) − sinh(250) is 0 in numbers, and 1 + tanh(x − 250) is not
        if terms.len() > 4 || hyperbolic && !constant.is_zero() {
            return self.plain_pair(u, hyperbolic);
        }
        let mut total = (Self::ZERO, Self::ONE);
        if !constant.is_zero() {
            let constant = self.number(constant);
            total = self.plain_pair(constant, hyperbolic);
        }
        for (t, c) in terms.iter() {
            // The integer multiple of a unit, so that 3x/2 and x/2 share the unit x/2.
            let (times, unit) = match c {
                Number::Exact(r) if r.numerator().abs() <= MULTIPLE_LIMIT => {
                    (r.numerator(), Number::ratio(1, r.denominator()))
                }
                _ => (1, *c),
            };
            let unit = self.scale(unit, *t);
            let single = self.plain_pair(unit, hyperbolic);
            for _ in 0..times.abs() {
                let part = if times < 0 { (self.scale(Number::MINUS_ONE, single.0), single.1) } else { single };
                total = self.added_angles(total, part, hyperbolic);
            }
        }
        total
    }

    /// `(sin u, cos u)` of a multiple `u` of π/12.
    fn at_twelfth(&mut self, u: Expr) -> Option<(Expr, Expr)> {
        let twelfths = self.as_number(u)?.mul(Number::PI.recip()).mul(Number::integer(12));
        let Number::Exact(twelfths) = twelfths else { return None };
        let k = twelfths.as_integer()?;
        let mut sine = |k: i64| {
            let (k, sign) = if k.rem_euclid(24) < 12 { (k.rem_euclid(12), 1) } else { (k.rem_euclid(12), -1) };
            // a + b √2 + c √3 + d √6
            let quarters = match k.min(12 - k) {
                0 => [0, 0, 0, 0],
                1 => [0, -1, 0, 1],
                2 => [2, 0, 0, 0],
                3 => [0, 2, 0, 0],
                4 => [0, 0, 2, 0],
                5 => [0, 1, 0, 1],
                _ => [4, 0, 0, 0],
            };
            let half = Rational::new(1, 2)?;
            let [two, three] = [2, 3].map(|n| self.number(Number::integer(n)));
            let roots = [vec![], vec![(two, half)], vec![(three, half)], vec![(two, half), (three, half)]];
            let roots = roots.map(|factors| self.power_product(Number::ONE, factors));
            let terms = roots.into_iter().zip(quarters.map(|n| Number::ratio(sign * n, 4))).collect();
            Some(self.linear(Number::ZERO, terms))
        };
        Some((sine(k)?, sine(k.checked_add(6)?)?))
    }

    fn plain_pair(&mut self, u: Expr, hyperbolic: bool) -> (Expr, Expr) {
        if let Some(pair) = self.at_twelfth(u).filter(|_| !hyperbolic) {
            pair
        } else if hyperbolic {
            (self.call(Function::Sinh, u), self.call(Function::Cosh, u))
        } else {
            (self.call(Function::Sin, u), self.call(Function::Cos, u))
        }
    }

    /// sin(a+b) = sin a cos b + cos a sin b, cos(a+b) = cos a cos b ∓ sin a sin b
    fn added_angles(&mut self, a: (Expr, Expr), b: (Expr, Expr), hyperbolic: bool) -> (Expr, Expr) {
        let sign = if hyperbolic { Number::ONE } else { Number::MINUS_ONE };
        let (sc, cs) = (self.multiply_out(a.0, b.1), self.multiply_out(a.1, b.0));
        let (cc, ss) = (self.multiply_out(a.1, b.1), self.multiply_out(a.0, b.0));
        let sine = self.linear(Number::ZERO, vec![(sc, Number::ONE), (cs, Number::ONE)]);
        let cosine = self.linear(Number::ZERO, vec![(cc, Number::ONE), (ss, sign)]);
        (sine, cosine)
    }

    /// sin² = 1 − cos², sinh² = cosh² − 1, in every power of at least 2.
    fn without_even_sines(&mut self, e: Expr) -> Expr {
        let without = |arena: &mut Arena, e: Expr| {
            let Node::Product(factors) = arena.node(e).clone() else { return e };
            let mut replaced = Vec::with_capacity(factors.len());
            factors.iter().for_each(|&(base, exponent)| arena.replace_even_sine(base, exponent, &mut replaced));
            arena.power_product(Number::ONE, replaced)
        };
        self.rewritten(&[e], without)[0]
    }

    fn replace_even_sine(&mut self, base: Expr, exponent: Rational, factors: &mut Vec<(Expr, Rational)>) {
        let (function, argument, sign) = match *self.node(base) {
            Node::Call(Function::Sin, u) => (Function::Cos, u, 1),
            Node::Call(Function::Sinh, u) => (Function::Cosh, u, -1),
            _ => return factors.push((base, exponent)),
        };
        let Some(n) = exponent.as_integer().filter(|n| n.abs() >= 2) else {
            return factors.push((base, exponent));
        };
        let cosine = self.call(function, argument);
        let square = self.times(&[cosine, cosine]);
        let replacement = self.linear(Number::integer(sign), vec![(square, Number::integer(-sign))]);
        factors.push((replacement, Rational::integer(n / 2)));
        factors.push((base, Rational::integer(n % 2)));
    }

    /// A sum times the greatest denominator of its terms.
    fn cleared(&mut self, e: Expr) -> Expr {
        let terms: Vec<Expr> = match self.node(e) {
            Node::Sum(_, terms) => terms.iter().map(|(t, _)| *t).collect(),
            _ => vec![e],
        };
        let mut lowest: FxHashMap<Expr, Rational> = FxHashMap::default();
        for t in terms {
            let Node::Product(factors) = self.node(t) else {
                continue;
            };
            for (base, exponent) in factors.iter().filter(|(_, r)| r.is_negative()) {
                let least = lowest.entry(*base).or_insert(*exponent);
                *least = (*least).min(*exponent);
            }
        }
        if lowest.is_empty() {
            return e;
        }
        let mut factors: Vec<_> = lowest.into_iter().map(|(b, r)| (b, r.neg())).collect();
        factors.sort_unstable();
        let denominator = self.power_product(Number::ONE, factors);
        self.multiply_out(e, denominator)
    }
}
