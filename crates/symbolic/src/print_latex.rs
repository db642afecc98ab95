//! Expressions as LaTeX.

use crate::arena::{Arena, Node};
use crate::latex_names::latex_name;
use crate::number::{Number, Rational};
use crate::print_plain::number_text;
use crate::{Expr, Function, Graph, Symbol};

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
    /// `e` as LaTeX: primes as dots, Greek names as Greek letters, quotients as fractions.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let speed = g.variable(g.symbol("phi1'"));
    /// assert_eq!(g.latex(g.div(g.powi(speed, 2), g.integer(2))), r"\frac{1}{2} \dot{\varphi}_{1}^{2}");
    /// ```
    pub fn latex(&self, e: Expr) -> String {
        let arena = self.arena.borrow();
        let mut output = String::new();
        let mut stack = vec![Piece::Node(e, 0)];
        while let Some(piece) = stack.pop() {
            match piece {
                Piece::Text(s) => output.push_str(&s),
                Piece::Node(e, level) => {
                    let (pieces, binds) = arena.latex_pieces(e);
                    if binds < level {
                        output.push_str(r"\left(");
                        stack.push(text(r"\right)"));
                    }
                    stack.extend(pieces.into_iter().rev());
                }
            }
        }
        output
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
    fn latex_pieces(&self, e: Expr) -> (Vec<Piece>, u8) {
        match self.node(e) {
            Node::Number(n) => {
                let (pieces, binds) = self.latex_term(n.abs(), None);
                if n.is_negative() {
                    (prefixed("-", pieces), SUM)
                } else {
                    (pieces, binds)
                }
            }
            Node::Symbol(s) => (vec![text(latex_name(self.name(*s)))], ATOM),
            Node::Sum(constant, terms) => self.latex_sum(*constant, terms),
            Node::Product(_) => self.latex_term(Number::ONE, Some(e)),
            Node::Power(base, exponent) => {
                let base = Piece::Node(*base, ATOM);
                (
                    vec![base, text("^{"), Piece::Node(*exponent, 0), text("}")],
                    POWER,
                )
            }
            Node::Call(Function::Exp, argument) => (
                vec![text(r"\mathrm{e}^{"), Piece::Node(*argument, 0), text("}")],
                POWER,
            ),
            Node::Call(function, argument) => (self.latex_call(*function, *argument, ""), POWER),
            Node::Atan2(y, x) => {
                let (y, x) = (Piece::Node(*y, 0), Piece::Node(*x, 0));
                let open = text(r"\operatorname{atan2}\left(");
                (vec![open, y, text(", "), x, text(r"\right)")], ATOM)
            }
        }
    }

    fn latex_call(&self, function: Function, argument: Expr, exponent: &str) -> Vec<Piece> {
        let name = format!("{}{exponent}", function_name(function));
        match self.node(argument) {
            Node::Symbol(_) => vec![text(name + " "), Piece::Node(argument, 0)],
            _ => vec![
                text(name + r"\left("),
                Piece::Node(argument, 0),
                text(r"\right)"),
            ],
        }
    }

    fn latex_sum(&self, constant: Number, terms: &[(Expr, Number)]) -> (Vec<Piece>, u8) {
        let terms = self.terms_in_order(terms);
        if let [(t, c)] = terms[..]
            && constant.is_zero()
        {
            let (pieces, binds) = self.latex_term(c.abs(), Some(t));
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
            pieces.extend(self.latex_term(c.abs(), t).0);
        }
        (pieces, SUM)
    }

    /// c·t for c ≥ 0, as a fraction if t has denominators.
    fn latex_term(&self, c: Number, t: Option<Expr>) -> (Vec<Piece>, u8) {
        let factors = match t.map(|t| (t, self.node(t))) {
            None => Vec::new(),
            Some((_, Node::Product(factors))) => self.factors_in_order(factors),
            Some((t, _)) => vec![(t, Rational::ONE)],
        };
        let (mut below, mut above): (Vec<_>, Vec<_>) =
            factors.into_iter().partition(|(_, r)| r.is_negative());
        for (_, exponent) in &mut below {
            *exponent = exponent.neg();
        }
        let (numerator, denominator) = latex_number(c);
        if below.is_empty() {
            let mut front = match denominator {
                Some(d) => format!(r"\frac{{{numerator}}}{{{d}}}"),
                None if numerator == "1" && !above.is_empty() => String::new(),
                None => numerator,
            };
            if above.is_empty() {
                return (
                    vec![text(front)],
                    if c == Number::ONE || c.is_zero() {
                        ATOM
                    } else {
                        POWER
                    },
                );
            }
            if front.is_empty()
                && let [(base, exponent)] = above[..]
            {
                return self.latex_factor(base, exponent, true);
            }
            if !front.is_empty() {
                let number = matches!(self.node(above[0].0), Node::Number(_));
                let root = above[0].1 == Rational::new(1, 2).unwrap_or(Rational::ONE);
                front.push_str(if number && !root { r" \cdot " } else { " " });
            }
            let mut pieces = vec![text(front)];
            pieces.extend(self.latex_factors(&mut above, false));
            return (pieces, PRODUCT);
        }
        let mut pieces = vec![text(r"\frac{")];
        if numerator != "1" || above.is_empty() {
            pieces.push(text(if above.is_empty() {
                numerator
            } else {
                numerator + " "
            }));
            pieces.extend(self.latex_factors(&mut above, false));
        } else {
            pieces.extend(self.latex_factors(&mut above, true));
        }
        pieces.push(text("}{"));
        if let Some(d) = denominator {
            pieces.push(text(d + " "));
            pieces.extend(self.latex_factors(&mut below, false));
        } else {
            pieces.extend(self.latex_factors(&mut below, true));
        }
        pieces.push(text("}"));
        (pieces, PRODUCT)
    }

    fn latex_factors(&self, factors: &mut [(Expr, Rational)], alone: bool) -> Vec<Piece> {
        let alone = alone && factors.len() == 1;
        let mut pieces = Vec::new();
        for (i, (base, exponent)) in factors.iter().enumerate() {
            if i > 0 {
                pieces.push(text(" "));
            }
            let (factor, binds) = self.latex_factor(*base, *exponent, alone);
            let enclose = !alone && binds < POWER;
            if enclose {
                pieces.push(text(r"\left("));
            }
            pieces.extend(factor);
            if enclose {
                pieces.push(text(r"\right)"));
            }
        }
        pieces
    }

    /// base^exponent for a positive exponent; `alone` where nothing else stands beside it.
    fn latex_factor(&self, base: Expr, exponent: Rational, alone: bool) -> (Vec<Piece>, u8) {
        match (exponent.numerator(), exponent.denominator()) {
            (1, 1) => (
                vec![Piece::Node(base, if alone { 0 } else { POWER })],
                POWER,
            ),
            (1, 2) => (vec![text(r"\sqrt{"), Piece::Node(base, 0), text("}")], ATOM),
            (n, 1) => match self.node(base) {
                Node::Call(function, argument) if raised_at_name(*function) => (
                    self.latex_call(*function, *argument, &format!("^{{{n}}}")),
                    POWER,
                ),
                _ => (
                    vec![Piece::Node(base, ATOM), text(format!("^{{{n}}}"))],
                    POWER,
                ),
            },
            (n, d) => (
                vec![Piece::Node(base, ATOM), text(format!("^{{{n}/{d}}}"))],
                POWER,
            ),
        }
    }
}

fn prefixed(sign: &str, mut pieces: Vec<Piece>) -> Vec<Piece> {
    pieces.insert(0, text(sign));
    pieces
}

/// Powers of ten as such: 1.5e-7 is 1.5 · 10⁻⁷.
fn latex_number(n: Number) -> (String, Option<String>) {
    if n.to_f64() == std::f64::consts::PI {
        return (r"\pi".to_owned(), None);
    }
    let (numerator, denominator) = number_text(n);
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

fn function_name(function: Function) -> &'static str {
    match function {
        Function::Sin => r"\sin",
        Function::Cos => r"\cos",
        Function::Tan => r"\tan",
        Function::Sinh => r"\sinh",
        Function::Cosh => r"\cosh",
        Function::Tanh => r"\tanh",
        Function::Asin => r"\arcsin",
        Function::Acos => r"\arccos",
        Function::Atan => r"\arctan",
        Function::Asinh => r"\operatorname{arsinh}",
        Function::Acosh => r"\operatorname{arcosh}",
        Function::Atanh => r"\operatorname{artanh}",
        Function::Exp => r"\exp",
        Function::Log => r"\ln",
    }
}
