//! Rapidly varying functions: they may change within a small part of their arguments, which time steps can
//! miss.

use crate::store::arena::Node;
use crate::store::number::Rational;
use crate::{Expr, Function, Graph, Range, Symbol};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::{BTreeSet, HashMap};

/// A call `F(x)` that is nearly constant except on a small part of its arguments.
#[derive(Clone, Copy, Debug)]
pub struct Steep {
    /// Name of `F` in messages, such as `tanh`.
    pub function: &'static str,
    /// `x`.
    pub argument: Expr,
    /// `w(x)`, monotone: where it grows by 1, `F` changes by about its own size; where it is constant, `F`
    /// hardly changes.
    pub gauge: fn(f64) -> f64,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Tanh,
    Exp,
    Arctangent,
    Root,
    Quotient,
    Angle,
}

/// Beyond this `tanh` counts as ±1, and below minus twice this `exp` counts as 0: up to round-off of sums
/// that contain them.
const TAIL: f64 = 20.0;
/// Under a root less than this counts as zero, of what round-off has a part in: a kink is not looked at more
/// closely. What is divided by may be less.
const FLOOR: f64 = 1e-15;
const LEAST: f64 = 1e-20;
/// A quantity that changes by at most this factor, for all values of its symbols, makes no function steep.
const MODERATE: f64 = 50.0;
/// From this exponent on, a power of a bounded quantity is negligible except near its largest value.
const HIGH: f64 = 20.0;

impl Kind {
    fn gauge(self) -> fn(f64) -> f64 {
        match self {
            Kind::Tanh => |x| x.clamp(-TAIL, TAIL),
            Kind::Exp => |x| x.max(-2.0 * TAIL),
            Kind::Arctangent => f64::asinh,
            Kind::Root => |x| x.max(FLOOR).ln(),
            Kind::Quotient => |x| x.max(LEAST).ln().min(2.0 * TAIL),
            Kind::Angle => |x| 2.0 * x,
        }
    }

    fn function(self) -> &'static str {
        match self {
            Kind::Tanh => "tanh",
            Kind::Exp => "exp",
            Kind::Arctangent => "atan",
            Kind::Root => "a root",
            Kind::Quotient => "1 by",
            Kind::Angle => "sine or cosine",
        }
    }
}

type Found = BTreeSet<(Expr, Kind)>;

impl Graph {
    /// Functions in `es` that can be steep without being singular: `tanh`, `exp`, `atan`, powers of
    /// constants, high powers of what is bounded, roots and quotients of what is never negative, angles of
    /// points; and the angles of sines and cosines in their arguments. `known` are ranges of symbols, such as
    /// the values of parameters.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let (tanh, sin) = (g.call(symbolic::Function::Tanh, x), g.call(symbolic::Function::Sin, x));
    /// let steep = g.steep(&[tanh, sin, g.powi(x, -1)], &HashMap::new());
    /// assert_eq!(steep.len(), 1);
    /// assert_eq!(((steep[0].gauge)(-500.0), (steep[0].gauge)(0.5)), (-20.0, 0.5));
    /// // narrow where the sine is 1 or −1
    /// assert_eq!(g.steep(&[g.powi(sin, 1000)], &HashMap::new()).len(), 3);
    /// ```
    pub fn steep(&self, es: &[Expr], known: &HashMap<Symbol, Range>) -> Vec<Steep> {
        let mut found = Found::new();
        let mut ranges = FxHashMap::default();
        let mut range = |e: Expr| self.range_among(e, known, &mut ranges);
        let (mut pending, mut seen) = (es.to_vec(), FxHashSet::default());
        while let Some(e) = pending.pop() {
            if !seen.insert(e) {
                continue;
            }
            let node = self.arena.borrow().node(e).clone();
            if let Node::Product(factors) = node {
                self.steep_product(&factors, &mut range, &mut found, &mut pending);
                continue;
            }
            if let Node::Call(Function::Log, x) = node {
                // it changes as its derivative, a quotient by x, does
                let quotient = [(x, Rational::integer(-1))];
                if !self.arena.borrow().saturating_groups(&quotient).is_empty() {
                    self.steep_product(&quotient, &mut range, &mut found, &mut pending);
                    continue;
                }
            }
            node.each_child(|child| pending.push(child));
            match node {
                Node::Call(Function::Tanh, x) => found.extend([(x, Kind::Tanh)]),
                Node::Call(Function::Exp, x) => found.extend([(x, Kind::Exp)]),
                Node::Call(Function::Atan | Function::Asinh, x) => found.extend([(x, Kind::Arctangent)]),
                Node::Atan2(y, x) => found.extend([(self.add(self.powi(x, 2), self.powi(y, 2)), Kind::Root)]),
                Node::Power(base, exponent) => {
                    self.steep_power(base, Rational::integer(-1), &mut range, &mut found);
                    if range(base).low > 0.0 {
                        found.insert((self.mul(exponent, self.call(Function::Log, base)), Kind::Exp));
                    }
                }
                _ => {}
            }
        }
        let arguments: Vec<Expr> = found.iter().map(|(x, _)| *x).collect();
        for e in self.arena.borrow().reachable(&arguments, |_| true) {
            if let Node::Call(Function::Sin | Function::Cos, x) = self.arena.borrow().node(e) {
                found.insert((*x, Kind::Angle));
            }
        }
        let varies = |x: &Expr| self.symbols_of(*x).iter().any(|s| known.get(s).is_none_or(|r| r.low < r.high));
        found
            .into_iter()
            .filter(|(x, _)| varies(x))
            .map(|(argument, kind)| Steep { function: kind.function(), argument, gauge: kind.gauge() })
            .collect()
    }

    /// The highest power in `es` of what has no bounds, from 20 on; 0 where there is none. `(4x(1 − x))⁴⁰` is
    /// nothing except for a part `1/√40` of where `x` passes it, and to order 39 nothing at both ends.
    pub fn highest_power(&self, es: &[Expr], known: &HashMap<Symbol, Range>) -> f64 {
        let high = self.powers(es, |n| n.to_f64() >= HIGH);
        let mut ranges = FxHashMap::default();
        let mut is_unbounded = |base: Expr| !self.range_among(base, known, &mut ranges).is_bounded();
        high.into_iter().filter(|(base, _)| is_unbounded(*base)).fold(0.0, |most, (_, n)| most.max(n.to_f64()))
    }

    /// The angles of points in `es`: each jumps by 2π where its point passes behind the origin.
    pub fn angles(&self, es: &[Expr]) -> Vec<Expr> {
        let arena = self.arena.borrow();
        let all = arena.reachable(es, |_| true);
        all.into_iter().filter(|&e| matches!(arena.node(e), Node::Atan2(..))).collect()
    }

    /// `x + √(x² + y²)`, which is zero where angles of points `(x, y)` in `es` jump, and positive elsewhere.
    pub fn cuts(&self, es: &[Expr]) -> Vec<Expr> {
        let points = self.angles(es).into_iter().filter_map(|e| match *self.arena.borrow().node(e) {
            Node::Atan2(y, x) => Some((x, y)),
            _ => None,
        });
        let points: Vec<(Expr, Expr)> = points.collect();
        let length = |x: Expr, y: Expr| self.sqrt(self.add(self.powi(x, 2), self.powi(y, 2)));
        points.into_iter().map(|(x, y)| self.add(x, length(x, y))).collect()
    }

    /// Of factors that overflow together, so that the product does not, only the unit is steep, like a
    /// `tanh`.
    fn steep_product(
        &self,
        factors: &[(Expr, Rational)],
        range: &mut impl FnMut(Expr) -> Range,
        found: &mut Found,
        pending: &mut Vec<Expr>,
    ) {
        let mut open = vec![true; factors.len()];
        let groups = self.arena.borrow().saturating_groups(factors);
        for group in groups.iter().filter(|group| group.is_bounded()) {
            let (unit, part) = group.unit;
            for n in [1, group.multiple()] {
                found.insert((self.mul(self.ratio(n, part), unit), Kind::Tanh));
            }
            pending.push(unit);
            for factor in &group.factors {
                open[factor.place] = false;
                for (base, exponent) in factor.terms.iter().flat_map(|term| &term.rest) {
                    self.steep_power(*base, *exponent, range, found);
                    pending.push(*base);
                }
                if factor.terms.iter().any(|term| !term.rest.is_empty()) {
                    self.steep_power(factors[factor.place].0, factor.exponent, range, found);
                }
            }
        }
        for ((base, exponent), _) in factors.iter().zip(open).filter(|(_, open)| *open) {
            self.steep_power(*base, *exponent, range, found);
            pending.push(*base);
        }
    }

    fn steep_power(&self, base: Expr, exponent: Rational, range: &mut impl FnMut(Expr) -> Range, found: &mut Found) {
        let power = exponent.to_f64();
        if power > 0.0 && power < HIGH && exponent.as_integer().is_some() {
            return;
        }
        let Range { low, high } = range(base);
        let largest = high.max(-low);
        if power >= HIGH && largest > 0.0 && largest.is_finite() {
            // (b/B)^n is less than exp(n (b/B − 1))
            for sign in [1.0, -1.0].into_iter().filter(|sign| *sign > 0.0 || low < 0.0) {
                let near = self.add(self.mul(self.number(sign / largest), base), self.number(-1.0));
                found.insert((self.mul(self.number(power), near), Kind::Exp));
            }
        } else if power < 0.0 && low > 0.0 && high > MODERATE * low {
            found.insert((base, Kind::Quotient));
            if power <= -HIGH {
                // (b/B)^−n falls within 1/n of b: b is at least B
                let logarithm = self.call(Function::Log, self.mul(self.number(1.0 / low), base));
                found.insert((self.mul(self.number(power), logarithm), Kind::Exp));
            }
            // where these are large they hide what is between
            for e in self.arena.borrow().reachable(&[base], |_| true) {
                if let Node::Call(Function::Cosh | Function::Sinh, x) = self.arena.borrow().node(e) {
                    found.insert((*x, Kind::Tanh));
                }
            }
        } else if power > 0.0 && exponent.as_integer().is_none() && low >= 0.0 && high > MODERATE * low {
            found.insert((base, Kind::Root));
        }
    }
}
