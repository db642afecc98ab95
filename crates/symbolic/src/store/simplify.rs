//! Canonical form: what the constructors of sums, products, powers and calls do.

use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use crate::store::sum_factor::{content, exact_power, sign_is_negative};
use crate::{Expr, Function};
use rustc_hash::FxHashMap;

impl Arena {
    /// constant + Σ coefficient·part, flattened, with like terms merged.
    pub(crate) fn linear(&mut self, constant: Number, parts: Vec<(Expr, Number)>) -> Expr {
        let mut constant = constant;
        let mut parts = parts;
        loop {
            let mut terms = Vec::with_capacity(parts.len());
            for (e, c) in parts {
                if !c.is_finite() {
                    return self.number(Number::UNDEFINED);
                }
                match self.node(e) {
                    Node::Number(n) => constant = constant.add(c.mul(*n)),
                    Node::Sum(k, inner) => {
                        constant = constant.add(c.mul(*k));
                        terms.extend(inner.iter().map(|(t, d)| (*t, c.mul(*d))));
                    }
                    _ => terms.push((e, c)),
                }
            }
            if !constant.is_finite() {
                return self.number(constant);
            }
            terms.sort_unstable_by_key(|(t, _)| *t);
            let mut merged: Vec<(Expr, Number)> = Vec::with_capacity(terms.len());
            for (t, c) in terms {
                match merged.last_mut() {
                    Some((last, sum)) if *last == t => *sum = sum.add(c),
                    _ => merged.push((t, c)),
                }
            }
            merged.retain(|(_, c)| !c.is_zero());
            match self.pythagoras(&mut merged) {
                Some(found) => {
                    merged.extend(found);
                    parts = merged;
                }
                None => return self.finished_sum(constant, merged),
            }
        }
    }

    fn finished_sum(&mut self, constant: Number, terms: Vec<(Expr, Number)>) -> Expr {
        if terms.iter().any(|(_, c)| !c.is_finite()) {
            return self.number(Number::UNDEFINED);
        }
        match &terms[..] {
            [] => self.number(constant),
            [(t, c)] if c.is_one() && constant.is_zero() => *t,
            _ => self.intern(Node::Sum(constant, terms.into())),
        }
    }

    /// c P sin²u + c P cos²u = c P and c P cosh²u − c P sinh²u = c P: takes matching pairs out of
    /// `terms` and returns what replaces them.
    fn pythagoras(&mut self, terms: &mut Vec<(Expr, Number)>) -> Option<Vec<(Expr, Number)>> {
        type Rest = Vec<(Expr, Rational)>;
        let mut partners: FxHashMap<(Function, Expr, Rest), usize> = FxHashMap::default();
        let mut pairs: Vec<(usize, Rest)> = Vec::new();
        let mut taken = vec![false; terms.len()];
        for (index, (term, coefficient)) in terms.iter().enumerate() {
            let Node::Product(factors) = self.node(*term) else {
                continue;
            };
            for (place, (base, exponent)) in factors.iter().enumerate() {
                let Node::Call(function, argument) = self.node(*base) else {
                    continue;
                };
                let (partner, sign) = match function {
                    Function::Sin => (Function::Cos, Number::ONE),
                    Function::Cos => (Function::Sin, Number::ONE),
                    Function::Sinh => (Function::Cosh, Number::MINUS_ONE),
                    Function::Cosh => (Function::Sinh, Number::MINUS_ONE),
                    _ => continue,
                };
                let Some(n @ 2..) = exponent.as_integer() else {
                    continue;
                };
                let mut rest = factors.to_vec();
                if n == 2 {
                    rest.remove(place);
                } else {
                    rest[place].1 = Rational::integer(n - 2);
                }
                let key = (partner, *argument, rest);
                let found = partners
                    .get(&key)
                    .copied()
                    .filter(|&other| !taken[other] && !taken[index] && terms[other].1 == sign.mul(*coefficient));
                if let Some(other) = found {
                    let positive = if *function == Function::Sinh { other } else { index };
                    taken[index] = true;
                    taken[other] = true;
                    pairs.push((positive, key.2));
                    break;
                }
                partners.insert((*function, key.1, key.2), index);
            }
        }
        if pairs.is_empty() {
            return None;
        }
        let mut found = Vec::with_capacity(pairs.len());
        for (positive, rest) in pairs {
            let coefficient = terms[positive].1;
            found.push((self.power_product(Number::ONE, rest), coefficient));
        }
        let mut index = 0;
        terms.retain(|_| {
            index += 1;
            !taken[index - 1]
        });
        Some(found)
    }

    pub(crate) fn scale(&mut self, c: Number, e: Expr) -> Expr {
        self.linear(Number::ZERO, vec![(e, c)])
    }

    /// coefficient · Π base^exponent, flattened, with equal bases merged.
    pub(crate) fn power_product(&mut self, coefficient: Number, factors: Vec<(Expr, Rational)>) -> Expr {
        let mut coefficient = coefficient;
        let mut work = factors;
        let mut done: Vec<(Expr, Rational)> = Vec::with_capacity(work.len());
        loop {
            while let Some((base, exponent)) = work.pop() {
                self.split_factor(base, exponent, &mut coefficient, &mut work, &mut done);
            }
            done.sort_unstable_by_key(|(b, _)| *b);
            let mut merged: Vec<(Expr, Rational)> = Vec::with_capacity(done.len());
            let mut changed = false;
            for (base, exponent) in done.drain(..) {
                match merged.last_mut() {
                    Some((last, total)) if *last == base => match total.add(exponent) {
                        Some(sum) => {
                            *total = sum;
                            changed = true;
                        }
                        None => merged.push((base, exponent)),
                    },
                    _ => merged.push((base, exponent)),
                }
            }
            merged.retain(|(_, r)| !r.is_zero());
            if !changed {
                return self.finished_product(coefficient, merged);
            }
            work = merged;
        }
    }

    fn finished_product(&mut self, coefficient: Number, factors: Vec<(Expr, Rational)>) -> Expr {
        if !coefficient.is_finite() {
            let undefined = if factors.is_empty() { coefficient } else { Number::UNDEFINED };
            return self.number(undefined);
        }
        let product = match &factors[..] {
            [] => return self.number(coefficient),
            [(base, exponent)] if *exponent == Rational::ONE => *base,
            _ => self.intern(Node::Product(factors.into())),
        };
        if coefficient.is_one() { product } else { self.scale(coefficient, product) }
    }

    /// One factor base^exponent: numbers go to the coefficient, products to `work`, the rest to `done`.
    fn split_factor(
        &mut self,
        base: Expr,
        exponent: Rational,
        coefficient: &mut Number,
        work: &mut Vec<(Expr, Rational)>,
        done: &mut Vec<(Expr, Rational)>,
    ) {
        let whole = exponent.as_integer();
        match self.node(base).clone() {
            Node::Number(n) => self.split_number(n, exponent, coefficient, done),
            Node::Product(factors) if let Some(n) = whole => {
                let scaled: Option<Vec<_>> =
                    factors.iter().map(|(b, r)| r.mul(Rational::integer(n)).map(|r| (*b, r))).collect();
                match scaled {
                    Some(scaled) => work.extend(scaled),
                    None => done.push((base, exponent)),
                }
            }
            Node::Sum(constant, terms) => {
                let mut content = content(constant, &terms);
                if let ([(t, _)], Some(n), true) = (&terms[..], whole, constant.is_zero()) {
                    let power = content.powi(n);
                    // A power that overflows or underflows stays with its base.
                    if power.is_finite() && !power.is_zero() {
                        *coefficient = coefficient.mul(power);
                        work.push((*t, exponent));
                    } else {
                        done.push((base, exponent));
                    }
                    return;
                }
                let mut factor = exact_power(content, exponent);
                if factor.is_none() && whole.is_none() {
                    content = content.abs();
                    factor = exact_power(content, exponent);
                } else if factor.is_none() && content.is_negative() {
                    content = Number::MINUS_ONE;
                    factor = exact_power(content, exponent);
                }
                let Some(factor) = factor.filter(|_| !content.is_one()) else {
                    done.push((base, exponent));
                    return;
                };
                *coefficient = coefficient.mul(factor);
                let primitive = self.scale(content.recip(), base);
                match self.node(primitive) {
                    Node::Sum(..) => done.push((primitive, exponent)),
                    _ => work.push((primitive, exponent)),
                }
            }
            _ => done.push((base, exponent)),
        }
    }

    /// Exact powers go to the coefficient; √2 and its like stay, an integer to an exponent between 0 and 1.
    fn split_number(
        &mut self,
        n: Number,
        exponent: Rational,
        coefficient: &mut Number,
        done: &mut Vec<(Expr, Rational)>,
    ) {
        if let Some(whole) = exponent.as_integer() {
            *coefficient = coefficient.mul(n.powi(whole));
            return;
        }
        let (r, twos, fives) = match n {
            Number::Exact(r) if !r.is_zero() && !r.is_negative() => (r, 0, 0),
            Number::Scaled(r, twos, fives) if !r.is_negative() => (r, twos, fives),
            _ => {
                *coefficient = coefficient.mul(Number::rounded(n.to_f64().powf(exponent.to_f64())));
                return;
            }
        };
        let times = |n: i16| exponent.mul(Rational::integer(n.into())).unwrap_or(exponent);
        let mut parts = vec![(r.numerator(), exponent), (r.denominator(), exponent.neg())];
        parts.extend([(2, twos), (5, fives)].into_iter().filter(|(_, n)| *n != 0).map(|(part, n)| (part, times(n))));
        if parts.iter().any(|(part, e)| !Number::integer(*part).powi(e.floor()).is_exact()) {
            *coefficient = coefficient.mul(Number::rounded(n.to_f64().powf(exponent.to_f64())));
            return;
        }
        for (part, exponent) in parts {
            let part = Rational::integer(part);
            let whole = exponent.floor();
            let rest = exponent.fraction();
            *coefficient = coefficient.mul(Number::Exact(part).powi(whole));
            if let Some(exact) = part.pow(rest) {
                *coefficient = coefficient.mul(Number::Exact(exact));
                continue;
            }
            done.push((self.number(Number::Exact(part)), rest));
        }
    }

    pub(crate) fn pow(&mut self, base: Expr, exponent: Expr) -> Expr {
        match (self.as_number(base), self.as_number(exponent)) {
            (_, Some(Number::Exact(r))) => self.power_product(Number::ONE, vec![(base, r)]),
            (Some(b), _) if b.is_one() => Self::ONE,
            (Some(b), Some(x)) => self.number(Number::rounded(b.to_f64().powf(x.to_f64()))),
            (Some(b), None) if !b.is_finite() => self.number(Number::UNDEFINED),
            (None, Some(x)) if !x.is_finite() => self.number(Number::UNDEFINED),
            _ => self.intern(Node::Power(base, exponent)),
        }
    }

    /// If `e` is a sum: is `factor` what will be taken out of factor·e?
    pub(crate) fn keeps_content(&self, e: Expr, factor: i64) -> bool {
        let Node::Sum(constant, terms) = self.node(e) else {
            return true;
        };
        let factor = Number::integer(factor);
        let terms: Vec<_> = terms.iter().map(|(t, c)| (*t, c.mul(factor))).collect();
        content(constant.mul(factor), &terms) == factor
    }

    /// Is the sign of `e` the one that `f(−u) = ±f(u)` takes out? Exactly one of e, −e is.
    pub(crate) fn leads_negative(&self, e: Expr) -> bool {
        match self.node(e) {
            Node::Number(n) => n.is_negative(),
            Node::Sum(_, terms) => sign_is_negative(terms),
            _ => false,
        }
    }

    pub(crate) fn call(&mut self, function: Function, argument: Expr) -> Expr {
        if let Some(n) = self.as_number(argument) {
            if !n.is_finite() {
                return self.number(Number::UNDEFINED);
            }
            if n.is_zero() {
                match function.at_zero() {
                    Some(value) => return self.number(value),
                    None if function == Function::Log => return self.number(Number::UNDEFINED),
                    None => {}
                }
            }
            if n.is_one() && matches!(function, Function::Log | Function::Acos | Function::Acosh) {
                return Self::ZERO;
            }
        }
        let parity = function.parity();
        if parity != 0 && self.leads_negative(argument) {
            let argument = self.scale(Number::MINUS_ONE, argument);
            let call = self.intern(Node::Call(function, argument));
            return if parity < 0 { self.scale(Number::MINUS_ONE, call) } else { call };
        }
        self.intern(Node::Call(function, argument))
    }

    pub(crate) fn atan2(&mut self, y: Expr, x: Expr) -> Expr {
        match (self.as_number(y), self.as_number(x)) {
            (Some(y), Some(x)) if y.is_zero() && !x.is_negative() && !x.is_zero() => Self::ZERO,
            (Some(n), _) | (_, Some(n)) if !n.is_finite() => self.number(Number::UNDEFINED),
            (Some(y), Some(x)) if y.is_zero() && x.is_zero() => self.number(Number::UNDEFINED),
            _ => self.intern(Node::Atan2(y, x)),
        }
    }
}
