//! The node store behind a graph: hash-consing, names, dependency sets.

use crate::cancel;
use crate::store::mark::Marks;
use crate::store::number::{Number, Rational};
use crate::{Expr, Function, Symbol};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::sync::Arc;

/// What an expression is made of. Children always have earlier places than their parents.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    Number(Number),
    Symbol(Symbol),
    /// constant + Σ coefficient·term; terms sorted by id, neither sums nor numbers.
    Sum(Number, Arc<[(Expr, Number)]>),
    /// Π base^exponent; bases sorted by id.
    Product(Arc<[(Expr, Rational)]>),
    /// base^exponent where the exponent is not a rational number.
    Power(Expr, Expr),
    Call(Function, Expr),
    /// The angle of the point (second, first).
    Atan2(Expr, Expr),
}

impl Node {
    pub(crate) fn each_child(&self, mut visit: impl FnMut(Expr)) {
        match self {
            Node::Number(_) | Node::Symbol(_) => {}
            Node::Sum(_, terms) => terms.iter().for_each(|(t, _)| visit(*t)),
            Node::Product(factors) => factors.iter().for_each(|(b, _)| visit(*b)),
            Node::Power(a, b) | Node::Atan2(a, b) => [*a, *b].into_iter().for_each(visit),
            Node::Call(_, a) => visit(*a),
        }
    }
}

/// Sorted symbols an expression depends on, shared between expressions.
type Dependencies = Arc<[Symbol]>;

#[derive(Clone)]
pub(crate) struct Arena {
    marks: Marks,
    symbol_marks: Marks,
    nodes: Vec<Node>,
    ids: FxHashMap<Node, Expr>,
    names: Vec<Arc<str>>,
    symbols: FxHashMap<Arc<str>, Symbol>,
    /// For each node an index into `sets`.
    dependencies: Vec<u32>,
    sets: Vec<Dependencies>,
    set_ids: FxHashMap<Dependencies, u32>,
    pub(crate) derivatives: FxHashMap<(Expr, Symbol), Expr>,
    /// What has to be no less than zero where a formula was read, and the function of it, which may be gone.
    pub(crate) domains: BTreeSet<(Expr, Expr)>,
    /// What expressions are called where they are printed.
    pub(crate) given_names: FxHashMap<Expr, Arc<str>>,
    /// Expressions that were asked for, new or not.
    asked: u32,
}

impl Default for Arena {
    fn default() -> Self {
        let own = Marks::another();
        let mut arena = Self {
            marks: Marks::new(2, own),
            symbol_marks: Marks::new(0, own),
            nodes: Vec::new(),
            ids: FxHashMap::default(),
            names: Vec::new(),
            symbols: FxHashMap::default(),
            dependencies: Vec::new(),
            sets: Vec::new(),
            set_ids: FxHashMap::default(),
            derivatives: FxHashMap::default(),
            domains: BTreeSet::new(),
            given_names: FxHashMap::default(),
            asked: 0,
        };
        arena.number(Number::ZERO);
        arena.number(Number::ONE);
        arena
    }
}

impl Arena {
    pub(crate) const ZERO: Expr = Expr::common(0);
    pub(crate) const ONE: Expr = Expr::common(1);

    /// A copy of all that is there; what either makes from now on, the other does not know.
    pub(crate) fn fork(&self) -> Self {
        let (mut fork, own) = (self.clone(), Marks::another());
        fork.marks.fork(self.nodes.len(), own);
        fork.symbol_marks.fork(self.names.len(), own);
        fork
    }

    pub(crate) fn node(&self, e: Expr) -> &Node {
        &self.nodes[self.marks.place_of(e)]
    }

    pub(crate) fn count(&self) -> usize {
        self.nodes.len()
    }

    pub(crate) fn intern(&mut self, node: Node) -> Expr {
        self.asked = self.asked.wrapping_add(1);
        if self.asked.is_multiple_of(cancel::EVERY) {
            cancel::go_on();
        }
        if let Some(&e) = self.ids.get(&node) {
            return e;
        }
        let e = self.marks.expression(self.nodes.len());
        let set = self.dependency_set(&node);
        self.dependencies.push(set);
        self.nodes.push(node.clone());
        self.ids.insert(node, e);
        e
    }

    pub(crate) fn number(&mut self, n: Number) -> Expr {
        self.intern(Node::Number(n))
    }

    pub(crate) fn as_number(&self, e: Expr) -> Option<Number> {
        match self.node(e) {
            Node::Number(n) => Some(*n),
            _ => None,
        }
    }

    pub(crate) fn symbol(&mut self, name: &str) -> Symbol {
        if let Some(&s) = self.symbols.get(name) {
            return s;
        }
        let s = self.symbol_marks.symbol(self.names.len());
        let name: Arc<str> = name.into();
        self.names.push(name.clone());
        self.symbols.insert(name, s);
        self.intern(Node::Symbol(s));
        s
    }

    pub(crate) fn find_symbol(&self, name: &str) -> Option<Symbol> {
        self.symbols.get(name).copied()
    }

    pub(crate) fn name(&self, s: Symbol) -> &str {
        &self.names[self.symbol_marks.place_of_symbol(s)]
    }

    /// `e` as a sum: a constant, and terms with their coefficients.
    pub(crate) fn terms_of(&self, e: Expr) -> (Number, Vec<(Expr, Number)>) {
        match self.node(e) {
            Node::Number(n) => (*n, Vec::new()),
            Node::Sum(constant, terms) => (*constant, terms.to_vec()),
            _ => (Number::ZERO, vec![(e, Number::ONE)]),
        }
    }

    /// `e` as a product: factors with their exponents.
    pub(crate) fn factors_of(&self, e: Expr) -> Vec<(Expr, Rational)> {
        match self.node(e) {
            Node::Product(factors) => factors.to_vec(),
            _ => vec![(e, Rational::ONE)],
        }
    }

    /// The symbols `e` depends on, sorted.
    pub(crate) fn dependencies(&self, e: Expr) -> &[Symbol] {
        &self.sets[self.dependencies[self.marks.place_of(e)] as usize]
    }

    pub(crate) fn depends_on(&self, e: Expr, s: Symbol) -> bool {
        self.dependencies(e).binary_search(&s).is_ok()
    }

    fn dependency_set(&mut self, node: &Node) -> u32 {
        if let Node::Symbol(s) = node {
            self.symbol_marks.place_of_symbol(*s);
            return self.intern_set(vec![*s]);
        }
        let mut sets: Vec<u32> = Vec::new();
        node.each_child(|c| {
            let set = self.dependencies[self.marks.place_of(c)];
            if sets.last() != Some(&set) {
                sets.push(set);
            }
        });
        sets.sort_unstable();
        sets.dedup();
        if let [only] = sets[..] {
            return only;
        }
        let mut symbols: Vec<Symbol> = sets.iter().flat_map(|&s| self.sets[s as usize].iter().copied()).collect();
        symbols.sort_unstable();
        symbols.dedup();
        self.intern_set(symbols)
    }

    fn intern_set(&mut self, symbols: Vec<Symbol>) -> u32 {
        if let Some(&id) = self.set_ids.get(&symbols[..]) {
            return id;
        }
        let id = u32::try_from(self.sets.len()).expect("fewer sets than nodes");
        let set: Dependencies = symbols.into();
        self.sets.push(set.clone());
        self.set_ids.insert(set, id);
        id
    }

    /// The nodes reachable from `roots` through nodes that satisfy `enter`, children first.
    pub(crate) fn reachable(&self, roots: &[Expr], enter: impl Fn(Expr) -> bool) -> Vec<Expr> {
        // a bit for each node; children have earlier places, so one way down finds all of them
        let place = |e: Expr| {
            let place = self.marks.place_of(e);
            (place / 64, 1_u64 << (place % 64))
        };
        let highest = roots.iter().max().map_or(0, |&e| place(e).0 + 1);
        let mut marked = vec![0_u64; highest];
        let mark = |marked: &mut [u64], e: Expr| {
            let (word, bit) = place(e);
            if marked[word] & bit == 0 && enter(e) {
                marked[word] |= bit;
            }
        };
        roots.iter().for_each(|&e| mark(&mut marked, e));
        let mut order = Vec::new();
        for word in (0..highest).rev() {
            let mut done = 0;
            while marked[word] != done {
                let bit = 63 - (marked[word] & !done).leading_zeros();
                done |= 1 << bit;
                let e = self.marks.expression(word * 64 + bit as usize);
                order.push(e);
                self.node(e).each_child(|c| mark(&mut marked, c));
            }
        }
        order.reverse();
        order
    }

    /// Whether a number in `e` is not exact.
    pub(crate) fn contains_float(&self, e: Expr) -> bool {
        let float = |n: &Number| matches!(n, Number::Float(_));
        self.reachable(&[e], |_| true).into_iter().any(|e| match self.node(e) {
            Node::Number(n) => float(n),
            Node::Sum(constant, terms) => float(constant) || terms.iter().any(|(_, c)| float(c)),
            _ => false,
        })
    }

    /// `es` with `change` made to every node in them, children first.
    pub(crate) fn rewritten(&mut self, es: &[Expr], mut change: impl FnMut(&mut Self, Expr) -> Expr) -> Vec<Expr> {
        let mut image: FxHashMap<Expr, Expr> = FxHashMap::default();
        for n in self.reachable(es, |_| true) {
            let rebuilt = self.rebuild(n, &image);
            let new = change(self, rebuilt);
            if new != n {
                image.insert(n, new);
            }
        }
        es.iter().map(|e| image.get(e).copied().unwrap_or(*e)).collect()
    }

    /// `e` with its children replaced by what `image` says, simplified again.
    pub(crate) fn rebuild(&mut self, e: Expr, image: &FxHashMap<Expr, Expr>) -> Expr {
        match self.node(e).clone() {
            Node::Number(_) | Node::Symbol(_) => e,
            node => self.with_children(node, |c| image.get(c).copied().unwrap_or(*c)),
        }
    }

    /// A node, of this graph or of another one, with the children that `of` says, simplified.
    pub(crate) fn with_children(&mut self, node: Node, of: impl Fn(&Expr) -> Expr) -> Expr {
        match node {
            Node::Number(n) => self.number(n),
            Node::Symbol(s) => self.intern(Node::Symbol(s)),
            Node::Sum(constant, terms) => {
                let parts = terms.iter().map(|(t, c)| (of(t), *c)).collect();
                self.linear(constant, parts)
            }
            Node::Product(factors) => {
                let factors = factors.iter().map(|(b, r)| (of(b), *r)).collect();
                self.power_product(Number::ONE, factors)
            }
            Node::Power(base, exponent) => self.pow(of(&base), of(&exponent)),
            Node::Call(function, argument) => self.call(function, of(&argument)),
            Node::Atan2(y, x) => self.atan2(of(&y), of(&x)),
        }
    }
}
