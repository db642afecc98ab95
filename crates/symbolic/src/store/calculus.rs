//! Derivatives and substitution.

use crate::store::arena::{Arena, Node};
use crate::store::faults;
use crate::store::number::{Number, Rational};
use crate::{Expr, Function, Graph, Matrix, Symbol};
use rustc_hash::FxHashMap;
use std::collections::HashMap;

impl Graph {
    /// ∂e/∂symbol
    ///
    /// ```
    /// use symbolic::{Function, Graph};
    /// let g = Graph::new();
    /// let s = g.symbol("phi");
    /// let sine = g.call(Function::Sin, g.variable(s));
    /// assert_eq!(g.derivative(sine, s), g.call(Function::Cos, g.variable(s)));
    /// ```
    #[track_caller]
    pub fn derivative(&self, e: Expr, symbol: Symbol) -> Expr {
        let derivative = self.arena.borrow_mut().derivative(e, symbol);
        self.perhaps_spoiled(derivative)
    }

    /// (∂e/∂s for s in `symbols`)
    ///
    /// Of a sum, only the terms that contain a symbol are looked at for it.
    #[track_caller]
    pub fn gradient(&self, e: Expr, symbols: &[Symbol]) -> Vec<Expr> {
        self.jacobian(&[e], symbols).row(0).to_vec()
    }

    /// The derivatives of `e` by those of `symbols` that occur in it, with the symbols in the order given.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let symbols = ["x", "y", "z"].map(|name| g.symbol(name));
    /// let e = g.mul(g.integer(2), g.variable(symbols[2]));
    /// assert_eq!(g.sparse_gradient(e, &symbols), [(symbols[2], g.integer(2))]);
    /// ```
    #[track_caller]
    pub fn sparse_gradient(&self, e: Expr, symbols: &[Symbol]) -> Vec<(Symbol, Expr)> {
        self.sparse_jacobian(&[e], symbols).remove(0)
    }

    /// [`Graph::sparse_gradient`] of several expressions.
    #[track_caller]
    pub fn sparse_jacobian(&self, es: &[Expr], symbols: &[Symbol]) -> Vec<Vec<(Symbol, Expr)>> {
        let places = Places::new(symbols);
        let mut rows = Vec::with_capacity(es.len());
        for e in es {
            let found = self.arena.borrow_mut().gradient(*e, &places);
            let mut row = Vec::with_capacity(found.len());
            for (place, derivative) in found {
                row.push((symbols[place], self.perhaps_spoiled(derivative)));
            }
            rows.push(row);
        }
        rows
    }

    /// The matrix ∂eᵢ/∂sⱼ: a row for each expression, a column for each symbol.
    #[track_caller]
    pub fn jacobian(&self, es: &[Expr], symbols: &[Symbol]) -> Matrix {
        let places = Places::new(symbols);
        let mut entries = vec![self.zero(); es.len() * symbols.len()];
        for (row, e) in es.iter().enumerate() {
            let found = self.arena.borrow_mut().gradient(*e, &places);
            for (place, derivative) in found {
                entries[row * symbols.len() + place] = self.perhaps_spoiled(derivative);
            }
        }
        Matrix::new(es.len(), symbols.len(), entries)
    }

    /// de/dt = Σ ∂e/∂s · rate over the given (symbol, rate) pairs; explicit time among them as (t, 1).
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let (x, v) = (g.symbol("x"), g.symbol("x'"));
    /// let energy = g.powi(g.variable(x), 2);
    /// let power = g.product(&[g.integer(2), g.variable(x), g.variable(v)]);
    /// assert_eq!(g.total_derivative(energy, &[(x, g.variable(v))]), power);
    /// ```
    #[track_caller]
    pub fn total_derivative(&self, e: Expr, rates: &[(Symbol, Expr)]) -> Expr {
        self.total_derivatives(&[e], rates)[0]
    }

    /// [`Graph::total_derivative`] of several; the work grows with what they contain, not with the rates.
    #[track_caller]
    pub fn total_derivatives(&self, es: &[Expr], rates: &[(Symbol, Expr)]) -> Vec<Expr> {
        let symbols: Vec<Symbol> = rates.iter().map(|(s, _)| *s).collect();
        let places = Places::new(&symbols);
        let mut along = Vec::with_capacity(es.len());
        for e in es {
            let occurring = places.within(self.arena.borrow().dependencies(*e));
            let mut terms = Vec::with_capacity(occurring.len());
            for place in occurring {
                terms.push(self.mul(self.derivative(*e, symbols[place]), rates[place].1));
            }
            along.push(self.sum(&terms));
        }
        along
    }

    /// `e` with every symbol of `map` replaced, all at once.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let (x, y) = (g.symbol("x"), g.symbol("y"));
    /// let swap = HashMap::from([(x, g.variable(y)), (y, g.variable(x))]);
    /// let difference = g.sub(g.variable(x), g.variable(y));
    /// assert_eq!(g.substitute(difference, &swap), g.neg(difference));
    /// ```
    #[track_caller]
    pub fn substitute(&self, e: Expr, map: &HashMap<Symbol, Expr>) -> Expr {
        self.substitute_all(&[e], map)[0]
    }

    /// [`Graph::substitute`] for several expressions, sharing the work.
    #[track_caller]
    pub fn substitute_all(&self, es: &[Expr], map: &HashMap<Symbol, Expr>) -> Vec<Expr> {
        let mut substituted = self.substituted(es, map);
        for (new, old) in substituted.iter_mut().zip(es) {
            if new != old && faults::goes_wrong("substitution left out") {
                *new = *old;
            }
        }
        substituted
    }

    /// `e` with every subexpression that `map` knows replaced, the inner ones first.
    ///
    /// ```
    /// use std::collections::HashMap;
    /// let g = symbolic::Graph::new();
    /// let [x, y, z] = ["x", "y", "z"].map(|name| g.variable(g.symbol(name)));
    /// let square = g.powi(g.add(x, y), 2);
    /// assert_eq!(g.replace(square, &HashMap::from([(g.add(x, y), z)])), g.powi(z, 2));
    /// ```
    pub fn replace(&self, e: Expr, map: &HashMap<Expr, Expr>) -> Expr {
        self.arena.borrow_mut().rewritten(&[e], |_, e| map.get(&e).copied().unwrap_or(e))[0]
    }

    /// [`Graph::substitute_all`], never spoiled.
    pub(crate) fn substituted(&self, es: &[Expr], map: &HashMap<Symbol, Expr>) -> Vec<Expr> {
        let mut arena = self.arena.borrow_mut();
        let touched = arena.reachable(es, |e| arena.dependencies(e).iter().any(|s| map.contains_key(s)));
        let mut image: FxHashMap<Expr, Expr> = FxHashMap::default();
        image.reserve(touched.len());
        for e in touched {
            let new = match arena.node(e) {
                Node::Symbol(s) => map[s],
                _ => arena.rebuild(e, &image),
            };
            image.insert(e, new);
        }
        es.iter().map(|e| image.get(e).copied().unwrap_or(*e)).collect()
    }
}

/// A list of symbols and where each stands in it.
struct Places<'a> {
    list: &'a [Symbol],
    /// Sorted.
    of: Vec<(Symbol, usize)>,
}

impl<'a> Places<'a> {
    fn new(list: &'a [Symbol]) -> Self {
        let mut of: Vec<(Symbol, usize)> = list.iter().enumerate().map(|(place, symbol)| (*symbol, place)).collect();
        of.sort_unstable();
        Places { list, of }
    }

    /// Where a symbol stands, everywhere.
    fn of(&self, symbol: Symbol) -> impl Iterator<Item = usize> {
        let first = self.of.partition_point(|(other, _)| *other < symbol);
        self.of[first..].iter().take_while(move |(other, _)| *other == symbol).map(|(_, place)| *place)
    }

    /// The places of those symbols that are in `occurring`, in rising order.
    fn within(&self, occurring: &[Symbol]) -> Vec<usize> {
        let mut found: Vec<usize> = occurring.iter().flat_map(|s| self.of(*s)).collect();
        found.sort_unstable();
        found
    }
}

impl Arena {
    /// The derivatives of `e` by the symbols in it, with their places in rising order.
    fn gradient(&mut self, e: Expr, places: &Places) -> Vec<(usize, Expr)> {
        let wanted = places.within(self.dependencies(e));
        if wanted.len() > 1
            && let Node::Sum(_, terms) = self.node(e).clone()
        {
            self.differentiate_sum(e, &terms, &wanted, places);
        }
        wanted.into_iter().map(|place| (place, self.derivative(e, places.list[place]))).collect()
    }

    /// Writes down the derivatives of a sum: for each symbol only from the terms that contain it.
    fn differentiate_sum(&mut self, e: Expr, terms: &[(Expr, Number)], wanted: &[usize], places: &Places) {
        let mut containing: FxHashMap<Symbol, Vec<(Expr, Number)>> = FxHashMap::default();
        for (t, c) in terms {
            for s in self.dependencies(*t).iter().filter(|s| places.of(**s).next().is_some()) {
                containing.entry(*s).or_default().push((*t, *c));
            }
        }
        for s in wanted.iter().map(|place| places.list[*place]) {
            if self.derivatives.contains_key(&(e, s)) {
                continue;
            }
            let terms = &containing[&s];
            let roots: Vec<Expr> = terms.iter().map(|(t, _)| *t).collect();
            self.differentiate(&roots, s);
            let parts = terms.iter().map(|(t, c)| (self.known(*t, s), *c)).collect();
            let derivative = self.linear(Number::ZERO, parts);
            self.derivatives.insert((e, s), derivative);
        }
    }

    pub(crate) fn derivative(&mut self, e: Expr, s: Symbol) -> Expr {
        if !self.depends_on(e, s) {
            return Self::ZERO;
        }
        if let Some(d) = self.derivatives.get(&(e, s)) {
            return *d;
        }
        self.differentiate(&[e], s);
        self.derivatives[&(e, s)]
    }

    /// Writes down the derivatives of everything in `roots` that contains `s`.
    fn differentiate(&mut self, roots: &[Expr], s: Symbol) {
        let open = self.reachable(roots, |n| self.depends_on(n, s) && !self.derivatives.contains_key(&(n, s)));
        for n in open {
            let d = self.derivative_of_node(n, s);
            self.derivatives.insert((n, s), d);
        }
    }

    /// ∂e/∂s, given those of the children.
    fn derivative_of_node(&mut self, e: Expr, s: Symbol) -> Expr {
        match self.node(e).clone() {
            Node::Number(_) => Self::ZERO,
            Node::Symbol(_) => Self::ONE,
            Node::Sum(_, terms) => {
                let parts = terms.iter().map(|(t, c)| (self.known(*t, s), *c)).collect();
                self.linear(Number::ZERO, parts)
            }
            Node::Product(factors) => {
                let mut parts = Vec::new();
                for (i, (base, exponent)) in factors.iter().enumerate() {
                    let inner = self.known(*base, s);
                    if inner == Self::ZERO {
                        continue;
                    }
                    let mut rest = factors.to_vec();
                    // An exponent so large that one less does not fit keeps the factor apart.
                    match exponent.add(Rational::integer(-1)) {
                        Some(lower) => rest[i].1 = lower,
                        None => rest.push((*base, Rational::integer(-1))),
                    }
                    rest.push((inner, Rational::ONE));
                    parts.push((self.power_product(Number::Exact(*exponent), rest), Number::ONE));
                }
                self.linear(Number::ZERO, parts)
            }
            Node::Power(base, exponent) => {
                // b^e ( e' log b + e b'/b )
                let (db, de) = (self.known(base, s), self.known(exponent, s));
                let mut parts = Vec::new();
                // 0^e is 0 wherever it has a derivative
                if de != Self::ZERO && base != Self::ZERO {
                    let log = self.call(Function::Log, base);
                    parts.push((self.times(&[e, log, de]), Number::ONE));
                }
                if db != Self::ZERO {
                    let lower = self.linear(Number::MINUS_ONE, vec![(exponent, Number::ONE)]);
                    let power = self.pow(base, lower);
                    parts.push((self.times(&[exponent, power, db]), Number::ONE));
                }
                self.linear(Number::ZERO, parts)
            }
            Node::Call(function, argument) => {
                let outer = self.outer_derivative(function, argument, e);
                let inner = self.known(argument, s);
                self.times(&[outer, inner])
            }
            Node::Atan2(y, x) => {
                // (x y' − y x') / (x² + y²)
                let (dy, dx) = (self.known(y, s), self.known(x, s));
                let (a, b) = (self.times(&[x, dy]), self.times(&[y, dx]));
                let top = self.linear(Number::ZERO, vec![(a, Number::ONE), (b, Number::MINUS_ONE)]);
                let (xx, yy) = (self.times(&[x, x]), self.times(&[y, y]));
                let bottom = self.linear(Number::ZERO, vec![(xx, Number::ONE), (yy, Number::ONE)]);
                let factors = vec![(top, Rational::ONE), (bottom, Rational::integer(-1))];
                self.power_product(Number::ONE, factors)
            }
        }
    }

    fn known(&self, e: Expr, s: Symbol) -> Expr {
        if self.depends_on(e, s) { self.derivatives[&(e, s)] } else { Self::ZERO }
    }

    pub(crate) fn times(&mut self, factors: &[Expr]) -> Expr {
        let factors = factors.iter().map(|f| (*f, Rational::ONE)).collect();
        self.power_product(Number::ONE, factors)
    }

    /// f'(u), where `value` is the node f(u).
    fn outer_derivative(&mut self, function: Function, u: Expr, value: Expr) -> Expr {
        let square = |arena: &mut Arena, e: Expr| arena.times(&[e, e]);
        let minus_half = Rational::new(-1, 2).expect("a fraction");
        // constant + c·square, to a power
        let mut inverse = |constant: i64, c: i64, of: Expr, exponent: Rational, sign: i64| {
            let squared = square(self, of);
            let inner = self.linear(Number::integer(constant), vec![(squared, Number::integer(c))]);
            self.power_product(Number::integer(sign), vec![(inner, exponent)])
        };
        let minus_one = Rational::integer(-1);
        match function {
            Function::Sin => self.call(Function::Cos, u),
            Function::Cos => {
                let sine = self.call(Function::Sin, u);
                self.scale(Number::MINUS_ONE, sine)
            }
            Function::Tan => inverse(1, 1, value, Rational::ONE, 1),
            Function::Sinh => self.call(Function::Cosh, u),
            Function::Cosh => self.call(Function::Sinh, u),
            Function::Tanh => inverse(1, -1, value, Rational::ONE, 1),
            Function::Asin => inverse(1, -1, u, minus_half, 1),
            Function::Acos => inverse(1, -1, u, minus_half, -1),
            Function::Atan => inverse(1, 1, u, minus_one, 1),
            Function::Asinh => inverse(1, 1, u, minus_half, 1),
            Function::Acosh => inverse(-1, 1, u, minus_half, 1),
            Function::Atanh => inverse(1, -1, u, minus_one, 1),
            Function::Exp => value,
            Function::Log => self.power_product(Number::ONE, vec![(u, minus_one)]),
        }
    }
}
