//! Expressions of one graph in another.

use rustc_hash::FxHashMap;

use crate::store::arena::Node;
use crate::{Expr, Graph};

impl Graph {
    /// The expressions `es` of `other` in this graph; symbols keep their names.
    ///
    /// ```
    /// let (g, other) = (symbolic::Graph::new(), symbolic::Graph::new());
    /// let e = other.sqrt(other.variable(other.symbol("x")));
    /// let x = g.variable(g.symbol("x"));
    /// assert_eq!(g.adopt(&other, &[e]), [g.sqrt(x)]);
    /// ```
    pub fn adopt(&self, other: &Graph, es: &[Expr]) -> Vec<Expr> {
        let theirs = other.arena.borrow();
        let mut own = self.arena.borrow_mut();
        let mut image: FxHashMap<Expr, Expr> = FxHashMap::default();
        for n in theirs.reachable(es, |_| true) {
            let adopted = match theirs.node(n) {
                Node::Symbol(s) => {
                    let symbol = own.symbol(theirs.name(*s));
                    own.intern(Node::Symbol(symbol))
                }
                node => own.with_children(node.clone(), |child| image[child]),
            };
            image.insert(n, adopted);
        }
        es.iter().map(|e| image[e]).collect()
    }
}
