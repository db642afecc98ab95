//! Expressions of one graph in another.

use rustc_hash::FxHashMap;

use crate::store::arena::{Arena, Node};
use crate::store::number::Number;
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
            let adopted = own.adopted(&theirs, n, &image);
            image.insert(n, adopted);
        }
        es.iter().map(|e| image[e]).collect()
    }
}

impl Arena {
    fn adopted(&mut self, theirs: &Arena, n: Expr, image: &FxHashMap<Expr, Expr>) -> Expr {
        match theirs.node(n) {
            Node::Number(x) => self.number(*x),
            Node::Symbol(s) => {
                let symbol = self.symbol(theirs.name(*s));
                self.intern(Node::Symbol(symbol))
            }
            Node::Sum(constant, terms) => self.linear(*constant, terms.iter().map(|(t, c)| (image[t], *c)).collect()),
            Node::Product(factors) => {
                self.power_product(Number::ONE, factors.iter().map(|(b, r)| (image[b], *r)).collect())
            }
            Node::Power(base, exponent) => self.pow(image[base], image[exponent]),
            Node::Call(function, argument) => self.call(*function, image[argument]),
            Node::Atan2(y, x) => self.atan2(image[y], image[x]),
        }
    }
}
