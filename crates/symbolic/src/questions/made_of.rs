//! Queries on expressions: symbols, denominators, roots, size.

use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
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
        let bases = self.divided_by(es, Arena::leads_negative);
        bases.into_iter().filter(|b| self.as_number(*b).is_none()).collect()
    }

    /// Bases in `es` of negative powers, and of powers with such an exponent among those that are no
    /// numbers; the cosine under a tangent.
    pub(crate) fn divided_by(&self, es: &[Expr], exponent: impl Fn(&Arena, Expr) -> bool) -> BTreeSet<Expr> {
        let tangents = self.arguments_of(Function::Tan, es).into_iter().map(|e| self.call(Function::Cos, e));
        let mut bases: BTreeSet<Expr> = self.bases(es, |r| r.is_negative()).into_iter().chain(tangents).collect();
        let arena = self.arena.borrow();
        let power = |e| match arena.node(e) {
            Node::Power(base, x) if exponent(&arena, *x) => Some(*base),
            _ => None,
        };
        bases.extend(arena.reachable(es, |_| true).into_iter().filter_map(power));
        bases
    }

    /// Whether every number in `es` is an exact fraction.
    pub fn are_exact(&self, es: &[Expr]) -> bool {
        let arena = self.arena.borrow();
        !es.iter().any(|&e| arena.contains_float(e))
    }

    /// Every distinct base of an even power under a root in `es`, not a number: `√(a²) = |a|` has a kink
    /// where `a` is zero, and its radicand does not change its sign there.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// let both = g.sum(&[g.powi(x, 2), g.powi(y, 2)]);
    /// assert_eq!(g.kinks(&[g.sqrt(g.powi(x, 2)), g.sqrt(both), g.sqrt(y)]), [x]);
    /// assert_eq!(g.radicands(&[g.sqrt(g.powi(x, 2)), g.sqrt(both), g.sqrt(y)]), [y, both]);
    /// ```
    pub fn kinks(&self, es: &[Expr]) -> Vec<Expr> {
        let bases: BTreeSet<Expr> = self.under_roots(es).into_iter().flat_map(|root| self.even_bases(root)).collect();
        bases.into_iter().collect()
    }

    /// Every other distinct radicand in `es`, not a number: as `√(a² + b²)`, it has a kink where it is zero.
    pub fn radicands(&self, es: &[Expr]) -> Vec<Expr> {
        let mut roots = self.under_roots(es);
        roots.retain(|&root| self.even_bases(root).is_empty() && self.arena.borrow().as_number(root).is_none());
        roots.into_iter().collect()
    }

    /// What is zero where an analytic piece of `es` may end: [`Graph::kinks`], [`Graph::radicands`], and `1 −
    /// u²` for inverse sines and cosines of `u`: `asin(sin x)` is `x` up to `x = π/2` only.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let turned = g.call(symbolic::Function::Asin, g.call(symbolic::Function::Sin, x));
    /// assert_eq!(g.ends_of_pieces(&[turned]).len(), 1);
    /// ```
    pub fn ends_of_pieces(&self, es: &[Expr]) -> Vec<Expr> {
        let inverse = [Function::Asin, Function::Acos].into_iter().flat_map(|f| self.arguments_of(f, es));
        let inverse: Vec<Expr> = inverse.map(|u| self.sub(self.one(), self.powi(u, 2))).collect();
        [self.kinks(es), self.radicands(es), inverse].concat()
    }

    /// Every distinct base of a power that is not an integer, in `es`.
    pub fn under_roots(&self, es: &[Expr]) -> BTreeSet<Expr> {
        self.bases(es, |r| r.as_integer().is_none())
    }

    /// Every distinct power in `es` whose exponent is not an integer, as (base, power).
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// let root = g.sqrt(g.add(x, y));
    /// assert_eq!(g.roots(&[g.mul(g.powi(y, 2), root)]), [(g.add(x, y), root)]);
    /// ```
    pub fn roots(&self, es: &[Expr]) -> Vec<(Expr, Expr)> {
        let powers = self.powers(es, |r| r.as_integer().is_none()).into_iter();
        powers.map(|(base, r)| (base, self.arena.borrow_mut().power_product(Number::ONE, vec![(base, r)]))).collect()
    }

    fn even_bases(&self, radicand: Expr) -> Vec<Expr> {
        let arena = self.arena.borrow();
        let Node::Product(factors) = arena.node(radicand) else { return Vec::new() };
        factors.iter().filter(|(_, r)| r.as_integer().is_some_and(|n| n % 2 == 0)).map(|(base, _)| *base).collect()
    }

    /// Every distinct sum that stands squared in `e`.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// let both = g.add(x, y);
    /// assert_eq!(g.squared_sums(g.add(g.powi(both, 2), g.powi(x, 2))), [both]);
    /// ```
    pub fn squared_sums(&self, e: Expr) -> Vec<Expr> {
        let squared = self.bases(&[e], |r| r.as_integer() == Some(2));
        squared.into_iter().filter(|&e| self.arena.borrow().term_count(e) > 1).collect()
    }

    /// The terms of a sum, each with its coefficient; `e` alone where it is none.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.variable(g.symbol("x")), g.variable(g.symbol("y")));
    /// let terms = g.terms(g.sub(g.mul(g.integer(3), x), y));
    /// assert_eq!(terms.iter().map(|&e| g.plain(e)).collect::<Vec<_>>(), ["3*x", "-y"]);
    /// ```
    pub fn terms(&self, e: Expr) -> Vec<Expr> {
        let mut arena = self.arena.borrow_mut();
        let Node::Sum(constant, terms) = arena.node(e).clone() else { return vec![e] };
        let constant = (!constant.is_zero()).then(|| arena.number(constant));
        let terms: Vec<Expr> = terms.iter().map(|&(term, c)| arena.scale(c, term)).collect();
        terms.into_iter().chain(constant).collect()
    }

    /// The factors of a product with their exponents in them, without the number before it.
    pub fn factors(&self, e: Expr) -> Vec<Expr> {
        let mut arena = self.arena.borrow_mut();
        match arena.node(e).clone() {
            Node::Sum(c, terms) if c.is_zero() && terms.len() == 1 => {
                drop(arena);
                self.factors(terms[0].0)
            }
            Node::Product(factors) => {
                factors.iter().map(|&factor| arena.power_product(Number::ONE, vec![factor])).collect()
            }
            Node::Number(_) => Vec::new(),
            _ => vec![e],
        }
    }

    /// The factors of products in `es` that have such an exponent there, each with it.
    pub(crate) fn powers(&self, es: &[Expr], wanted: impl Fn(&Rational) -> bool) -> BTreeSet<(Expr, Rational)> {
        let arena = self.arena.borrow();
        let factors = |e| match arena.node(e) {
            Node::Product(factors) => &factors[..],
            _ => &[],
        };
        arena.reachable(es, |_| true).into_iter().flat_map(factors).filter(|(_, r)| wanted(r)).copied().collect()
    }

    /// [`Graph::powers`] without their exponents.
    fn bases(&self, es: &[Expr], wanted: impl Fn(&Rational) -> bool) -> BTreeSet<Expr> {
        self.powers(es, wanted).into_iter().map(|(base, _)| base).collect()
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
