//! Functions that may change within little of their arguments, so that steps can pass over it unseen.

use crate::arena::Node;
use crate::{Expr, Function, Graph, Range, Symbol};
use std::collections::{BTreeSet, HashMap};

/// A call `F(x)` that is nearly constant but for a part of its arguments.
#[derive(Clone, Copy, Debug)]
pub struct Steep {
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

/// Beyond this `tanh` is ±1, below minus twice this `exp` is 0, to the last digit of what they are added to.
const TAIL: f64 = 20.0;
/// Under a root less than this counts as zero: a kink is not looked at more closely.
const FLOOR: f64 = 1e-20;
/// A quantity that changes by no more than this factor, whatever its symbols are, makes nothing steep.
const MODERATE: f64 = 50.0;

impl Kind {
    fn gauge(self) -> fn(f64) -> f64 {
        match self {
            Kind::Tanh => |x| x.clamp(-TAIL, TAIL),
            Kind::Exp => |x| x.max(-2.0 * TAIL),
            Kind::Arctangent => f64::asinh,
            Kind::Root => |x| x.max(FLOOR).ln(),
            Kind::Quotient => |x| x.max(FLOOR).ln().min(2.0 * TAIL),
            Kind::Angle => |x| 2.0 * x,
        }
    }
}

impl Graph {
    /// Functions in `es` that can be steep without being singular: `tanh`, `exp`, `atan`, roots and quotients
    /// of what is never negative; and the angles of sines and cosines in their arguments. `known` are ranges
    /// of symbols, such as the values of parameters.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let (tanh, sin) = (g.call(symbolic::Function::Tanh, x), g.call(symbolic::Function::Sin, x));
    /// let steep = g.steep(&[tanh, sin, g.powi(x, -1)], &HashMap::new());
    /// assert_eq!(steep.len(), 1);
    /// assert_eq!(((steep[0].gauge)(-500.0), (steep[0].gauge)(0.5)), (-20.0, 0.5));
    /// ```
    pub fn steep(&self, es: &[Expr], known: &HashMap<Symbol, Range>) -> Vec<Steep> {
        let mut found: BTreeSet<(Expr, Kind)> = BTreeSet::new();
        let mut bases = Vec::new();
        for e in self.arena.borrow().reachable(es, |_| true) {
            match self.arena.borrow().node(e) {
                Node::Call(Function::Tanh, x) => found.extend([(*x, Kind::Tanh)]),
                Node::Call(Function::Exp, x) => found.extend([(*x, Kind::Exp)]),
                Node::Call(Function::Atan | Function::Asinh, x) => found.extend([(*x, Kind::Arctangent)]),
                Node::Product(factors) => {
                    let steep = factors.iter().filter(|(_, r)| r.is_negative() || r.as_integer().is_none());
                    bases.extend(steep.map(|(base, r)| (*base, r.is_negative())));
                }
                Node::Power(base, _) => bases.push((*base, true)),
                _ => {}
            }
        }
        for (base, is_quotient) in bases {
            let Range { low, high } = self.range(base, known);
            match is_quotient {
                true if low > 0.0 && high > MODERATE * low => found.extend([(base, Kind::Quotient)]),
                false if low >= 0.0 && high > MODERATE * low => found.extend([(base, Kind::Root)]),
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
            .map(|(argument, kind)| Steep { argument, gauge: kind.gauge() })
            .collect()
    }
}
