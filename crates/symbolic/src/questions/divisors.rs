//! Divisors in expressions.

use crate::store::arena::Node;
use crate::{Expr, Function, Graph, Range, Symbol};
use rustc_hash::FxHashMap;
use std::collections::{BTreeSet, HashMap};

impl Graph {
    /// Divisors in `es` that may vanish: bases of negative powers, and of powers whose exponents are not
    /// numbers; the cosine under a tangent. `known` are ranges of symbols, such as the values of parameters.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let never = g.add(g.powi(x, 2), g.one());
    /// assert_eq!(g.divisors(&[g.powi(x, -2), g.powi(never, -1)], &HashMap::new()), [x]);
    /// ```
    pub fn divisors(&self, es: &[Expr], known: &HashMap<Symbol, Range>) -> Vec<Expr> {
        let (mut bases, mut under_tangents) = (BTreeSet::new(), Vec::new());
        let arena = self.arena.borrow();
        for e in arena.reachable(es, |_| true) {
            match arena.node(e) {
                Node::Product(factors) => {
                    bases.extend(factors.iter().filter(|(_, r)| r.is_negative()).map(|(base, _)| *base));
                }
                Node::Power(base, _) => drop(bases.insert(*base)),
                Node::Call(Function::Tan, x) => under_tangents.push(*x),
                _ => {}
            }
        }
        drop(arena);
        bases.extend(under_tangents.into_iter().map(|x| self.call(Function::Cos, x)));
        let mut ranges = FxHashMap::default();
        let mut vanishes = |e: &Expr| {
            let Range { low, high } = self.range_among(*e, known, &mut ranges);
            low <= 0.0 && high >= 0.0
        };
        bases.into_iter().filter(|base| vanishes(base)).collect()
    }
}
