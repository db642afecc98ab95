//! What an expression is made of.

use crate::arena::Node;
use crate::number::Rational;
use crate::{Expr, Function, Graph, Symbol, faults};
use std::collections::BTreeSet;

impl Graph {
    /// Does `symbol` occur in `e`?
    #[track_caller]
    pub fn depends_on(&self, e: Expr, symbol: Symbol) -> bool {
        self.arena.borrow().depends_on(e, symbol) != faults::goes_wrong("answer turned")
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
    /// of them is zero, the expressions are singular. For every `tan a` also `cos a`.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// assert_eq!(g.denominators(&[g.div(x, y), g.powi(y, -2)]), [y]);
    /// let tangent = g.call(symbolic::Function::Tan, x);
    /// assert_eq!(g.denominators(&[tangent]), [g.call(symbolic::Function::Cos, x)]);
    /// ```
    pub fn denominators(&self, es: &[Expr]) -> Vec<Expr> {
        let tangents = self.arguments_of(Function::Tan, es).into_iter().map(|e| self.call(Function::Cos, e));
        let mut bases: BTreeSet<Expr> = tangents.collect();
        let arena = self.arena.borrow();
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

    /// What is zero where a root in `es` has a kink, not numbers: every distinct base of an even power under a
    /// root, as `√(a²) = |a|`, and every other radicand, as `√(a² + b²)`, whether it changes its sign or not.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// let both = g.sum(&[g.powi(x, 2), g.powi(y, 2)]);
    /// assert_eq!(g.kinks(&[g.sqrt(g.powi(x, 2)), g.sqrt(both)]), [x, both]);
    /// ```
    pub fn kinks(&self, es: &[Expr]) -> Vec<Expr> {
        let arena = self.arena.borrow();
        let under = |e: Expr, wanted: fn(&Rational) -> bool| -> Vec<Expr> {
            let Node::Product(factors) = arena.node(e) else { return Vec::new() };
            factors.iter().filter(|(_, r)| wanted(r)).map(|(b, _)| *b).collect()
        };
        let roots = arena.reachable(es, |_| true).into_iter().flat_map(|e| under(e, |r| r.as_integer().is_none()));
        let even = |r: &Rational| r.as_integer().is_some_and(|n| n % 2 == 0);
        let bases = roots.flat_map(|root| match under(root, even) {
            bases if bases.is_empty() => vec![root],
            bases => bases,
        });
        bases.filter(|b| arena.as_number(*b).is_none()).collect::<BTreeSet<Expr>>().into_iter().collect()
    }

    /// Arguments of every call of `function` in `es`.
    fn arguments_of(&self, function: Function, es: &[Expr]) -> BTreeSet<Expr> {
        let arena = self.arena.borrow();
        let argument = |e| match arena.node(e) {
            Node::Call(f, argument) if *f == function => Some(*argument),
            _ => None,
        };
        arena.reachable(es, |_| true).into_iter().filter_map(argument).collect()
    }

    /// Number of expressions made so far: what building and differentiating has cost, on any machine.
    pub fn nodes(&self) -> usize {
        self.arena.borrow().count()
    }

    /// Number of distinct nodes reachable from `es`.
    pub fn size(&self, es: &[Expr]) -> usize {
        self.arena.borrow().reachable(es, |_| true).len()
    }
}
