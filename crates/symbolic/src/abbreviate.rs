//! Long expressions cut into named pieces.

use crate::arena::{Arena, Node};
use crate::number::Number;
use crate::{Expr, Graph, Symbol};
use rustc_hash::FxHashMap;

/// A shared subexpression of at least this many printed leaves gets a name.
const SHARED_LEAVES: usize = 4;
/// An expression of more printed leaves than this is cut.
const LONG_LEAVES: usize = 60;

impl Graph {
    /// Pulls out shared or long subexpressions as named intermediate quantities (names `prefix1`,
    /// `prefix2`, …) so that what remains can be read: (definitions in order of use, rewritten
    /// expressions). Later definitions may contain earlier names; putting the definitions back, the
    /// last first, gives the expressions that were given.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let [a, b, c, d] = ["a", "b", "c", "d"].map(|n| g.variable(g.symbol(n)));
    /// let shared = g.sum(&[a, b, c, d]);
    /// let (definitions, rest) = g.abbreviate(&[g.powi(shared, 2), g.sqrt(shared)], "s");
    /// assert_eq!(definitions, [(g.symbol("s1"), shared)]);
    /// assert_eq!(g.plain(rest[0]), "s1^2");
    /// ```
    pub fn abbreviate(&self, es: &[Expr], prefix: &str) -> (Vec<(Symbol, Expr)>, Vec<Expr>) {
        let mut arena = self.arena.borrow_mut();
        let order = arena.reachable(es, |_| true);
        let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
        for n in &order {
            for child in arena.node(*n).children() {
                *uses.entry(child).or_default() += 1;
            }
        }
        for e in es {
            *uses.entry(*e).or_default() += 1;
        }
        let mut image: FxHashMap<Expr, Expr> = FxHashMap::default();
        let mut definitions: Vec<(Symbol, Expr)> = Vec::new();
        let mut number = 0;
        for n in order {
            let new = arena.rebuild(n, &image);
            let leaves = arena.leaves(new);
            let whole = es.contains(&n) && uses[&n] == 1;
            let shared = uses[&n] > 1 && leaves >= SHARED_LEAVES;
            let long = leaves > LONG_LEAVES;
            let nameable = matches!(
                arena.node(n),
                Node::Sum(..) | Node::Product(_) | Node::Power(..)
            ) || leaves > SHARED_LEAVES;
            if whole || !nameable || !(shared || long) {
                image.insert(n, new);
                continue;
            }
            let symbol = arena.fresh_symbol(prefix, &mut number);
            definitions.push((symbol, new));
            image.insert(n, arena.intern(Node::Symbol(symbol)));
        }
        let rest = es.iter().map(|e| image[e]).collect();
        drop(arena);
        (definitions, rest)
    }
}

impl Arena {
    /// The symbol `prefix` with the next number whose name is not taken.
    fn fresh_symbol(&mut self, prefix: &str, number: &mut usize) -> Symbol {
        loop {
            *number += 1;
            let name = format!("{prefix}{number}");
            if self.find_symbol(&name).is_none() {
                return self.symbol(&name);
            }
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
                node => stack.extend(node.children()),
            }
            if count > LONG_LEAVES {
                break;
            }
        }
        count
    }
}
