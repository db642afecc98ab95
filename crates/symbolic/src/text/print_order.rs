//! The order in which terms and factors are printed.

use crate::Expr;
use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use std::cmp::Ordering;

/// How deep two expressions are compared before their ids decide.
const DEPTH: u8 = 5;

impl Arena {
    pub(crate) fn sorted_terms(&self, terms: &[(Expr, Number)]) -> Vec<(Expr, Number)> {
        let mut terms = terms.to_vec();
        terms.sort_by(|(a, _), (b, _)| self.compare(*a, *b, DEPTH));
        terms
    }

    /// Symbols, then sums, then functions.
    pub(crate) fn sorted_factors(&self, factors: &[(Expr, Rational)]) -> Vec<(Expr, Rational)> {
        let mut factors = factors.to_vec();
        factors.sort_by(|a, b| self.compare_factors(*a, *b, DEPTH));
        factors
    }

    fn class(&self, e: Expr) -> u8 {
        match self.node(e) {
            Node::Number(_) => 0,
            Node::Symbol(_) => 1,
            Node::Product(_) => 2,
            Node::Sum(..) => 3,
            Node::Power(..) => 4,
            Node::Call(..) => 5,
            Node::Atan2(..) => 6,
        }
    }

    fn compare(&self, a: Expr, b: Expr, depth: u8) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        if depth == 0 {
            return a.cmp(&b);
        }
        let (of_a, of_b) = (self.as_factors(a), self.as_factors(b));
        for (x, y) in of_a.iter().zip(&of_b) {
            let order = self.compare_factors(*x, *y, depth - 1);
            if order != Ordering::Equal {
                return order;
            }
        }
        of_b.len().cmp(&of_a.len()).then(a.cmp(&b))
    }

    /// By class and id only: a full sort here would compare again at every depth.
    fn as_factors(&self, e: Expr) -> Vec<(Expr, Rational)> {
        let mut factors = self.factors_of(e);
        factors.sort_by_key(|(b, _)| (self.class(*b), *b));
        factors
    }

    fn compare_factors(&self, a: (Expr, Rational), b: (Expr, Rational), depth: u8) -> Ordering {
        if a.0 == b.0 {
            return b.1.cmp(&a.1);
        }
        self.class(a.0).cmp(&self.class(b.0)).then_with(|| match (self.node(a.0), self.node(b.0)) {
            (Node::Call(f, x), Node::Call(h, y)) if depth > 0 => {
                self.compare(*x, *y, depth - 1).then((*f as u8).cmp(&(*h as u8)))
            }
            _ => a.0.cmp(&b.0),
        })
    }
}
