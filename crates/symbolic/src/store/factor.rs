//! Common factors and squares.

use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use crate::{Expr, Function, Graph, Symbol};
use std::collections::BTreeMap;

impl Graph {
    /// `e` with the factors that all terms of a sum have in common taken out of it, and 1 − cos²u written as
    /// sin²u (1 − sin²u as cos²u). What is inside of products and functions stays as it is.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let [a, x, y] = ["a", "x", "y"].map(|n| g.variable(g.symbol(n)));
    /// let sum = g.add(g.mul(a, x), g.product(&[a, a, y]));
    /// assert_eq!(g.factored(sum), g.mul(a, g.add(x, g.mul(a, y))));
    /// let cosine = g.call(symbolic::Function::Cos, x);
    /// let rest = g.sub(a, g.mul(a, g.powi(cosine, 2)));
    /// assert_eq!(g.factored(rest), g.mul(a, g.powi(g.call(symbolic::Function::Sin, x), 2)));
    /// ```
    pub fn factored(&self, e: Expr) -> Expr {
        self.arena.borrow_mut().factored(e)
    }

    /// What stands as a factor, to a positive power, in every one of `es` that is not zero; no numbers.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let [x, y] = ["x", "y"].map(|n| g.variable(g.symbol(n)));
    /// let sum = g.add(g.mul(x, y), g.powi(x, 2));
    /// assert_eq!(g.common_factors(&[g.mul(g.integer(-2), g.powi(x, 3)), sum, g.zero()]), [x]);
    /// assert_eq!(g.common_factors(&[x, y]), []);
    /// ```
    pub fn common_factors(&self, es: &[Expr]) -> Vec<Expr> {
        let nonzero: Vec<Expr> = es.iter().copied().filter(|&e| !self.is_zero(e)).collect();
        let Some((&first, others)) = nonzero.split_first() else { return Vec::new() };
        let mut arena = self.arena.borrow_mut();
        let factors = |arena: &mut Arena, e: Expr| -> Vec<Expr> {
            let e = arena.factored(e);
            let positive = |(base, exponent): (Expr, Rational)| (exponent.to_f64() > 0.0).then_some(base);
            arena.monomial(e).1.into_iter().filter_map(positive).collect()
        };
        let mut common = factors(&mut arena, first);
        for &e in others {
            let there = factors(&mut arena, e);
            common.retain(|base| there.contains(base));
        }
        common
    }

    /// Draws out the factors that several terms of a sum share, the most frequent first: a x + b x + c = x
    /// (a + b) + c. Factors that contain no symbols but `constants` stay.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let [a, b, x] = ["a", "b", "x"].map(|n| g.variable(g.symbol(n)));
    /// let sum = g.sum(&[g.mul(a, x), g.mul(b, x), g.one()]);
    /// assert_eq!(g.collected(&[sum], &|_| false), [g.add(g.mul(x, g.add(a, b)), g.one())]);
    /// ```
    pub fn collected(&self, es: &[Expr], constants: &dyn Fn(Symbol) -> bool) -> Vec<Expr> {
        self.arena.borrow_mut().collected(es, constants)
    }

    /// `(c, s)` with e = c s², where `c` contains no symbols but `constants`; `None` where that is not seen.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let [m, x] = ["m", "x"].map(|n| g.symbol(n));
    /// let (mass, sine) = (g.variable(m), g.call(symbolic::Function::Sin, g.variable(x)));
    /// let e = g.mul(mass, g.powi(sine, 2));
    /// assert_eq!(g.square(e, &|s| s == m), Some((mass, sine)));
    /// assert_eq!(g.square(g.mul(mass, sine), &|s| s == m), None);
    /// ```
    pub fn square(&self, e: Expr, constants: &dyn Fn(Symbol) -> bool) -> Option<(Expr, Expr)> {
        let mut arena = self.arena.borrow_mut();
        let e = arena.factored(e);
        let (number, factors) = arena.monomial(e);
        let (mut constant, mut root) = (Vec::new(), Vec::new());
        for (base, exponent) in factors {
            if arena.dependencies(base).iter().all(|&s| constants(s)) {
                constant.push((base, exponent));
            } else {
                let half = exponent.mul(Rational::new(1, 2)?)?;
                root.push((base, half.as_integer().map(Rational::integer)?));
            }
        }
        Some((arena.power_product(number, constant), arena.power_product(Number::ONE, root)))
    }
}

impl Arena {
    /// `e` as number · Π base^exponent.
    fn monomial(&self, e: Expr) -> (Number, Vec<(Expr, Rational)>) {
        match self.node(e) {
            Node::Number(n) => (*n, Vec::new()),
            Node::Sum(constant, terms) if terms.len() == 1 && constant.is_zero() => {
                let (term, coefficient) = terms[0];
                (coefficient, self.monomial(term).1)
            }
            _ => (Number::ONE, self.factors_of(e)),
        }
    }

    fn collected(&mut self, es: &[Expr], constants: &dyn Fn(Symbol) -> bool) -> Vec<Expr> {
        self.rewritten(es, |arena, e| arena.collected_sum(e, constants))
    }

    /// One sum, whose terms are done.
    fn collected_sum(&mut self, e: Expr, constants: &dyn Fn(Symbol) -> bool) -> Expr {
        let Node::Sum(constant, terms) = self.node(e).clone() else { return e };
        // positive powers of what moves, with the terms in which they stand, in a fixed order
        let mut places: BTreeMap<Expr, Vec<usize>> = BTreeMap::new();
        for (i, (term, _)) in terms.iter().enumerate() {
            for (base, exponent) in self.monomial(*term).1 {
                let moves = self.dependencies(base).iter().any(|&s| !constants(s));
                if moves && exponent.as_integer().is_some_and(|n| n > 0) {
                    places.entry(base).or_default().push(i);
                }
            }
        }
        // of equally frequent factors the first
        let Some((base, inside)) = places.into_iter().rev().max_by_key(|(_, places)| places.len()) else { return e };
        if inside.len() < 2 {
            return e;
        }
        let (mut cofactors, mut others) = (Vec::new(), Vec::new());
        for (i, &(term, coefficient)) in terms.iter().enumerate() {
            if inside.binary_search(&i).is_ok() {
                let (number, mut factors) = self.monomial(term);
                // one less of the factor as it stands: its inverse may be written in another content
                for (_, exponent) in factors.iter_mut().filter(|(factor, _)| *factor == base) {
                    *exponent = exponent.as_integer().map_or(*exponent, |n| Rational::integer(n - 1));
                }
                cofactors.push((self.power_product(number, factors), coefficient));
            } else {
                others.push((term, coefficient));
            }
        }
        let cofactor = self.linear(Number::ZERO, cofactors);
        let cofactor = self.collected_sum(cofactor, constants);
        let product = self.power_product(Number::ONE, vec![(base, Rational::ONE), (cofactor, Rational::ONE)]);
        let rest = self.linear(constant, others);
        let rest = self.collected_sum(rest, constants);
        self.linear(Number::ZERO, vec![(product, Number::ONE), (rest, Number::ONE)])
    }

    fn factored(&mut self, e: Expr) -> Expr {
        let Node::Sum(constant, terms) = self.node(e).clone() else { return e };
        if terms.len() + usize::from(!constant.is_zero()) < 2 {
            return e;
        }
        let mut common = if constant.is_zero() { self.monomial(terms[0].0).1 } else { Vec::new() };
        for (term, _) in terms.iter().skip(1) {
            let factors = self.monomial(*term).1;
            common.retain_mut(|(base, exponent)| {
                let other = factors.iter().find(|(b, _)| b == base).map(|(_, r)| *r);
                let Some(other) = other.filter(|r| r.is_negative() == exponent.is_negative()) else { return false };
                // the one nearer to zero
                *exponent = if exponent.is_negative() { other.max(*exponent) } else { other.min(*exponent) };
                true
            });
        }
        let inverse: Vec<(Expr, Rational)> = common.iter().map(|(b, r)| (*b, r.neg())).collect();
        let parts = terms.iter().map(|(term, coefficient)| {
            let factors = [&[(*term, Rational::ONE)], &inverse[..]].concat();
            (self.power_product(Number::ONE, factors), *coefficient)
        });
        let parts = parts.collect();
        let rest = self.linear(constant, parts);
        let rest = self.pythagorean_rest(rest).unwrap_or(rest);
        common.push((rest, Rational::ONE));
        self.power_product(Number::ONE, common)
    }

    /// c − c cos²u = c sin²u, and with sine and cosine exchanged.
    fn pythagorean_rest(&mut self, e: Expr) -> Option<Expr> {
        let Node::Sum(constant, terms) = self.node(e) else { return None };
        let &[(term, coefficient)] = &terms[..] else { return None };
        let Node::Product(factors) = self.node(term) else { return None };
        let &[(base, exponent)] = &factors[..] else { return None };
        let Node::Call(function, argument) = *self.node(base) else { return None };
        let partner = match function {
            Function::Sin => Function::Cos,
            Function::Cos => Function::Sin,
            _ => return None,
        };
        let constant = *constant;
        if exponent != Rational::integer(2) || coefficient != constant.neg() {
            return None;
        }
        let partner = self.call(partner, argument);
        Some(self.power_product(constant, vec![(partner, Rational::integer(2))]))
    }
}
