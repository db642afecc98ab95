//! Expressions as LaTeX.

use crate::store::arena::{Arena, Node};
use crate::store::number::Number;
use crate::text::latex_names::latex_name;
use crate::text::print::Binds::{self, Atom, Power, Product, Sum};
use crate::text::print::{Factor, Piece, Printed, signed, text, write};
use crate::text::print_plain::number_text;
use crate::{Expr, Function, Graph, Symbol};

impl Graph {
    /// `e` as LaTeX: primes as dots, Greek names as Greek letters, quotients as fractions.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let speed = g.variable(g.symbol("phi1'"));
    /// assert_eq!(g.latex(g.div(g.powi(speed, 2), g.integer(2))), r"\frac{1}{2} \dot{\varphi}_{1}^{2}");
    /// ```
    pub fn latex(&self, e: Expr) -> String {
        let arena = self.arena.borrow();
        write(e, (r"\left(", r"\right)"), |e, negated| arena.latex_pieces(e, negated))
    }

    /// The name of a symbol as LaTeX.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// assert_eq!(g.latex_symbol(g.symbol("theta''")), r"\ddot{\theta}");
    /// ```
    pub fn latex_symbol(&self, symbol: Symbol) -> String {
        latex_name(self.arena.borrow().name(symbol))
    }
}

impl Arena {
    fn latex_pieces(&self, e: Expr, negated: bool) -> Printed {
        match self.node(e) {
            Node::Number(_) | Node::Product(_) | Node::Sum(..) => {
                signed(&self.printed_terms(e, negated), |t| self.latex_term(t.number, t.factors.clone()))
            }
            Node::Symbol(s) => (vec![text(latex_name(self.name(*s)))], Atom),
            Node::Power(base, exponent) => {
                let base = Piece::Node(*base, Atom);
                (vec![base, text("^{"), Piece::Node(*exponent, Sum), text("}")], Power)
            }
            Node::Call(Function::Exp, argument) => {
                (vec![text(r"\mathrm{e}^{"), Piece::Node(*argument, Sum), text("}")], Power)
            }
            Node::Call(function, argument) => (self.latex_call(*function, *argument, negated, ""), Power),
            Node::Atan2(y, x) => {
                let (y, x) = (Piece::Node(*y, Sum), Piece::Node(*x, Sum));
                let open = text(r"\operatorname{atan2}\left(");
                (vec![open, y, text(", "), x, text(r"\right)")], Atom)
            }
        }
    }

    fn latex_call(&self, function: Function, argument: Expr, negated: bool, exponent: &str) -> Vec<Piece> {
        let name = format!("{}{exponent}", NAMES[function as usize]);
        let inner = if negated { Piece::Negated(argument, Sum) } else { Piece::Node(argument, Sum) };
        match self.node(argument) {
            Node::Symbol(_) => vec![text(name + " "), inner],
            _ => vec![text(name + r"\left("), inner, text(r"\right)")],
        }
    }

    /// number · factors for number ≥ 0, as a fraction if there are denominators
    fn latex_term(&self, number: Number, factors: Vec<Factor>) -> Printed {
        let (mut below, above): (Vec<_>, Vec<_>) =
            factors.into_iter().partition(|factor| factor.exponent.is_negative());
        for factor in &mut below {
            factor.exponent = factor.exponent.neg();
        }
        let (numerator, denominator) = latex_number(number);
        if above.is_empty() && below.is_empty() {
            return match denominator {
                None => (vec![text(numerator)], Atom),
                Some(d) => (vec![text(fraction(&numerator, &d))], Product),
            };
        }
        if below.is_empty() {
            return match denominator {
                Some(d) => (self.latex_product(&fraction(&numerator, &d), &above), Product),
                None if numerator != "1" => (self.latex_product(&numerator, &above), Product),
                None => match above[..] {
                    [factor] => self.latex_factor(factor, Sum),
                    _ => (self.latex_product("", &above), Product),
                },
            };
        }
        let front = if numerator == "1" && !above.is_empty() { String::new() } else { numerator };
        let mut pieces = vec![text(r"\frac{")];
        pieces.extend(self.latex_product(&front, &above));
        pieces.push(text("}{"));
        pieces.extend(self.latex_product(denominator.as_deref().unwrap_or(""), &below));
        pieces.push(text("}"));
        (pieces, Product)
    }

    /// A number (or nothing) and factors side by side
    fn latex_product(&self, front: &str, factors: &[Factor]) -> Vec<Piece> {
        let mut pieces = vec![text(front)];
        let alone = front.is_empty() && factors.len() == 1;
        for (i, factor) in factors.iter().enumerate() {
            let digits = self.starts_with_digit(*factor) && (i > 0 || front.ends_with(|c: char| c.is_ascii_digit()));
            if i > 0 || !front.is_empty() {
                pieces.push(text(if digits { r" \cdot " } else { " " }));
            }
            pieces.extend(self.latex_factor(*factor, if alone { Sum } else { Power }).0);
        }
        pieces
    }

    fn starts_with_digit(&self, factor: Factor) -> bool {
        let first = match self.node(factor.base) {
            Node::Power(base, _) => *base,
            _ => factor.base,
        };
        let root = factor.exponent.denominator() == 2 && factor.exponent.numerator() == 1;
        matches!(self.node(first), Node::Number(_)) && !root
    }

    /// base^exponent for a positive exponent, where what binds as tightly as `level` can stand
    fn latex_factor(&self, factor: Factor, level: Binds) -> Printed {
        match (factor.exponent.numerator(), factor.exponent.denominator()) {
            (1, 1) => (vec![factor.piece(level)], Power),
            (1, 2) => (vec![text(r"\sqrt{"), factor.piece(Sum), text("}")], Atom),
            (n, 1) => match self.node(factor.base) {
                Node::Call(function, argument) if raised_at_name(*function) => {
                    let exponent = format!("^{{{n}}}");
                    (self.latex_call(*function, *argument, factor.negated, &exponent), Power)
                }
                _ => (vec![factor.piece(Atom), text(format!("^{{{n}}}"))], Power),
            },
            (n, d) => (vec![factor.piece(Atom), text(format!("^{{{n}/{d}}}"))], Power),
        }
    }
}

fn fraction(numerator: &str, denominator: &str) -> String {
    format!(r"\frac{{{numerator}}}{{{denominator}}}")
}

/// Powers of ten as such: 1.5e-7 is 1.5 · 10⁻⁷.
fn latex_number(n: Number) -> (String, Option<String>) {
    let (numerator, denominator) = number_text(n);
    if let Some(factor) = numerator.strip_suffix("pi") {
        return (format!(r"{}\pi", factor.replace('*', " ")), denominator);
    }
    match numerator.split_once('e') {
        Some(("1", exponent)) => (format!("10^{{{exponent}}}"), denominator),
        Some((mantissa, exponent)) => (format!(r"{mantissa} \cdot 10^{{{exponent}}}"), denominator),
        None if numerator == "inf" => (r"\infty".to_owned(), None),
        None if numerator == "NaN" => (r"\text{undefined}".to_owned(), None),
        None => (numerator, denominator),
    }
}

/// sin²x, but not arcsin²x, which some read as an inverse.
fn raised_at_name(function: Function) -> bool {
    use Function::{Cos, Cosh, Sin, Sinh, Tan, Tanh};
    matches!(function, Sin | Cos | Tan | Sinh | Cosh | Tanh)
}

/// Names of the functions, in the order of [`Function::ALL`].
const NAMES: [&str; 14] = [
    r"\sin",
    r"\cos",
    r"\tan",
    r"\sinh",
    r"\cosh",
    r"\tanh",
    r"\arcsin",
    r"\arccos",
    r"\arctan",
    r"\operatorname{arsinh}",
    r"\operatorname{arcosh}",
    r"\operatorname{artanh}",
    r"\exp",
    r"\ln",
];
