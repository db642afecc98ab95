//! Long expressions cut into named pieces.

use crate::limits::LINE;
use crate::store::arena::{Arena, Node};
use crate::store::number::Number;
use crate::{Expr, Graph, Symbol};
use rustc_hash::FxHashMap;

/// A shared subexpression of at least this many printed leaves gets a name.
const SHARED_LEAVES: usize = 4;
/// One that has a name already ([`Graph::give_name`]).
const NAMED_LEAVES: usize = 2;

impl Graph {
    /// Pulls out shared or long subexpressions as `prefix1`, `prefix2`, … so that what remains can be read:
    /// (definitions in order of use, rewritten expressions). Later definitions may contain earlier names;
    /// putting them back, the last first, gives the given expressions.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let [a, b, c, d] = ["a", "b", "c", "d"].map(|n| g.variable(g.symbol(n)));
    /// let shared = g.sum(&[a, b, c, d]);
    /// let (definitions, rest) = g.abbreviate(&[g.powi(shared, 2), g.sqrt(shared)], "s");
    /// assert_eq!(definitions, [(g.symbol("s1"), shared)]);
    /// assert_eq!(g.plain(rest[0]), "s1^2");
    /// ```
    ///
    /// What was given a name keeps it ([`Graph::give_name`]).
    pub fn abbreviate(&self, es: &[Expr], prefix: &str) -> (Vec<(Symbol, Expr)>, Vec<Expr>) {
        let mut arena = self.arena.borrow_mut();
        let order = arena.reachable(es, |_| true);
        let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
        for n in &order {
            arena.node(*n).each_child(|child| *uses.entry(child).or_default() += 1);
        }
        for e in es {
            *uses.entry(*e).or_default() += 1;
        }
        let mut image: FxHashMap<Expr, Expr> = FxHashMap::default();
        let mut names = Names { prefix, number: 0, definitions: Vec::new() };
        for n in order {
            let mut new = arena.rebuild(n, &image);
            if arena.leaves(new) > LINE {
                new = arena.split_long(new, &mut names);
            }
            let named = arena.given_names.get(&n).cloned();
            if uses[&n] > 1 && arena.leaves(new) >= if named.is_some() { NAMED_LEAVES } else { SHARED_LEAVES } {
                new = match named {
                    Some(name) => names.define(&mut arena, &name, new),
                    None => names.name(&mut arena, new),
                };
            }
            image.insert(n, new);
        }
        let rest = es.iter().map(|e| image[e]).collect();
        (names.definitions, rest)
    }
}

impl Graph {
    /// Lets `e` be called so where it is shared by what is printed.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x"));
    /// let sum = g.add(x, g.powi(x, 2));
    /// g.give_name(sum, "d");
    /// let (definitions, rest) = g.abbreviate(&[g.powi(sum, 3), g.sqrt(sum)], "s");
    /// assert_eq!(definitions, [(g.symbol("d"), sum)]);
    /// assert_eq!(g.plain(rest[0]), "d^3");
    /// ```
    pub fn give_name(&self, e: Expr, name: &str) {
        self.arena.borrow_mut().given_names.entry(e).or_insert_with(|| name.into());
    }

    /// Symbols and numbers in `e` as it would be printed, shared parts counted wherever they stand.
    pub fn printed_length(&self, e: Expr) -> usize {
        let arena = self.arena.borrow();
        let mut lengths: FxHashMap<Expr, usize> = FxHashMap::default();
        for n in arena.reachable(&[e], |_| true) {
            let mut length = 0_usize;
            arena.node(n).each_child(|child| length = length.saturating_add(lengths[&child]));
            lengths.insert(n, length.max(1));
        }
        lengths[&e]
    }
}

/// The definitions so far.
struct Names<'a> {
    prefix: &'a str,
    number: usize,
    definitions: Vec<(Symbol, Expr)>,
}

impl Names<'_> {
    /// A new symbol for `e`, with the next number whose name is not taken.
    fn name(&mut self, arena: &mut Arena, e: Expr) -> Expr {
        let symbol = loop {
            self.number += 1;
            let name = format!("{}{}", self.prefix, self.number);
            if arena.find_symbol(&name).is_none() {
                break arena.symbol(&name);
            }
        };
        self.push(arena, symbol, e)
    }

    /// The symbol of that name for `e`.
    fn define(&mut self, arena: &mut Arena, name: &str, e: Expr) -> Expr {
        let symbol = arena.symbol(name);
        self.push(arena, symbol, e)
    }

    fn push(&mut self, arena: &mut Arena, symbol: Symbol, e: Expr) -> Expr {
        self.definitions.push((symbol, e));
        arena.intern(Node::Symbol(symbol))
    }
}

impl Arena {
    /// A long sum as a sum of names for groups of its terms; a long product with names for its long factors.
    fn split_long(&mut self, e: Expr, names: &mut Names) -> Expr {
        match self.node(e).clone() {
            Node::Sum(constant, terms) if terms.len() > 1 => {
                let mut groups: Vec<Vec<(Expr, Number)>> = Vec::new();
                let mut room = 0;
                for (t, c) in self.sorted_terms(&terms) {
                    let leaves = self.leaves(t) + usize::from(!c.abs().is_one());
                    match groups.last_mut() {
                        Some(group) if leaves <= room => {
                            group.push((t, c));
                            room -= leaves;
                        }
                        _ => {
                            groups.push(vec![(t, c)]);
                            room = (LINE / 2).saturating_sub(leaves);
                        }
                    }
                }
                let mut parts = Vec::with_capacity(groups.len());
                for group in groups {
                    let sum = self.linear(Number::ZERO, group);
                    parts.push((names.name(self, sum), Number::ONE));
                }
                let sum = self.linear(constant, parts);
                if self.leaves(sum) > LINE { self.split_long(sum, names) } else { sum }
            }
            Node::Product(factors) => {
                let mut named = Vec::with_capacity(factors.len());
                for (base, exponent) in factors.iter() {
                    let long = self.leaves(*base) > LINE / 4;
                    let base = if long { names.name(self, *base) } else { *base };
                    named.push((base, *exponent));
                }
                self.power_product(Number::ONE, named)
            }
            _ => e,
        }
    }

    /// Symbols and numbers that the printed expression shows, counted up to a little over the limit.
    fn leaves(&self, e: Expr) -> usize {
        let mut count = 0;
        let mut stack = vec![e];
        while let Some(n) = stack.pop() {
            match self.node(n) {
                Node::Number(_) | Node::Symbol(_) => count += 1,
                Node::Sum(constant, terms) => {
                    count += usize::from(*constant != Number::ZERO);
                    count += terms.iter().filter(|(_, c)| !c.abs().is_one()).count();
                    stack.extend(terms.iter().map(|(t, _)| *t));
                }
                node => node.each_child(|c| stack.push(c)),
            }
            if count > LINE {
                break;
            }
        }
        count
    }
}
