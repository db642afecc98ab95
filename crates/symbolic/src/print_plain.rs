//! Expressions as text that parses back.

use crate::arena::{Arena, Node};
use crate::number::{Number, Rational};
use crate::{Expr, Graph};

/// How tightly what is printed binds.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const POWER: u8 = 3;
const ATOM: u8 = 4;

/// A piece of output that is still to be written.
enum Piece {
    Text(String),
    /// The expression, in parentheses if it binds more loosely than the level.
    Node(Expr, u8),
}

fn text(s: impl Into<String>) -> Piece {
    Piece::Text(s.into())
}

impl Graph {
    /// `e` as text that [`Graph::parse`] reads back to the same node, if all its numbers are finite
    /// and its symbols have names that can be parsed.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x'"));
    /// assert_eq!(g.plain(g.div(g.powi(x, 2), g.integer(2))), "x'^2/2");
    /// ```
    pub fn plain(&self, e: Expr) -> String {
        let arena = self.arena.borrow();
        let mut output = String::new();
        let mut stack = vec![Piece::Node(e, 0)];
        while let Some(piece) = stack.pop() {
            match piece {
                Piece::Text(s) => output.push_str(&s),
                Piece::Node(e, level) => {
                    let (pieces, binds) = arena.plain_pieces(e);
                    let parentheses = binds < level;
                    if parentheses {
                        output.push('(');
                        stack.push(text(")"));
                    }
                    stack.extend(pieces.into_iter().rev());
                }
            }
        }
        output
    }
}

impl Arena {
    fn plain_pieces(&self, e: Expr) -> (Vec<Piece>, u8) {
        match self.node(e) {
            Node::Number(n) if n.is_negative() => {
                let (pieces, _) = self.plain_term(n.abs(), None);
                (prefixed("-", pieces), SUM)
            }
            Node::Number(n) => self.plain_term(*n, None),
            Node::Symbol(s) => (vec![text(self.name(*s))], ATOM),
            Node::Sum(constant, terms) => self.plain_sum(*constant, terms),
            Node::Product(_) => self.plain_term(Number::ONE, Some(e)),
            Node::Power(base, exponent) => {
                let pieces = vec![
                    Piece::Node(*base, ATOM),
                    text("^"),
                    Piece::Node(*exponent, ATOM),
                ];
                (pieces, POWER)
            }
            Node::Call(function, argument) => (
                vec![
                    text(function.name()),
                    text("("),
                    Piece::Node(*argument, 0),
                    text(")"),
                ],
                ATOM,
            ),
            Node::Atan2(y, x) => {
                let (y, x) = (Piece::Node(*y, 0), Piece::Node(*x, 0));
                (vec![text("atan2("), y, text(", "), x, text(")")], ATOM)
            }
        }
    }

    fn plain_sum(&self, constant: Number, terms: &[(Expr, Number)]) -> (Vec<Piece>, u8) {
        let terms = self.terms_in_order(terms);
        if let [(t, c)] = terms[..]
            && constant.is_zero()
        {
            let (pieces, binds) = self.plain_term(c.abs(), Some(t));
            return if c.is_negative() {
                (prefixed("-", pieces), SUM)
            } else {
                (pieces, binds)
            };
        }
        let mut all: Vec<(Number, Option<Expr>)> =
            terms.into_iter().map(|(t, c)| (c, Some(t))).collect();
        if !constant.is_zero() {
            let first =
                all.first().is_some_and(|(c, _)| c.is_negative()) && !constant.is_negative();
            all.insert(if first { 0 } else { all.len() }, (constant, None));
        }
        let mut pieces = Vec::new();
        for (i, (c, t)) in all.into_iter().enumerate() {
            pieces.push(text(match (i, c.is_negative()) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            }));
            pieces.extend(self.plain_term(c.abs(), t).0);
        }
        (pieces, SUM)
    }

    /// c·t for c ≥ 0, as numerators over denominators.
    fn plain_term(&self, c: Number, t: Option<Expr>) -> (Vec<Piece>, u8) {
        let factors = match t.map(|t| (t, self.node(t))) {
            None => Vec::new(),
            Some((_, Node::Product(factors))) => self.factors_in_order(factors),
            Some((t, _)) => vec![(t, Rational::ONE)],
        };
        let (numerator, denominator) = number_text(c);
        let mut above: Vec<(Vec<Piece>, u8)> = Vec::new();
        let mut below: Vec<(Vec<Piece>, u8)> = Vec::new();
        if let Some(d) = denominator {
            below.push((vec![text(d)], ATOM));
        }
        for (base, exponent) in factors {
            if exponent.is_negative() {
                below.push(plain_factor(base, exponent.neg()));
            } else {
                above.push(plain_factor(base, exponent));
            }
        }
        if above.is_empty() || numerator != "1" {
            above.insert(0, (vec![text(numerator)], ATOM));
        }
        let single = above.len() == 1 && below.is_empty();
        let binds = if single { above[0].1 } else { PRODUCT };
        let mut pieces = joined(above);
        match below.len() {
            0 => {}
            1 => {
                pieces.push(text("/"));
                pieces.extend(joined(below));
            }
            _ => {
                pieces.push(text("/("));
                pieces.extend(joined(below));
                pieces.push(text(")"));
            }
        }
        (pieces, binds)
    }
}

fn prefixed(sign: &str, mut pieces: Vec<Piece>) -> Vec<Piece> {
    pieces.insert(0, text(sign));
    pieces
}

fn joined(factors: Vec<(Vec<Piece>, u8)>) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (i, (factor, _)) in factors.into_iter().enumerate() {
        if i > 0 {
            pieces.push(text("*"));
        }
        pieces.extend(factor);
    }
    pieces
}

/// base^exponent for a positive exponent, ready to stand in a product.
fn plain_factor(base: Expr, exponent: Rational) -> (Vec<Piece>, u8) {
    match (exponent.numerator(), exponent.denominator()) {
        (1, 1) => (vec![Piece::Node(base, POWER)], POWER),
        (1, 2) => (vec![text("sqrt("), Piece::Node(base, 0), text(")")], ATOM),
        (n, 1) => (vec![Piece::Node(base, ATOM), text(format!("^{n}"))], POWER),
        (n, d) => (
            vec![Piece::Node(base, ATOM), text(format!("^({n}/{d})"))],
            POWER,
        ),
    }
}

/// A number ≥ 0 as numerator and, if it is best shown as a fraction, denominator.
pub(crate) fn number_text(n: Number) -> (String, Option<String>) {
    match n {
        Number::Exact(r) if r.denominator() == 1 => (r.numerator().to_string(), None),
        Number::Exact(r) => {
            let decimal = float_text(r.to_f64());
            if r.denominator() % 5 == 0 && Number::from_decimal(&decimal) == Some(n) {
                (decimal, None)
            } else {
                (r.numerator().to_string(), Some(r.denominator().to_string()))
            }
        }
        Number::Float(x) => (float_text(x), None),
    }
}

/// The shortest decimal that converts back to x.
fn float_text(x: f64) -> String {
    if x.is_finite() && (x.abs() >= 1e16 || x.abs() < 1e-4) {
        format!("{x:e}")
    } else {
        format!("{x}")
    }
}
