//! Multiplying out.

use crate::limits::TOO_LONG;
use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use crate::{Expr, Graph};
use rustc_hash::FxHashMap;

/// Powers above this stay as they are: their coefficients would leave the range of numbers.
const POWER_LIMIT: i64 = 64;

impl Graph {
    /// `e` with products of sums and positive integer powers of sums multiplied out, inside functions as
    /// well. A power above 64 and a product that would have more than 10 000 terms stay as they are.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// let product = g.mul(g.add(x, y), g.sub(x, y));
    /// assert_eq!(g.expand(product), g.sub(g.powi(x, 2), g.powi(y, 2)));
    /// ```
    pub fn expand(&self, e: Expr) -> Expr {
        self.arena.borrow_mut().expand(e, TOO_LONG, Shifts::Expanded)
    }

    /// [`Graph::expand`], except for sums of variables and a number: `(t − p)²` keeps its digits near `p`.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (t, y) = (g.variable(g.symbol("t")), g.variable(g.symbol("y")));
    /// let shifted = g.powi(g.add(t, g.number(-777.0)), 2);
    /// let product = g.mul(y, g.add(y, shifted));
    /// assert_eq!(g.expand_around_shifts(product), g.add(g.powi(y, 2), g.mul(y, shifted)));
    /// ```
    pub fn expand_around_shifts(&self, e: Expr) -> Expr {
        self.arena.borrow_mut().expand(e, TOO_LONG, Shifts::Kept)
    }

    /// Terms of `e` multiplied out, before any cancel.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// assert_eq!(g.expanded_terms(g.mul(x, g.powi(g.add(x, y), 2))), 3);
    /// ```
    pub fn expanded_terms(&self, e: Expr) -> usize {
        self.arena.borrow().expanded_terms(e)
    }

    /// [`Graph::expand_around_shifts`], if that makes `e` shorter and `e` has at most `limit` nodes; a
    /// product that would have more terms than `e` has nodes stays as it is.
    pub fn expand_if_shorter(&self, e: Expr, limit: usize) -> Expr {
        let size = self.size(&[e]);
        if size > limit {
            return e;
        }
        let expanded = self.arena.borrow_mut().expand(e, size, Shifts::Kept);
        if self.size(&[expanded]) < size { expanded } else { e }
    }
}

/// What is done with a sum of variables and a number.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shifts {
    Expanded,
    Kept,
}

impl Arena {
    /// `e` multiplied out, except for products of more than `limit` terms.
    pub(crate) fn expand(&mut self, e: Expr, limit: usize, shifts: Shifts) -> Expr {
        let mut e = e;
        // Products of terms can have sums as factors again, as √(x+y)·√(x+y) has.
        for _ in 0..8 {
            let expanded = self.expand_once(e, limit, shifts);
            if expanded == e {
                break;
            }
            e = expanded;
        }
        e
    }

    fn expand_once(&mut self, e: Expr, limit: usize, shifts: Shifts) -> Expr {
        let product = |arena: &mut Arena, e: Expr| match arena.node(e).clone() {
            Node::Product(factors) => arena.expand_product(e, &factors, limit, shifts),
            _ => e,
        };
        self.rewritten(&[e], product)[0]
    }

    fn expand_product(&mut self, whole: Expr, factors: &[(Expr, Rational)], limit: usize, shifts: Shifts) -> Expr {
        let mut rest = Vec::new();
        let mut sums: Vec<(Expr, i64)> = Vec::new();
        let mut terms = 1_usize;
        for (base, exponent) in factors {
            let n = exponent.floor();
            match self.node(*base) {
                Node::Sum(constant, inner)
                    if (1..=POWER_LIMIT).contains(&n) && (shifts == Shifts::Expanded || !self.is_shift(*base)) =>
                {
                    let count = inner.len() + usize::from(!constant.is_zero());
                    terms = terms.saturating_mul(power_terms(count, n));
                    sums.push((*base, n));
                    // (x+y)^(3/2) = (x+y) (x+y)^(1/2)
                    if let Some(fraction) = exponent.add(Rational::integer(-n)) {
                        rest.push((*base, fraction));
                    }
                }
                _ => rest.push((*base, *exponent)),
            }
        }
        if sums.is_empty() || terms > limit {
            return whole;
        }
        let mut total = self.power_product(Number::ONE, rest);
        for (sum, n) in sums {
            for _ in 0..n {
                total = self.multiply_out(total, sum);
                // as where exponents are too long to be added up, so that nothing is collected
                if matches!(self.node(total), Node::Sum(_, terms) if terms.len() > limit) {
                    return whole;
                }
            }
        }
        total
    }

    /// Whether it is a sum of variables and a number.
    fn is_shift(&self, e: Expr) -> bool {
        let is_variable = |(term, _): &(Expr, Number)| matches!(self.node(*term), Node::Symbol(_));
        matches!(self.node(e), Node::Sum(constant, terms) if !constant.is_zero() && terms.iter().all(is_variable))
    }

    /// Terms of `e` multiplied out, before any cancel.
    fn expanded_terms(&self, e: Expr) -> usize {
        let mut counts: FxHashMap<Expr, usize> = FxHashMap::default();
        for n in self.reachable(&[e], |_| true) {
            let count = match self.node(n) {
                Node::Sum(constant, terms) => {
                    terms.iter().fold(usize::from(!constant.is_zero()), |sum, (t, _)| sum.saturating_add(counts[t]))
                }
                Node::Product(factors) => factors.iter().fold(1, |product: usize, (base, exponent)| {
                    let n = exponent.floor();
                    let outside = !(1..=POWER_LIMIT).contains(&n);
                    product.saturating_mul(if outside { 1 } else { power_terms(counts[base], n) })
                }),
                _ => 1,
            };
            counts.insert(n, count);
        }
        counts[&e]
    }

    pub(crate) fn multiply_out(&mut self, a: Expr, b: Expr) -> Expr {
        let ((k, left), (l, right)) = (self.terms_of(a), self.terms_of(b));
        let mut parts = Vec::with_capacity((left.len() + 1) * (right.len() + 1));
        for (s, c) in &left {
            for (t, d) in &right {
                parts.push((self.times(&[*s, *t]), c.mul(*d)));
            }
        }
        parts.extend(left.into_iter().filter(|_| !l.is_zero()).map(|(s, c)| (s, c.mul(l))));
        parts.extend(right.into_iter().filter(|_| !k.is_zero()).map(|(t, d)| (t, k.mul(d))));
        self.linear(k.mul(l), parts)
    }
}

/// Terms in the n-th power of a sum of k, at most: (n+k−1 over n), counted to [`TOO_LONG`] + 1.
fn power_terms(k: usize, n: i64) -> usize {
    let mut count = 1_usize;
    for i in 1..=usize::try_from(n).unwrap_or(usize::MAX) {
        count = count.saturating_mul((i - 1).saturating_add(k)) / i;
        if count > TOO_LONG {
            break;
        }
    }
    count
}
