//! Formulas as text to expressions.

use crate::lexer::{Fault, Spanned, Token, token_at};
use crate::suggest::{arity, callable, nearest, smooth_substitute};
use crate::{Expr, Function, Graph, ParseError, ParseErrorKind};

/// Nested parentheses, calls and powers that are accepted.
const DEPTH_LIMIT: usize = 200;

impl Graph {
    /// Reads a formula: `+ - * / ^` (`**` is `^`) with the usual precedence, so that −2² = −4 and
    /// 2^3^2 = 512; parentheses; names with primes; the functions of [`Function`], `sqrt`, `ln`,
    /// `sec`, `csc`, `cot`, `atan2(y, x)`, `pow(a, b)`; the constant `pi`.
    ///
    /// `scope` maps a name (with primes) to an expression, if defined; `known` are names to suggest instead.
    ///
    /// # Errors
    /// A [`ParseError`] with the place and, where there is one, a hint.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let nothing = |_: &str| None;
    /// assert_eq!(g.parse("-2^2 + 1e-3*2", &nothing, &[]), Ok(g.number(-3.998)));
    /// ```
    pub fn parse(
        &self,
        text: &str,
        scope: &dyn Fn(&str) -> Option<Expr>,
        known: &[String],
    ) -> Result<Expr, ParseError> {
        let start = Spanned { token: Token::End, start: 0, end: 0 };
        let mut parser = Parser { graph: self, text, scope, known, next: start, last: 0, depth: 0 };
        parser.formula().map_err(|fault| ParseError {
            kind: fault.kind,
            text: text.to_owned(),
            offset: fault.start,
            length: fault.end - fault.start,
        })
    }
}

struct Parser<'a> {
    graph: &'a Graph,
    text: &'a str,
    scope: &'a dyn Fn(&str) -> Option<Expr>,
    known: &'a [String],
    next: Spanned,
    /// Where the token before `next` ends.
    last: usize,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn advance(&mut self) -> Result<(), Fault> {
        self.last = self.next.end;
        self.next = token_at(self.text, self.next.end)?;
        Ok(())
    }

    fn slice(&self, token: Spanned) -> &'a str {
        &self.text[token.start..token.end]
    }

    fn fault(&self, kind: ParseErrorKind, at: Spanned) -> Fault {
        Fault { kind, start: at.start, end: at.end }
    }

    fn unexpected(&self, expected: &'static str) -> Fault {
        let kind = match self.next.token {
            Token::End => ParseErrorKind::UnexpectedEnd { expected },
            Token::Close if self.depth == 0 => ParseErrorKind::UnmatchedParenthesis,
            _ => {
                let found = self.slice(self.next).to_owned();
                ParseErrorKind::UnexpectedToken { found, expected }
            }
        };
        self.fault(kind, self.next)
    }

    fn finite(&self, e: Expr, start: usize) -> Result<Expr, Fault> {
        match self.graph.as_number(e) {
            Some(x) if !x.is_finite() => Err(Fault { kind: ParseErrorKind::NotFinite, start, end: self.last }),
            _ => Ok(e),
        }
    }

    fn formula(&mut self) -> Result<Expr, Fault> {
        self.advance()?;
        if self.next.token == Token::End {
            return Err(Fault { kind: ParseErrorKind::Empty, start: 0, end: self.text.len() });
        }
        let e = self.sum()?;
        match self.next.token {
            Token::End => Ok(e),
            _ => Err(self.unexpected("an operator or the end")),
        }
    }

    fn sum(&mut self) -> Result<Expr, Fault> {
        let start = self.next.start;
        let mut terms = vec![self.product()?];
        loop {
            let minus = match self.next.token {
                Token::Plus => false,
                Token::Minus => true,
                _ => break,
            };
            self.advance()?;
            let term = self.product()?;
            terms.push(if minus { self.graph.neg(term) } else { term });
        }
        if let [only] = terms[..] {
            return Ok(only);
        }
        self.finite(self.graph.sum(&terms), start)
    }

    fn product(&mut self) -> Result<Expr, Fault> {
        let start = self.next.start;
        let mut factors = vec![self.signed()?];
        loop {
            let divide = match self.next.token {
                Token::Times => false,
                Token::Divide => true,
                _ => break,
            };
            self.advance()?;
            let place = self.next.start;
            let factor = self.signed()?;
            if divide && self.graph.is_zero(factor) {
                let kind = ParseErrorKind::DivisionByZero;
                return Err(Fault { kind, start: place, end: self.last });
            }
            factors.push(if divide { self.graph.powi(factor, -1) } else { factor });
        }
        if let [only] = factors[..] {
            return Ok(only);
        }
        self.finite(self.graph.product(&factors), start)
    }

    /// Signs bind more loosely than powers: −x² = −(x²).
    fn signed(&mut self) -> Result<Expr, Fault> {
        let mut negative = false;
        while matches!(self.next.token, Token::Plus | Token::Minus) {
            negative ^= self.next.token == Token::Minus;
            self.advance()?;
        }
        let e = self.power()?;
        Ok(if negative { self.graph.neg(e) } else { e })
    }

    /// Powers bind from the right, and their exponent may have a sign.
    fn power(&mut self) -> Result<Expr, Fault> {
        let start = self.next.start;
        let base = self.primary()?;
        if self.next.token != Token::Power {
            return Ok(base);
        }
        let operator = self.next;
        self.advance()?;
        let exponent = self.nested(operator, Self::signed)?;
        let negative = self.graph.as_number(exponent).is_some_and(|x| x < 0.0);
        if negative && self.graph.is_zero(base) {
            return Err(Fault { kind: ParseErrorKind::DivisionByZero, start, end: self.last });
        }
        self.finite(self.graph.pow(base, exponent), start)
    }

    fn nested<T>(&mut self, at: Spanned, read: impl FnOnce(&mut Self) -> Result<T, Fault>) -> Result<T, Fault> {
        if self.depth == DEPTH_LIMIT {
            return Err(self.fault(ParseErrorKind::TooDeep { limit: DEPTH_LIMIT }, at));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    fn primary(&mut self) -> Result<Expr, Fault> {
        let token = self.next;
        let e = match token.token {
            Token::Number(_) => {
                self.advance()?;
                self.graph.literal(token)
            }
            Token::Name => {
                self.advance()?;
                if self.next.token == Token::Open { self.call(token)? } else { self.variable(token)? }
            }
            Token::Open => {
                self.advance()?;
                let e = self.nested(token, Self::sum)?;
                self.close(token)?;
                e
            }
            _ => return Err(self.unexpected("a number, a name or `(`")),
        };
        if matches!(self.next.token, Token::Number(_) | Token::Name | Token::Open) {
            let left = self.slice(Spanned { end: self.last, ..token });
            let left = if left.len() <= 20 { left } else { "…" }.to_owned();
            let right = match self.next.token {
                Token::Open => "(…)".to_owned(),
                _ => self.slice(self.next).to_owned(),
            };
            let kind = ParseErrorKind::ImplicitMultiplication { left, right };
            return Err(self.fault(kind, self.next));
        }
        Ok(e)
    }

    fn close(&mut self, open: Spanned) -> Result<(), Fault> {
        match self.next.token {
            Token::Close => self.advance(),
            Token::End => Err(self.fault(ParseErrorKind::UnclosedParenthesis, open)),
            _ => Err(self.unexpected("`)` or an operator")),
        }
    }

    fn variable(&self, token: Spanned) -> Result<Expr, Fault> {
        let name = self.slice(token);
        if let Some(e) = (self.scope)(name) {
            return Ok(e);
        }
        let kind = if name == "pi" {
            return Ok(self.graph.number(std::f64::consts::PI));
        } else if arity(name).is_some() {
            ParseErrorKind::FunctionWithoutArgument { name: name.to_owned() }
        } else {
            let known = self.known.iter().map(String::as_str).chain(["pi"]);
            ParseErrorKind::Undefined {
                name: name.to_owned(),
                suggestion: nearest(name, known).or_else(|| nearest(name, callable())),
            }
        };
        Err(self.fault(kind, token))
    }

    fn call(&mut self, token: Spanned) -> Result<Expr, Fault> {
        let name = self.slice(token);
        let open = self.next;
        let Some(expected) = arity(name) else {
            let kind = if let Some(instead) = smooth_substitute(name) {
                ParseErrorKind::NotSmooth { name: name.to_owned(), instead }
            } else if (self.scope)(name).is_some() || name == "pi" {
                ParseErrorKind::VariableCalled { name: name.to_owned() }
            } else {
                let suggestion = nearest(name, callable());
                ParseErrorKind::UnknownFunction { name: name.to_owned(), suggestion }
            };
            return Err(self.fault(kind, token));
        };
        self.advance()?;
        let arguments = self.nested(open, Self::arguments)?;
        self.close(open)?;
        if arguments.len() != expected {
            let found = arguments.len();
            let function = name.to_owned();
            let kind = ParseErrorKind::WrongArgumentCount { function, expected, found };
            return Err(Fault { kind, start: token.start, end: self.last });
        }
        let e = self.graph.apply(name, &arguments);
        let divides = matches!(name, "sec" | "csc" | "cot" | "pow");
        match self.graph.as_number(e) {
            Some(x) if divides && x.is_infinite() => {
                let kind = ParseErrorKind::DivisionByZero;
                Err(Fault { kind, start: token.start, end: self.last })
            }
            _ => self.finite(e, token.start),
        }
    }

    fn arguments(&mut self) -> Result<Vec<Expr>, Fault> {
        let mut arguments = Vec::new();
        if self.next.token == Token::Close {
            return Ok(arguments);
        }
        loop {
            arguments.push(self.sum()?);
            if self.next.token != Token::Comma {
                return Ok(arguments);
            }
            self.advance()?;
        }
    }
}

impl Graph {
    fn literal(&self, token: Spanned) -> Expr {
        match token.token {
            Token::Number(n) => self.arena.borrow_mut().number(n),
            _ => self.zero(),
        }
    }

    /// One of the [`callable`] functions with as many arguments as it takes.
    fn apply(&self, name: &str, arguments: &[Expr]) -> Expr {
        let x = arguments[0];
        match name {
            "sqrt" => self.sqrt(x),
            "ln" => self.call(Function::Log, x),
            "sec" => self.powi(self.call(Function::Cos, x), -1),
            "csc" => self.powi(self.call(Function::Sin, x), -1),
            "cot" => self.div(self.call(Function::Cos, x), self.call(Function::Sin, x)),
            "atan2" => self.atan2(x, arguments[1]),
            "pow" => self.pow(x, arguments[1]),
            _ => match Function::ALL.iter().find(|f| f.name() == name) {
                Some(f) => self.call(*f, x),
                None => unreachable!("`{name}` is among the functions"),
            },
        }
    }
}
