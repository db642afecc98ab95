//! Ranges of expressions over all values of their symbols: interval arithmetic.

use crate::store::arena::{Arena, Node};
use crate::store::number::Rational;
use crate::{Expr, Function, Graph, Symbol};
use rustc_hash::FxHashMap;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// A closed interval; its ends may be infinite.
///
/// Ends are computed in ordinary round-off: trust a range only well inside or well outside of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Range {
    /// All numbers.
    pub const ALL: Range = Range { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// One number; all of them where it is NaN.
    pub fn point(x: f64) -> Range {
        Range::new(x, x)
    }

    /// Whether both ends are finite.
    pub fn is_bounded(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }

    fn new(low: f64, high: f64) -> Range {
        if low.is_nan() || high.is_nan() { Range::ALL } else { Range { low, high } }
    }

    fn is_point(self) -> bool {
        self.low == self.high
    }

    fn add(self, other: Range) -> Range {
        Range::new(self.low + other.low, self.high + other.high)
    }

    fn mul(self, other: Range) -> Range {
        // 0 · ∞ = 0: the ends bound finite numbers
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let ends = [(self.low, other.low), (self.low, other.high), (self.high, other.low), (self.high, other.high)]
            .map(|(a, b)| product(a, b));
        Range::new(ends.into_iter().fold(f64::INFINITY, f64::min), ends.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    fn recip(self) -> Range {
        if self.low < 0.0 && self.high > 0.0 {
            return Range::ALL;
        }
        let low = if self.high == 0.0 { f64::NEG_INFINITY } else { 1.0 / self.high };
        Range::new(low, if self.low == 0.0 { f64::INFINITY } else { 1.0 / self.low })
    }

    /// Non-zero rational power.
    fn power(self, exponent: Rational) -> Range {
        if exponent.is_negative() {
            return self.power(exponent.neg()).recip();
        }
        let Some(n) = exponent.as_integer() else {
            let n = exponent.to_f64();
            return Range::new(self.low.max(0.0).powf(n), self.high.max(0.0).powf(n));
        };
        let ends = [self.low, self.high].map(|x| x.powf(n as f64));
        match (n % 2 == 0, self.low < 0.0 && self.high > 0.0) {
            (true, true) => Range::new(0.0, ends[0].max(ends[1])),
            (true, false) => Range::new(ends[0].min(ends[1]), ends[0].max(ends[1])),
            (false, _) => Range::new(ends[0], ends[1]),
        }
    }

    fn call(self, function: Function) -> Range {
        if self.is_point() {
            return Range::point(function.apply(self.low));
        }
        let (low, high) = match function {
            Function::Sin | Function::Cos | Function::Tanh => (-1.0, 1.0),
            Function::Asin | Function::Atan => (-FRAC_PI_2, FRAC_PI_2),
            Function::Acos => (0.0, PI),
            Function::Cosh => (1.0, f64::INFINITY),
            Function::Exp | Function::Acosh => (0.0, f64::INFINITY),
            Function::Tan | Function::Sinh | Function::Asinh | Function::Atanh | Function::Log => return Range::ALL,
        };
        Range { low, high }
    }
}

impl Graph {
    /// An interval that contains every finite value of `e`; symbols that are not in `known` may have any
    /// value. It need not be the smallest one: `x − x²` is not seen to have a largest value.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// use symbolic::{Function, Graph, Range};
    /// let g = Graph::new();
    /// let square = g.powi(g.call(Function::Sin, g.variable(g.symbol("x"))), 2);
    /// let e = g.div(g.integer(3), g.add(square, g.integer(2)));
    /// assert_eq!(g.range(e, &HashMap::new()), Range { low: 1.0, high: 1.5 });
    /// ```
    pub fn range(&self, e: Expr, known: &HashMap<Symbol, Range>) -> Range {
        self.range_among(e, known, &mut FxHashMap::default())
    }

    /// [`Graph::range`]; `ranges` are those of parts that were asked for before, and are added to.
    pub(crate) fn range_among(
        &self,
        e: Expr,
        known: &HashMap<Symbol, Range>,
        ranges: &mut FxHashMap<Expr, Range>,
    ) -> Range {
        let arena = self.arena.borrow();
        let open = arena.reachable(&[e], |n| !ranges.contains_key(&n));
        ranges.reserve(open.len());
        for n in open {
            let range = arena.range(n, ranges, known);
            ranges.insert(n, range);
        }
        ranges[&e]
    }
}

impl Arena {
    fn range(&self, e: Expr, ranges: &FxHashMap<Expr, Range>, known: &HashMap<Symbol, Range>) -> Range {
        match self.node(e) {
            Node::Number(n) => Range::point(n.to_f64()),
            Node::Symbol(s) => known.get(s).copied().unwrap_or(Range::ALL),
            Node::Sum(constant, terms) => terms
                .iter()
                .fold(Range::point(constant.to_f64()), |sum, (t, c)| sum.add(Range::point(c.to_f64()).mul(ranges[t]))),
            Node::Product(factors) => {
                factors.iter().fold(Range::point(1.0), |product, (b, r)| product.mul(ranges[b].power(*r)))
            }
            Node::Call(function, argument) => ranges[argument].call(*function),
            Node::Atan2(_, _) => Range::new(-PI, PI),
            Node::Power(_, _) => Range::ALL,
        }
    }
}
