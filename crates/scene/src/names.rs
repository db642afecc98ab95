//! Names of a scene: what may be one, which are taken, and what they stand for in an expression.

use std::collections::HashMap;
use std::ops::Range;

use symbolic::{Expr, Graph, ParseErrorKind, Symbol};

use super::section::{Source, Text};
use crate::{NameFault, SceneError, SceneErrorKind, Unavailable};

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Time,
    Parameter,
    Coordinate,
    Definition,
    RemovalParameter,
    Memory,
}

impl Role {
    pub(super) fn noun(self) -> &'static str {
        match self {
            Role::Time => "time",
            Role::Parameter => "a parameter",
            Role::Coordinate => "a coordinate",
            Role::Definition => "a definition",
            Role::RemovalParameter => "a parameter of the removal",
            Role::Memory => "a memory variable",
        }
    }
}

/// The names that expressions can use.
#[derive(Clone, Default)]
pub(super) struct Names {
    roles: HashMap<String, Role>,
    /// Every name with its primes.
    expressions: HashMap<String, Expr>,
    /// The keys of `expressions` in the order of the file, for suggestions.
    known: Vec<String>,
}

impl Names {
    /// Makes `name` stand for `expression` and its derivatives for `primed`.
    pub(super) fn insert(&mut self, name: &str, role: Role, expression: Expr, primed: &[Expr]) {
        self.roles.insert(name.into(), role);
        for (primes, &e) in std::iter::once(&expression).chain(primed).enumerate() {
            let name = name.to_string() + &"'".repeat(primes);
            self.known.push(name.clone());
            self.expressions.insert(name, e);
        }
    }

    pub(super) fn role(&self, name: &str) -> Option<Role> {
        self.roles.get(name).copied()
    }

    /// Whether `name` can be a new name.
    pub(super) fn check_new(&self, graph: &Graph, name: &str) -> Result<(), NameFault> {
        if name.contains('\'') {
            return Err(NameFault::Primed);
        }
        if name == "t" {
            return Err(NameFault::Reserved("time"));
        }
        let nothing = |_: &str| None;
        match graph.parse(name, &nothing, &[]).map_err(|e| e.kind) {
            Err(ParseErrorKind::Undefined { name: read, .. }) if read == name => {}
            Ok(_) if name.starts_with(|c: char| c.is_alphabetic()) => return Err(NameFault::Reserved("a constant")),
            Err(ParseErrorKind::FunctionWithoutArgument { .. }) => return Err(NameFault::Reserved("a function")),
            _ => return Err(NameFault::NotIdentifier),
        }
        match graph.parse(&format!("{name}(1)"), &nothing, &[]).map_err(|e| e.kind) {
            Err(ParseErrorKind::UnknownFunction { .. } | ParseErrorKind::VariableCalled { .. }) => {}
            Err(ParseErrorKind::Undefined { .. }) => {}
            _ => return Err(NameFault::Reserved("a function")),
        }
        match self.role(name) {
            Some(role) => Err(NameFault::Taken { by: role.noun().into() }),
            None => Ok(()),
        }
    }

    /// [`Names::check_new`] with the place.
    pub(super) fn check(
        &self,
        source: Source,
        graph: &Graph,
        name: &str,
        span: &Range<usize>,
    ) -> Result<(), SceneError> {
        self.check_new(graph, name)
            .map_err(|fault| source.error(span, SceneErrorKind::InvalidName { name: name.into(), fault }))
    }

    /// Reads an expression.
    pub(super) fn parse(&self, source: Source, graph: &Graph, text: &Text) -> Result<Expr, SceneError> {
        let scope = |name: &str| self.expressions.get(name).copied();
        graph.parse(&text.text, &scope, &self.known).map_err(|error| {
            let kind = self.derivative_fault(&error.kind).unwrap_or(SceneErrorKind::Expression(error.kind));
            source.error_within(text, error.offset, error.length, kind)
        })
    }

    /// An undefined derivative of something that is defined has a better explanation than a similar name.
    fn derivative_fault(&self, kind: &ParseErrorKind) -> Option<SceneErrorKind> {
        let ParseErrorKind::Undefined { name, .. } = kind else { return None };
        let base = name.trim_end_matches('\'');
        if base == name {
            return None;
        }
        let reason = match self.role(base)? {
            Role::Coordinate | Role::RemovalParameter => Unavailable::Acceleration,
            role => Unavailable::NoDerivative(role.noun()),
        };
        Some(SceneErrorKind::Unavailable { name: name.clone(), reason })
    }
}

/// Finds the first symbol of `e` that `reason` rejects, and blames it where it stands in the text.
pub(super) fn check_symbols(
    source: Source,
    graph: &Graph,
    text: &Text,
    e: Expr,
    reason: impl Fn(Symbol) -> Option<Unavailable>,
) -> Result<(), SceneError> {
    for symbol in graph.symbols_of(e) {
        if let Some(reason) = reason(symbol) {
            let name = graph.name(symbol);
            let kind = SceneErrorKind::Unavailable { name: name.clone(), reason };
            return Err(match find_name(&text.text, &name) {
                Some(offset) => source.error_within(text, offset, name.len(), kind),
                None => source.error(&text.span, kind),
            });
        }
    }
    Ok(())
}

/// Where `name`, primes included, stands in `text` as a whole word.
fn find_name(text: &str, name: &str) -> Option<usize> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    text.match_indices(name)
        .find(|(i, _)| {
            let before = text[..*i].chars().next_back();
            let after = text[i + name.len()..].chars().next();
            !before.is_some_and(is_part) && !after.is_some_and(is_part)
        })
        .map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_words_are_found() {
        assert_eq!(find_name("x'' + x1 + x'*x", "x"), Some(14));
        assert_eq!(find_name("x'' + x1", "x"), None);
    }
}
