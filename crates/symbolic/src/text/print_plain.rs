//! Expressions as text that parses back.

use crate::store::arena::{Arena, Node};
use crate::store::number::{Number, Rational};
use crate::text::print::Binds::{Atom, Power, Product, Sum};
use crate::text::print::{Factor, Piece, Printed, signed, text, write};
use crate::{Expr, Graph};

impl Graph {
    /// `e` as text that [`Graph::parse`] reads back, if numbers are finite and names can be parsed.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let x = g.variable(g.symbol("x'"));
    /// assert_eq!(g.plain(g.div(g.powi(x, 2), g.integer(2))), "x'^2/2");
    /// ```
    pub fn plain(&self, e: Expr) -> String {
        let arena = self.arena.borrow();
        write(e, ("(", ")"), |e, negated| arena.plain_pieces(e, negated))
    }
}

impl Arena {
    fn plain_pieces(&self, e: Expr, negated: bool) -> Printed {
        match self.node(e) {
            Node::Number(_) | Node::Product(_) | Node::Sum(..) => {
                signed(&self.printed_terms(e, negated), |t| self.plain_term(t.number, &t.factors))
            }
            Node::Symbol(s) => (vec![text(self.name(*s))], Atom),
            Node::Power(base, exponent) => {
                let (base, exponent) = (Piece::Node(*base, Atom), Piece::Node(*exponent, Atom));
                (vec![base, text("^"), exponent], Power)
            }
            Node::Call(function, argument) => {
                let argument = match negated {
                    true => Piece::Negated(*argument, Sum),
                    false => Piece::Node(*argument, Sum),
                };
                (vec![text(function.name()), text("("), argument, text(")")], Atom)
            }
            Node::Atan2(y, x) => {
                let (y, x) = (Piece::Node(*y, Sum), Piece::Node(*x, Sum));
                (vec![text("atan2("), y, text(", "), x, text(")")], Atom)
            }
        }
    }

    /// number · factors for number ≥ 0, as numerators over denominators
    fn plain_term(&self, number: Number, factors: &[Factor]) -> Printed {
        let (numerator, denominator) = number_text(number);
        let mut above: Vec<Printed> = Vec::new();
        let mut below: Vec<Printed> = denominator.map(|d| (vec![text(d)], Atom)).into_iter().collect();
        for factor in factors {
            if factor.exponent.is_negative() {
                below.push(plain_factor(Factor { exponent: factor.exponent.neg(), ..*factor }));
            } else {
                above.push(plain_factor(*factor));
            }
        }
        if above.is_empty() || numerator != "1" {
            let binds = if numerator.contains('*') { Product } else { Atom };
            above.insert(0, (vec![text(numerator)], binds));
        }
        let binds = if above.len() == 1 && below.is_empty() { above[0].1 } else { Product };
        let mut pieces = joined(above);
        if below.len() > 1 && !self.scales_exactly(factors, number) {
            // 1/d/(sum), where d*(sum) would not give back d and the sum
            pieces.push(text("/"));
            pieces.extend(below.remove(0).0);
        }
        let several = below.len() > 1;
        if !below.is_empty() {
            pieces.push(text(if several { "/(" } else { "/" }));
            pieces.extend(joined(below));
        }
        if several {
            pieces.push(text(")"));
        }
        (pieces, binds)
    }

    /// Do the sums among the denominators survive being multiplied by the denominator of `number`?
    fn scales_exactly(&self, factors: &[Factor], number: Number) -> bool {
        let Number::Exact(r) = number else {
            return true;
        };
        if r.denominator() == 1 {
            return true;
        }
        factors
            .iter()
            .filter(|factor| factor.exponent.is_negative())
            .all(|factor| self.keeps_content(factor.base, r.denominator()))
    }
}

fn joined(factors: Vec<Printed>) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (i, (factor, _)) in factors.into_iter().enumerate() {
        if i > 0 {
            pieces.push(text("*"));
        }
        pieces.extend(factor);
    }
    pieces
}

/// base^exponent for a positive exponent, ready to stand in a product
fn plain_factor(factor: Factor) -> Printed {
    match (factor.exponent.numerator(), factor.exponent.denominator()) {
        (1, 1) => (vec![factor.piece(Power)], Power),
        (1, 2) => (vec![text("sqrt("), factor.piece(Sum), text(")")], Atom),
        (n, 1) => (vec![factor.piece(Atom), text(format!("^{n}"))], Power),
        (n, d) => (vec![factor.piece(Atom), text(format!("^({n}/{d})"))], Power),
    }
}

/// A number ≥ 0 as numerator and, if it is best shown as a fraction, denominator.
pub(crate) fn number_text(n: Number) -> (String, Option<String>) {
    match n {
        Number::Exact(r) if r.denominator() == 1 => (r.numerator().to_string(), None),
        Number::Exact(r) => {
            if let Some((numerator, denominator)) = multiple_of_pi(r) {
                let above = if numerator == 1 { "pi".into() } else { format!("{numerator}*pi") };
                return (above, (denominator != 1).then(|| denominator.to_string()));
            }
            let decimal = float_text(r.to_f64());
            if r.denominator() % 5 == 0 && Number::from_decimal(&decimal) == Some(n) {
                (decimal, None)
            } else {
                (r.numerator().to_string(), Some(r.denominator().to_string()))
            }
        }
        Number::Scaled(..) => {
            let decimal = format!("{:e}", n.to_f64());
            let whole = n.fraction().map_or(String::new(), |x| x.to_string());
            match whole.split_once('/') {
                _ if Number::from_decimal(&decimal) == Some(n) => (decimal, None),
                Some((above, below)) => (above.into(), Some(below.into())),
                None => (whole, None),
            }
        }
        // never read back as an exact number
        Number::Float(x) if x.is_finite() && Number::from_decimal(&float_text(x)) != Some(n) => {
            (format!("{x}e-0"), None)
        }
        Number::Float(x) => (float_text(x), None),
    }
}

/// `k` and `d` where the number is `k π/d`.
fn multiple_of_pi(r: Rational) -> Option<(i64, i64)> {
    let Number::Exact(pi) = Number::PI else { return None };
    let quotient = r.mul(pi.recip()?)?;
    let is_multiple = r.numerator() % pi.numerator() == 0 && r.denominator() % pi.denominator() == 0;
    is_multiple.then_some((quotient.numerator(), quotient.denominator()))
}

/// The shortest decimal that converts back to x
fn float_text(x: f64) -> String {
    if x.is_finite() && (x.abs() >= 1e16 || x.abs() < 1e-4) { format!("{x:e}") } else { format!("{x}") }
}
