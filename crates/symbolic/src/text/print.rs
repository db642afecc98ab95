//! Common part of the printers of plain text and LaTeX: output without recursion, order and signs of terms.

use crate::Expr;
use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};

/// How tightly what is printed binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub(crate) enum Binds {
    Sum,
    Product,
    Power,
    Atom,
}

/// A piece of output that is still to be written.
pub(crate) enum Piece {
    Text(String),
    /// The expression, in parentheses if it binds more loosely than the level.
    Node(Expr, Binds),
    /// The negative of a sum, in the same way.
    Negated(Expr, Binds),
}

/// The pieces of something, and how tightly it binds.
pub(crate) type Printed = (Vec<Piece>, Binds);

pub(crate) fn text(s: impl Into<String>) -> Piece {
    Piece::Text(s.into())
}

/// Writes `e`, given how a node (to be negated or not) falls into pieces.
pub(crate) fn write(e: Expr, parentheses: (&str, &str), pieces: impl Fn(Expr, bool) -> Printed) -> String {
    let mut output = String::new();
    let mut stack = vec![Piece::Node(e, Binds::Sum)];
    while let Some(piece) = stack.pop() {
        let (e, level, negated) = match piece {
            Piece::Text(s) => {
                output.push_str(&s);
                continue;
            }
            Piece::Node(e, level) => (e, level, false),
            Piece::Negated(e, level) => (e, level, true),
        };
        let (pieces, binds) = pieces(e, negated);
        if binds < level {
            output.push_str(parentheses.0);
            stack.push(text(parentheses.1));
        }
        stack.extend(pieces.into_iter().rev());
    }
    output
}

/// A factor base^exponent of a term; `negated` if base −base or f(−u) = −f(u) is to be printed.
#[derive(Clone, Copy)]
pub(crate) struct Factor {
    pub(crate) base: Expr,
    pub(crate) exponent: Rational,
    pub(crate) negated: bool,
}

impl Factor {
    /// The base where nothing, or `level`, needs no parentheses.
    pub(crate) fn piece(self, level: Binds) -> Piece {
        if self.negated { Piece::Negated(self.base, level) } else { Piece::Node(self.base, level) }
    }
}

/// A term as sign, number ≥ 0, and factors in order.
pub(crate) struct Term {
    pub(crate) negative: bool,
    pub(crate) number: Number,
    pub(crate) factors: Vec<Factor>,
}

impl Arena {
    /// What a sum (or any other node, as its only term) consists of, in the order of printing.
    pub(crate) fn printed_terms(&self, e: Expr, negated: bool) -> Vec<Term> {
        let signed = |c: Number| if negated { c.neg() } else { c };
        let Node::Sum(constant, terms) = self.node(e) else {
            return vec![self.term(signed(Number::ONE), e)];
        };
        let terms: Vec<_> = terms.iter().map(|(t, c)| (*t, signed(*c))).collect();
        let mut printed: Vec<Term> = self.terms_in_order(&terms);
        if !constant.is_zero() {
            let constant = signed(*constant);
            let negative = constant.is_negative();
            let last = Term { negative, number: constant.abs(), factors: Vec::new() };
            let first = printed.first().is_some_and(|t| t.negative) && !negative;
            printed.insert(if first { 0 } else { printed.len() }, last);
        }
        printed
    }

    /// Terms by symbols in order of their creation; a positive term first if there is one.
    fn terms_in_order(&self, terms: &[(Expr, Number)]) -> Vec<Term> {
        let ordered = self.sorted_terms(terms);
        let mut printed: Vec<Term> = ordered.into_iter().map(|(t, c)| self.term(c, t)).collect();
        if let Some(first) = printed.iter().position(|t| !t.negative) {
            printed[..=first].rotate_right(1);
        }
        printed
    }

    /// c·t. A minus goes into a difference (−(a − b) is printed as b − a) where there is one.
    fn term(&self, c: Number, t: Expr) -> Term {
        let factors = match self.node(t) {
            Node::Number(n) => {
                let number = c.mul(*n);
                let negative = number.is_negative();
                return Term { negative, number: number.abs(), factors: Vec::new() };
            }
            _ => self.sorted_factors(&self.factors_of(t)),
        };
        let mut factors: Vec<Factor> =
            factors.into_iter().map(|(base, exponent)| Factor { base, exponent, negated: false }).collect();
        let mut negative = c.is_negative();
        if negative && let Some(factor) = factors.iter_mut().find(|factor| self.takes_minus(factor)) {
            factor.negated = true;
            negative = false;
        }
        Term { negative, number: c.abs(), factors }
    }

    fn takes_minus(&self, factor: &Factor) -> bool {
        let odd = factor.exponent.as_integer().is_some_and(|n| n % 2 != 0);
        let sum = match self.node(factor.base) {
            Node::Call(function, argument) if function.parity() < 0 => *argument,
            _ => factor.base,
        };
        let Node::Sum(constant, terms) = self.node(sum) else {
            return false;
        };
        let negative = terms.iter().filter(|(_, c)| c.is_negative()).count() + usize::from(constant.is_negative());
        let count = terms.len() + usize::from(!constant.is_zero());
        odd && 2 * negative == count
    }
}

/// Terms with their signs between them, each printed by `term`.
pub(crate) fn signed(terms: &[Term], term: impl Fn(&Term) -> Printed) -> Printed {
    let mut pieces = Vec::new();
    let mut binds = Binds::Sum;
    for (i, t) in terms.iter().enumerate() {
        let sign = match (i, t.negative) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        pieces.push(text(sign));
        let (inner, inner_binds) = term(t);
        if terms.len() == 1 && sign.is_empty() {
            binds = inner_binds;
        }
        pieces.extend(inner);
    }
    (pieces, binds)
}
