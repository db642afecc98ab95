//! Formulas as text to expressions.

use crate::limits::NOTHING;
use crate::text::lexer::{Fault, Spanned, Token, token_at};
use crate::text::value::{Scope, Value};
use crate::{Expr, Graph, ParseError, ParseErrorKind};

/// Nested parentheses, calls and powers that are accepted.
const DEPTH_LIMIT: usize = 200;

impl Graph {
    /// Reads a formula: `+ - * / ^` (`**` is `^`) with the usual precedence, so that −2² = −4 and
    /// 2^3^2 = 512; parentheses; names with primes; the functions of [`Function`](crate::Function), `sqrt`,
    /// `ln`, `sec`, `csc`, `cot`, `atan2(y, x)`, `pow(a, b)`, `step(t, a, b, width)`; the constant `pi`; and
    /// what [`Graph::parse_value`] reads, as far as a number comes of it.
    ///
    /// # Errors
    /// A [`ParseError`] with the place and, where there is one, a hint.
    ///
    /// ```
    /// let g = symbolic::Graph::new();
    /// let nothing = |_: &str| None;
    /// assert_eq!(g.parse("-2^2 + 1e-3*2", &nothing), Ok(g.number(-3.998)));
    /// ```
    pub fn parse(&self, text: &str, scope: &dyn Scope) -> Result<Expr, ParseError> {
        let value = self.parse_value(text, scope)?;
        let kind = ParseErrorKind::NotANumber { found: value.shape() };
        let whole = || ParseError { kind, text: text.into(), offset: 0, length: text.len(), also: Box::default() };
        value.scalar().ok_or_else(whole)
    }

    /// Reads a formula for a number, a vector or a matrix. Besides what [`Graph::parse`] says:
    /// `[a, b, c]` is a vector, of vectors a matrix with these rows; `+ - *` as usual, `*` of two vectors
    /// refused; `r.x`, `I.xy` are components;
    /// `dot(a, b)`, `cross(a, b)`, `norm(a)`, `transpose(R)`, `diag(a, b, c)`;
    /// `rotation(zxz, ψ, θ, φ) = R_z(ψ) R_x(θ) R_z(φ)`, from the body's axes to those of space;
    /// `rotation(n, α)` about an axis; `angular_velocity(R)` in space and `body_angular_velocity(R)` in the
    /// body, of products of rotations; a prime after a name or bracket is the time derivative.
    ///
    /// # Errors
    /// A [`ParseError`] with the place and, where there is one, a hint.
    pub fn parse_value(&self, text: &str, scope: &dyn Scope) -> Result<Value, ParseError> {
        let start = Spanned { token: Token::End, start: 0, end: 0 };
        let mut parser = Parser { graph: self, text, scope, next: start, last: 0, depth: 0, faults: Vec::new() };
        let outcome = parser.formula();
        let mut faults = std::mem::take(&mut parser.faults);
        match outcome {
            Ok(value) if faults.is_empty() => return Ok(value),
            // what follows from a name that means nothing is no fault of its own
            Err(fault) if faults.is_empty() || fault.kind.is_of_grammar() => faults.push(fault),
            _ => {}
        }
        let told: Vec<ParseErrorKind> = faults.iter().map(|fault| fault.kind.clone()).collect();
        let mut place = 0..;
        faults.retain(|fault| place.next().is_some_and(|i| !told[..i].contains(&fault.kind)));
        let error = |Fault { kind, start, end }| ParseError {
            kind,
            text: text.into(),
            offset: start,
            length: end - start,
            also: Box::default(),
        };
        let mut errors = faults.into_iter().map(error);
        let first = errors.next().expect("there is a fault");
        Err(ParseError { also: errors.collect(), ..first })
    }
}

pub(crate) struct Parser<'a> {
    pub(crate) graph: &'a Graph,
    text: &'a str,
    pub(crate) scope: &'a dyn Scope,
    pub(crate) next: Spanned,
    /// Where the token before `next` ends.
    pub(crate) last: usize,
    depth: usize,
    /// Faults that leave the rest readable.
    pub(crate) faults: Vec<Fault>,
}

impl<'a> Parser<'a> {
    pub(crate) fn advance(&mut self) -> Result<(), Fault> {
        self.last = self.next.end;
        self.next = token_at(self.text, self.next.end)?;
        Ok(())
    }

    pub(crate) fn slice(&self, token: Spanned) -> &'a str {
        &self.text[token.start..token.end]
    }

    pub(crate) fn fault(&self, kind: ParseErrorKind, at: Spanned) -> Fault {
        Fault { kind, start: at.start, end: at.end }
    }

    pub(crate) fn unexpected(&self, expected: &'static str) -> Fault {
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

    pub(crate) fn finite(&self, value: Value, start: usize) -> Result<Value, Fault> {
        let infinite = |&e: &Expr| self.graph.as_number(e).is_some_and(|x| !x.is_finite());
        match value.entries().iter().any(infinite) {
            true => Err(Fault { kind: ParseErrorKind::NotFinite, start, end: self.last }),
            false => Ok(value),
        }
    }

    /// The number that stands from `start` to `end`.
    pub(crate) fn number(&self, value: &Value, start: usize, end: usize) -> Result<Expr, Fault> {
        let kind = || ParseErrorKind::NotANumber { found: value.shape() };
        value.scalar().ok_or_else(|| Fault { kind: kind(), start, end })
    }

    /// Something instead of what cannot be read, for what comes after it.
    pub(crate) fn unreadable(&mut self, fault: Fault) -> Value {
        self.faults.push(fault);
        Value::Scalar(self.graph.variable(self.graph.symbol("?")))
    }

    fn formula(&mut self) -> Result<Value, Fault> {
        self.advance()?;
        if self.next.token == Token::End {
            return Err(Fault { kind: ParseErrorKind::Empty, start: 0, end: self.text.len() });
        }
        let value = self.sum()?;
        match self.next.token {
            Token::End => Ok(value),
            _ => Err(self.unexpected("an operator or the end")),
        }
    }

    pub(crate) fn sum(&mut self) -> Result<Value, Fault> {
        let start = self.next.start;
        let mut terms = vec![self.product()?];
        loop {
            let minus = match self.next.token {
                Token::Plus => false,
                Token::Minus => true,
                _ => break,
            };
            let operator = self.next;
            self.advance()?;
            let term = self.product()?;
            let term = if minus { self.negative(&term) } else { term };
            match (self.graph.add_values(&terms[0], &term), &term) {
                (None, _) => return Err(self.mismatch("added", &terms[0], &term, operator)),
                (Some(_), Value::Scalar(_)) => terms.push(term),
                (Some(sum), _) => {
                    for ((&a, &b), &sum) in terms[0].entries().iter().zip(term.entries()).zip(sum.entries()) {
                        self.rounded(&[a, b], sum, start)?;
                    }
                    terms[0] = sum;
                }
            }
        }
        match terms.iter().map(Value::scalar).collect::<Option<Vec<Expr>>>() {
            Some(numbers) if numbers.len() > 1 => {
                let sum = self.graph.sum(&numbers);
                self.rounded(&numbers, sum, start)?;
                self.finite(Value::Scalar(sum), start)
            }
            _ => self.finite(terms.swap_remove(0), start),
        }
    }

    /// A fault where rounded numbers have cancelled: they may differ in digits that they have not got, and
    /// the sum would be taken for exact.
    fn rounded(&self, terms: &[Expr], sum: Expr, start: usize) -> Result<(), Fault> {
        let numbers: Option<Vec<f64>> = terms.iter().map(|&e| self.graph.as_number(e)).collect();
        let most = numbers.map_or(0.0, |numbers| numbers.iter().map(|x| x.abs()).sum());
        let stays = |x: f64| x.abs() > NOTHING * most;
        let holds = !self.graph.are_exact(&[sum]) && self.graph.as_number(sum).is_none_or(stays);
        match holds || self.graph.are_exact(terms) {
            true => Ok(()),
            false => Err(Fault { kind: ParseErrorKind::NotExact, start, end: self.last }),
        }
    }

    fn negative(&self, value: &Value) -> Value {
        value.with(value.entries().iter().map(|&e| self.graph.neg(e)).collect())
    }

    fn mismatch(&self, verb: &'static str, left: &Value, right: &Value, at: Spanned) -> Fault {
        self.fault(ParseErrorKind::Shapes { verb, left: left.shape(), right: right.shape() }, at)
    }

    fn product(&mut self) -> Result<Value, Fault> {
        let start = self.next.start;
        let first = self.signed()?;
        // numbers are multiplied together at the end, so that the order of the file does not matter
        let (mut other, mut numbers) = match first {
            Value::Scalar(e) => (None, vec![e]),
            value => (Some(value), Vec::new()),
        };
        loop {
            let divide = match self.next.token {
                Token::Times => false,
                Token::Divide => true,
                _ => break,
            };
            let operator = self.next;
            self.advance()?;
            let place = self.next.start;
            let factor = self.signed()?;
            if divide {
                let divisor = self.number(&factor, place, self.last)?;
                if self.graph.is_zero(divisor) {
                    let kind = ParseErrorKind::DivisionByZero;
                    return Err(Fault { kind, start: place, end: self.last });
                }
                numbers.push(self.graph.powi(divisor, -1));
                continue;
            }
            other = match (other, factor) {
                (before, Value::Scalar(e)) => {
                    numbers.push(e);
                    before
                }
                (None, factor) => Some(factor),
                (Some(before), factor) => match self.graph.multiply_values(&before, &factor) {
                    Some(product) => Some(product),
                    None => return Err(self.mismatch("multiplied", &before, &factor, operator)),
                },
            };
        }
        let number = match &numbers[..] {
            [] => None,
            [only] => Some(*only),
            several => Some(self.graph.product(several)),
        };
        let value = match (number, other) {
            (Some(number), None) => Value::Scalar(number),
            (Some(number), Some(other)) => self.graph.scale_value(number, &other),
            (None, Some(other)) => other,
            (None, None) => unreachable!("a product has a factor"),
        };
        self.finite(value, start)
    }

    /// Signs bind more loosely than powers: −x² = −(x²).
    fn signed(&mut self) -> Result<Value, Fault> {
        let mut negative = false;
        while matches!(self.next.token, Token::Plus | Token::Minus) {
            negative ^= self.next.token == Token::Minus;
            self.advance()?;
        }
        let value = self.power()?;
        Ok(if negative { self.negative(&value) } else { value })
    }

    /// Powers bind from the right, and their exponent may have a sign.
    fn power(&mut self) -> Result<Value, Fault> {
        let start = self.next.start;
        let base = self.primary()?;
        if self.next.token != Token::Power {
            return Ok(base);
        }
        let base = self.number(&base, start, self.last)?;
        let operator = self.next;
        self.advance()?;
        let place = self.next.start;
        let exponent = self.nested(operator, Self::signed)?;
        let exponent = self.number(&exponent, place, self.last)?;
        let negative = self.graph.as_number(exponent).is_some_and(|x| x < 0.0);
        if negative && self.graph.is_zero(base) {
            return Err(Fault { kind: ParseErrorKind::DivisionByZero, start, end: self.last });
        }
        self.finite(Value::Scalar(self.graph.power_as_written(base, exponent)), start)
    }

    pub(crate) fn nested<T>(
        &mut self,
        at: Spanned,
        read: impl FnOnce(&mut Self) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        if self.depth == DEPTH_LIMIT {
            return Err(self.fault(ParseErrorKind::TooDeep { limit: DEPTH_LIMIT }, at));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }
}

impl Graph {
    pub(crate) fn literal(&self, token: Spanned) -> Expr {
        match token.token {
            Token::Number(n) => self.arena.borrow_mut().number(n),
            _ => self.zero(),
        }
    }
}
