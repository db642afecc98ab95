//! Tables of a scene file with the place of everything in them.

use std::cell::RefCell;
use std::ops::Range;

use bodies::Written;
use toml::de::{DeTable, DeValue};

use crate::format::{FORMAT, Key};
use crate::number::is_decimal_of;
use crate::{SceneError, SceneErrorKind};

/// The text of a scene, where it came from, and what is wrong with it so far.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
    pub(super) faults: &'a RefCell<Vec<SceneError>>,
}

impl Source<'_> {
    /// What was read; a fault is noted, so that others are looked for.
    pub(super) fn note<T>(&self, result: Result<T, SceneError>) -> Option<T> {
        result.map_err(|fault| self.faults.borrow_mut().push(fault)).ok()
    }

    /// Gives up where faults were noted: what comes next rests on what could not be read.
    pub(super) fn no_fault(&self) -> Result<(), SceneError> {
        self.faults.borrow_mut().pop().map_or(Ok(()), Err)
    }

    pub(super) fn error(&self, span: &Range<usize>, kind: SceneErrorKind) -> SceneError {
        SceneError::at(self.file, self.text, span.clone(), kind)
    }

    /// An error at bytes `offset..offset + length` of a string value.
    ///
    /// Exact where the value stands in the file as it is; at the start of the value where escapes hide it.
    pub(super) fn error_within(
        &self,
        value: &Written,
        offset: usize,
        length: usize,
        kind: SceneErrorKind,
    ) -> SceneError {
        let raw = self.text.get(value.place.clone()).unwrap_or_default();
        match raw.find(&value.text) {
            Some(start) if !value.text.is_empty() => {
                let first = value.place.start + start + offset;
                self.error(&(first..first + length), kind)
            }
            _ => self.error(&value.place, kind),
        }
    }
}

/// A number or an expression, and its place.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    Expression(Written),
}

/// A key, its place, and what it stands for.
#[derive(Clone)]
pub(super) struct Entry<'a> {
    pub(super) source: Source<'a>,
    /// Path of the key, as in `coordinates.x`.
    pub(super) path: String,
    pub(super) key: &'a str,
    pub(super) key_span: Range<usize>,
    pub(super) span: Range<usize>,
    pub(super) value: &'a DeValue<'a>,
}

/// A table.
#[derive(Clone)]
pub(super) struct Section<'a> {
    pub(super) source: Source<'a>,
    /// How the table is called in messages.
    pub(super) path: String,
    /// Where it is introduced.
    pub(super) span: Range<usize>,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    pub(super) fn root(source: Source<'a>, table: &'a DeTable<'a>) -> Self {
        Section { source, path: String::new(), span: 0..0, table }
    }

    /// How the section is called in messages.
    pub(super) fn title(&self) -> String {
        if self.path.is_empty() { "the scene".into() } else { format!("[{}]", self.path) }
    }

    pub(super) fn entries(&self) -> impl Iterator<Item = Entry<'a>> {
        let (source, path) = (self.source, self.path.clone());
        self.table.iter().map(move |(key, value)| Entry {
            source,
            path: if path.is_empty() { key.get_ref().to_string() } else { format!("{path}.{}", key.get_ref()) },
            key: key.get_ref(),
            key_span: key.span(),
            span: value.span(),
            value: value.get_ref(),
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    pub(super) fn get(&self, key: &str) -> Option<Entry<'a>> {
        self.entries().find(|e| e.key == key)
    }

    pub(super) fn require(&self, key: &'static str, expected: &'static str) -> Result<Entry<'a>, SceneError> {
        self.get(key).ok_or_else(|| {
            let kind = SceneErrorKind::MissingKey { key, section: self.title(), expected };
            self.source.error(&self.span, kind)
        })
    }

    /// Notes every key that is none of `known`.
    pub(super) fn check_keys(&self, known: &[Key]) {
        for entry in self.entries().filter(|e| known.iter().all(|key| key.name != e.key)) {
            let known: Vec<String> = known.iter().map(|key| key.name.to_string()).collect();
            let (key, section) = (entry.key.to_string(), self.title());
            let suggestion = suggestion(entry.key, &known);
            let kind = SceneErrorKind::UnknownKey { key, section, suggestion, known };
            self.source.note::<()>(Err(entry.error_at_key(kind)));
        }
    }

    pub(super) fn section(&self, key: &str) -> Result<Option<Section<'a>>, SceneError> {
        self.get(key).map(|e| e.section()).transpose()
    }

    /// A string, empty if missing.
    pub(super) fn text_or_empty(&self, key: &str) -> Result<String, SceneError> {
        self.get(key).map_or(Ok(String::new()), |e| Ok(e.text("a string")?.text))
    }
}

impl<'a> Entry<'a> {
    pub(super) fn error(&self, kind: SceneErrorKind) -> SceneError {
        self.source.error(&self.span, kind)
    }

    pub(super) fn error_at_key(&self, kind: SceneErrorKind) -> SceneError {
        self.source.error(&self.key_span, kind)
    }

    fn wrong_type(&self, expected: &'static str) -> SceneError {
        self.error(SceneErrorKind::WrongType { found: with_article(self.value), expected })
    }

    pub(super) fn unknown_name(&self, expected: &'static str, known: &[String]) -> SceneError {
        let suggestion = suggestion(self.key, known);
        self.error_at_key(SceneErrorKind::UnknownName { name: self.key.into(), expected, suggestion })
    }

    pub(super) fn section(&self) -> Result<Section<'a>, SceneError> {
        match self.value {
            DeValue::Table(table) => {
                Ok(Section { source: self.source, path: self.path.clone(), span: self.key_span.clone(), table })
            }
            _ => Err(self.wrong_type("a table")),
        }
    }

    pub(super) fn text(&self, expected: &'static str) -> Result<Written, SceneError> {
        match self.value {
            DeValue::String(text) => Ok(Written { text: text.to_string(), place: self.span.clone() }),
            _ => Err(self.wrong_type(expected)),
        }
    }

    pub(super) fn boolean(&self) -> Result<bool, SceneError> {
        self.value.as_bool().ok_or_else(|| self.wrong_type("true or false"))
    }

    /// Refuses what is not the number of a format that is known.
    pub(super) fn check_format(&self) -> Result<(), SceneError> {
        let number = match self.value {
            DeValue::Integer(n) => u64::from_str_radix(n.as_str(), n.radix()).ok(),
            _ => None,
        };
        match number {
            Some(1..=FORMAT) => Ok(()),
            Some(format @ 1..) => Err(self.error(SceneErrorKind::NewerFormat { format })),
            _ => Err(self.wrong_type("the number of a format, as in format = 1")),
        }
    }

    /// A finite number.
    pub(super) fn number(&self) -> Result<f64, SceneError> {
        match number(self.value) {
            None => Err(self.wrong_type("a number")),
            Some(value) if value.is_finite() => Ok(value),
            Some(value) => Err(self.error(SceneErrorKind::NotFinite { what: self.path.clone(), value })),
        }
    }

    /// A finite number, or an expression.
    pub(super) fn value(&self) -> Result<Value, SceneError> {
        match self.value {
            DeValue::String(_) => Ok(Value::Expression(self.text("")?)),
            DeValue::Integer(_) | DeValue::Float(_) => {
                let value = self.number()?;
                let text = match self.value {
                    DeValue::Float(x) => x.as_str(),
                    DeValue::Integer(n) if n.radix() == 10 => n.as_str(),
                    _ => return Ok(Value::Number(value)),
                };
                // digits that an f64 has not got stay text
                match is_decimal_of(text, value) {
                    true => Ok(Value::Number(value)),
                    false => Ok(Value::Expression(Written { text: text.to_owned(), place: self.span.clone() })),
                }
            }
            _ => Err(self.wrong_type("a number or an expression in quotes")),
        }
    }

    /// The elements of an array, as entries with the key of the array.
    pub(super) fn elements(&self, expected: &'static str) -> Result<Vec<Entry<'a>>, SceneError> {
        let array = self.value.as_array().ok_or_else(|| self.wrong_type(expected))?;
        let element = |(i, item): (usize, &'a toml::Spanned<DeValue<'a>>)| Entry {
            path: format!("{} number {}", self.path, i + 1),
            span: item.span(),
            value: item.get_ref(),
            ..self.clone()
        };
        Ok(array.iter().enumerate().map(element).collect())
    }
}

fn number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(n) => {
            let digits = n.as_str();
            let sign = if digits.starts_with('-') { -1.0 } else { 1.0 };
            let radix = n.radix();
            match i64::from_str_radix(digits, radix) {
                Ok(exact) => Some(exact as f64),
                Err(_) if radix == 10 => digits.parse().ok(),
                Err(_) => {
                    let size = digits.chars().filter_map(|c| c.to_digit(radix));
                    Some(sign * size.fold(0.0, |x, digit| x * f64::from(radix) + f64::from(digit)))
                }
            }
        }
        _ => None,
    }
}

fn with_article(value: &DeValue) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date or time",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}

/// The entry of `known` that `name` may have been meant for.
pub(super) fn suggestion(name: &str, known: &[String]) -> Option<String> {
    symbolic::nearest(name, known.iter().map(String::as_str))
}
