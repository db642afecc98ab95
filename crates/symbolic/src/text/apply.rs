//! The functions that a formula may call, applied.

use crate::text::atoms::Argument;
use crate::text::lexer::{Fault, Spanned};
use crate::text::parse::Parser;
use crate::{Expr, Function, Graph, ParseErrorKind, Value};

impl Parser<'_> {
    /// The function of that name, of as many arguments as it takes, each with its place.
    pub(crate) fn apply(&self, token: Spanned, axes: Option<Spanned>, arguments: &[Argument]) -> Result<Value, Fault> {
        let (g, name) = (self.graph, self.slice(token));
        let whole = |kind| Fault { kind, start: token.start, end: self.last };
        let number = |i: usize| -> Result<Expr, Fault> {
            let Argument { value, start, end } = &arguments[i];
            self.number(value, *start, *end)
        };
        let wrong = |expected: &'static str| {
            let found = arguments.iter().map(|argument| argument.value.shape()).collect::<Vec<_>>().join(" and ");
            whole(ParseErrorKind::WrongShape { function: name.to_owned(), expected, found })
        };
        let value = |i: usize| &arguments[i].value;
        Ok(Value::Scalar(match name {
            "dot" => match (value(0), value(1)) {
                (Value::Vector(a), Value::Vector(b)) if a.len() == b.len() => g.dot(a, b),
                _ => return Err(wrong("two vectors of one length")),
            },
            "norm" => match value(0) {
                Value::Vector(a) => g.sqrt(g.dot(a, a)),
                _ => return Err(wrong("a vector")),
            },
            "cross" => match (value(0), value(1)) {
                (Value::Vector(a), Value::Vector(b)) if (a.len(), b.len()) == (3, 3) => {
                    return Ok(Value::Vector(g.cross(a, b)));
                }
                _ => return Err(wrong("two vectors of 3")),
            },
            "transpose" => match value(0) {
                Value::Matrix(m, turns) => return Ok(g.transpose_value(m, turns)),
                _ => return Err(wrong("a matrix")),
            },
            "diag" => {
                let entries = (0..arguments.len()).map(number).collect::<Result<Vec<_>, _>>()?;
                return Ok(g.diagonal(&entries));
            }
            "rotation" => {
                let Some(word) = axes else {
                    let axis = match value(0) {
                        Value::Vector(a) if arguments.len() == 2 => <[Expr; 3]>::try_from(&a[..]).ok(),
                        _ => None,
                    };
                    let expected = "axes such as zxz with an angle each, or a vector of 3 and an angle";
                    return Ok(g.rotation_about(&axis.ok_or_else(|| wrong(expected))?, number(1)?));
                };
                let angles = (0..arguments.len()).map(number).collect::<Result<Vec<_>, _>>()?;
                let letters = self.slice(word).trim_matches('"').to_owned();
                let found = angles.len();
                let turned = g.rotation(&letters, &angles);
                return turned.ok_or_else(|| self.fault(ParseErrorKind::Axes { letters, found }, word));
            }
            "angular_velocity" | "body_angular_velocity" => {
                let turns = match value(0) {
                    Value::Matrix(_, turns) if !turns.is_empty() => turns,
                    _ => return Err(wrong("a rotation or a product of rotations")),
                };
                let omega = g.angular_velocity(turns, name == "body_angular_velocity", self.scope);
                return omega.map(Value::Vector).ok_or_else(|| whole(ParseErrorKind::NoRate));
            }
            "step" => {
                let width = number(3)?;
                let edge = |at: Expr| Ok(g.call(Function::Tanh, g.div(g.sub(number(0)?, at), width)));
                let (up, down) = (edge(number(1)?)?, edge(number(2)?)?);
                g.div(g.sub(up, down), g.integer(2))
            }
            _ => {
                let numbers = (0..arguments.len()).map(number).collect::<Result<Vec<_>, _>>()?;
                g.apply(name, &numbers)
            }
        }))
    }
}

impl Graph {
    fn diagonal(&self, entries: &[Expr]) -> Value {
        let n = entries.len();
        let entry = |i, j| if i == j { entries[i] } else { self.zero() };
        Value::Matrix(crate::Matrix::from_fn(n, n, entry), Vec::new())
    }

    /// A function of numbers.
    fn apply(&self, name: &str, arguments: &[Expr]) -> Expr {
        let x = arguments[0];
        match name {
            "sqrt" => self.power_as_written(x, self.ratio(1, 2)),
            "ln" => self.call_as_written(Function::Log, x),
            "sec" => self.powi(self.call(Function::Cos, x), -1),
            "csc" => self.powi(self.call(Function::Sin, x), -1),
            "cot" => self.div(self.call(Function::Cos, x), self.call(Function::Sin, x)),
            "atan2" => self.atan2(x, arguments[1]),
            "pow" => self.power_as_written(x, arguments[1]),
            _ => match Function::ALL.iter().find(|f| f.name() == name) {
                Some(f) => self.call_as_written(*f, x),
                None => unreachable!("`{name}` is among the functions"),
            },
        }
    }
}
