//! Operands of sums and products: numbers, names, calls and brackets, their components and rates.

use crate::text::lexer::{Fault, Spanned, Token};
use crate::text::parse::Parser;
use crate::text::suggest::{arity, callable, nearest, smooth_substitute};
use crate::{ParseErrorKind, Value};

/// An argument of a function, or an entry of a list, and where it stands.
pub(crate) struct Argument {
    pub(crate) value: Value,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl Parser<'_> {
    pub(crate) fn primary(&mut self) -> Result<Value, Fault> {
        let token = self.next;
        let mut value = match token.token {
            Token::Number(_) => {
                self.advance()?;
                Value::Scalar(self.graph.literal(token))
            }
            Token::Name => {
                self.advance()?;
                if self.next.token == Token::Open { self.call(token)? } else { self.variable(token)? }
            }
            Token::Open => {
                self.advance()?;
                let value = self.nested(token, Self::sum)?;
                self.close(token)?;
                value
            }
            Token::OpenList => self.list(token)?,
            _ => return Err(self.unexpected("a number, a name or `(`")),
        };
        loop {
            match self.next.token {
                Token::Component => {
                    let name = &self.slice(self.next)[1..];
                    let Some(entry) = value.component(name) else {
                        let kind = ParseErrorKind::NoComponent { name: name.to_owned(), shape: value.shape() };
                        return Err(self.fault(kind, self.next));
                    };
                    value = Value::Scalar(entry);
                }
                Token::Prime => {
                    let rates = value.entries().iter().map(|&e| self.scope.rate(e)).collect::<Option<Vec<_>>>();
                    value = value.with(rates.ok_or_else(|| self.fault(ParseErrorKind::NoRate, self.next))?);
                }
                _ => break,
            }
            self.advance()?;
        }
        if self.next.token == Token::OpenList && value.scalar().is_none() {
            let kind = ParseErrorKind::NoComponent { name: "[…]".to_owned(), shape: value.shape() };
            return Err(self.fault(kind, self.next));
        }
        if matches!(self.next.token, Token::Number(_) | Token::Name | Token::Open | Token::OpenList) {
            let left = self.slice(Spanned { end: self.last, ..token });
            let left = if left.len() <= 20 { left } else { "…" }.to_owned();
            let right = match self.next.token {
                Token::Open => "(…)".to_owned(),
                Token::OpenList => "[…]".to_owned(),
                _ => self.slice(self.next).to_owned(),
            };
            let kind = ParseErrorKind::ImplicitMultiplication { left, right };
            return Err(self.fault(kind, self.next));
        }
        Ok(value)
    }

    fn list(&mut self, open: Spanned) -> Result<Value, Fault> {
        self.advance()?;
        let items = self.nested(open, |parser| parser.arguments(Token::CloseList))?;
        match self.next.token {
            Token::CloseList => self.advance()?,
            Token::End => return Err(self.fault(ParseErrorKind::UnclosedParenthesis, open)),
            _ => return Err(self.unexpected("`]`, `,` or an operator")),
        }
        let values = items.into_iter().map(|item| item.value).collect();
        let fault = || Fault { kind: ParseErrorKind::NoList, start: open.start, end: self.last };
        Value::list(values).ok_or_else(fault)
    }

    fn close(&mut self, open: Spanned) -> Result<(), Fault> {
        match self.next.token {
            Token::Close => self.advance(),
            Token::End => Err(self.fault(ParseErrorKind::UnclosedParenthesis, open)),
            _ => Err(self.unexpected("`)` or an operator")),
        }
    }

    fn variable(&mut self, token: Spanned) -> Result<Value, Fault> {
        let name = self.slice(token);
        if let Some(value) = self.scope.value(name) {
            return Ok(value);
        }
        let kind = if name == "pi" {
            return Ok(Value::Scalar(self.graph.pi()));
        } else if arity(name).is_some() {
            let kind = ParseErrorKind::FunctionWithoutArgument { name: name.to_owned() };
            return Err(self.fault(kind, token));
        } else {
            let known = self.scope.known().iter().map(String::as_str).chain(["pi"]);
            ParseErrorKind::Undefined {
                name: name.to_owned(),
                suggestion: nearest(name, known).or_else(|| nearest(name, callable())),
            }
        };
        let fault = self.fault(kind, token);
        Ok(self.unreadable(fault))
    }

    fn call(&mut self, token: Spanned) -> Result<Value, Fault> {
        let name = self.slice(token);
        let open = self.next;
        let Some(expected) = arity(name) else {
            let kind = if let Some(instead) = smooth_substitute(name) {
                ParseErrorKind::NotSmooth { name: name.to_owned(), instead }
            } else if self.scope.value(name).is_some() || name == "pi" {
                ParseErrorKind::VariableCalled { name: name.to_owned() }
            } else {
                let suggestion = nearest(name, callable());
                ParseErrorKind::UnknownFunction { name: name.to_owned(), suggestion }
            };
            let fault = self.fault(kind, token);
            self.advance()?;
            self.nested(open, |parser| parser.arguments(Token::Close))?;
            self.close(open)?;
            return Ok(self.unreadable(fault));
        };
        self.advance()?;
        let axes = if name == "rotation" { self.axes()? } else { None };
        let arguments = self.nested(open, |parser| parser.arguments(Token::Close))?;
        self.close(open)?;
        let found = arguments.len() + usize::from(axes.is_some());
        if !expected.contains(&found) {
            let (function, expected) = (name.to_owned(), *expected.start());
            let kind = ParseErrorKind::WrongArgumentCount { function, expected, found };
            let fault = Fault { kind, start: token.start, end: self.last };
            return Ok(self.unreadable(fault));
        }
        let value = self.apply(token, axes, &arguments)?;
        let divides = matches!(name, "sec" | "csc" | "cot" | "pow");
        match value.scalar().and_then(|e| self.graph.as_number(e)) {
            Some(x) if divides && x.is_infinite() => {
                let kind = ParseErrorKind::DivisionByZero;
                Err(Fault { kind, start: token.start, end: self.last })
            }
            _ => self.finite(value, token.start),
        }
    }

    /// The word of axes with which a rotation begins, unless its first argument is a vector.
    fn axes(&mut self) -> Result<Option<Spanned>, Fault> {
        let word = self.next;
        let name = self.slice(word);
        let is_word = matches!(word.token, Token::Name) && name.chars().all(|c| "xyz".contains(c));
        if word.token != Token::Word && (!is_word || matches!(self.scope.value(name), Some(Value::Vector(_)))) {
            return Ok(None);
        }
        self.advance()?;
        match self.next.token {
            Token::Comma => self.advance().map(|()| Some(word)),
            _ => Err(self.unexpected("`,` and an angle for each axis")),
        }
    }

    /// Arguments or entries up to `close`.
    fn arguments(&mut self, close: Token) -> Result<Vec<Argument>, Fault> {
        let mut arguments = Vec::new();
        if self.next.token == close {
            return Ok(arguments);
        }
        loop {
            let start = self.next.start;
            arguments.push(Argument { value: self.sum()?, start, end: self.last });
            if self.next.token != Token::Comma {
                return Ok(arguments);
            }
            self.advance()?;
        }
    }
}
