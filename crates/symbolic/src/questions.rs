//! What an expression is made of.

use crate::arena::Node;
use crate::{Expr, Graph, Symbol};
use std::collections::BTreeSet;

impl Graph {
    /// Does `symbol` occur in `e`?
    pub fn depends_on(&self, e: Expr, symbol: Symbol) -> bool {
        self.arena.borrow().depends_on(e, symbol)
    }

    /// The symbols that occur in `e`.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.symbol("x");
    /// let e = g.add(g.variable(x), g.one());
    /// assert_eq!(g.symbols_of(e), [x].into());
    /// ```
    pub fn symbols_of(&self, e: Expr) -> BTreeSet<Symbol> {
        self.symbols_of_all(&[e])
    }

    pub(crate) fn symbols_of_all(&self, es: &[Expr]) -> BTreeSet<Symbol> {
        let arena = self.arena.borrow();
        es.iter().flat_map(|e| arena.dependencies(*e).iter().copied()).collect()
    }

    /// Every distinct base that stands in `es` under a negative power, and is not a number: where one
    /// of them is zero, the expressions are singular.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// assert_eq!(g.denominators(&[g.div(x, y), g.powi(y, -2)]), [y]);
    /// ```
    pub fn denominators(&self, es: &[Expr]) -> Vec<Expr> {
        let arena = self.arena.borrow();
        let mut bases = BTreeSet::new();
        for e in arena.reachable(es, |_| true) {
            match arena.node(e) {
                Node::Product(factors) => {
                    bases.extend(factors.iter().filter(|(_, r)| r.is_negative()).map(|(b, _)| *b));
                }
                Node::Power(base, exponent) if arena.leads_negative(*exponent) => {
                    bases.insert(*base);
                }
                _ => {}
            }
        }
        bases.into_iter().filter(|b| arena.as_number(*b).is_none()).collect()
    }

    /// Number of distinct nodes reachable from `es`.
    pub fn size(&self, es: &[Expr]) -> usize {
        self.arena.borrow().reachable(es, |_| true).len()
    }
}
