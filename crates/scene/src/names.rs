//! Names of a scene: what may be one, which are taken, and what they stand for in an expression.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use bodies::Written;
use mechanics::System;
use symbolic::{Expr, Graph, ParseError, ParseErrorKind, Scope, Symbol, Value};

use super::section::Source;
use crate::{NameFault, SceneError, SceneErrorKind, Unavailable};

/// The meaning of a name.
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

/// The parameter of the family between, a name that scenes leave to it.
const KAPPA: &str = "kappa";

/// Parameters of laws, which can be set in a scene that does not name them.
pub(super) const OF_LAWS: [&str; 3] = [KAPPA, "epsilon", "slip"];

/// The names that expressions can use.
#[derive(Clone, Default)]
pub(super) struct Names {
    roles: HashMap<String, Role>,
    /// Every name with its primes.
    values: HashMap<String, Value>,
    /// The keys of `values` in the order of the file, for suggestions.
    known: Vec<String>,
    /// `dq/dt = v` and `dt/dt = 1`, once the coordinates are known.
    flow: Vec<(Symbol, Expr)>,
    /// What does not change with time.
    constants: HashSet<Symbol>,
    /// Names that are defined, but could not be read.
    faulty: HashSet<String>,
}

/// The names, and the graph in which they are expressions.
struct Known<'a>(&'a Names, &'a Graph);

impl Scope for Known<'_> {
    fn value(&self, name: &str) -> Option<Value> {
        let known = self.0.values.get(name);
        known.cloned().or_else(|| {
            // the rate of a definition
            let base = name.strip_suffix('\'').filter(|base| self.0.role(base) == Some(Role::Definition))?;
            let value = self.0.values.get(base)?;
            Some(value.with(value.entries().iter().map(|&e| self.rate(e)).collect::<Option<_>>()?))
        })
    }

    fn rate(&self, e: Expr) -> Option<Expr> {
        let Known(names, graph) = self;
        let moves = |s: &Symbol| names.flow.iter().any(|(known, _)| known == s);
        let written = graph.symbols_of(e).iter().all(|s| moves(s) || names.constants.contains(s));
        written.then(|| graph.total_derivative(e, &names.flow))
    }

    fn known(&self) -> &[String] {
        &self.0.known
    }
}

impl Names {
    /// Makes `name` stand for `expression` and its derivatives for `primed`.
    pub(super) fn insert(&mut self, name: &str, role: Role, expression: Expr, primed: &[Expr]) {
        for (primes, &e) in std::iter::once(&expression).chain(primed).enumerate() {
            self.insert_value(&(name.to_string() + &"'".repeat(primes)), Value::Scalar(e));
        }
        self.roles.insert(name.into(), role);
    }

    /// Makes a definition stand for a number, a vector or a matrix.
    pub(super) fn define(&mut self, name: &str, value: Value) {
        self.insert_value(name, value);
        self.roles.insert(name.into(), Role::Definition);
    }

    fn insert_value(&mut self, name: &str, value: Value) {
        self.known.push(name.into());
        self.values.insert(name.into(), value);
    }

    /// A parameter: it does not change with time.
    pub(super) fn insert_parameter(&mut self, name: &str, graph: &Graph, value: Expr) {
        self.insert(name, Role::Parameter, value, &[]);
        self.constants.extend(graph.symbols_of(value));
    }

    /// What changes with time, and how.
    pub(super) fn insert_flow(&mut self, system: &System) {
        let velocities = system.velocities();
        self.flow = system.flow().into_iter().filter(|(s, _)| !velocities.contains(s)).collect();
    }

    /// A name of this role that could not be read: what uses it is not blamed.
    pub(super) fn insert_faulty(&mut self, name: &str, role: Role) {
        self.roles.insert(name.into(), role);
        self.faulty.insert(name.into());
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
        match graph.parse(name, &nothing).map_err(|e| e.kind) {
            Err(ParseErrorKind::Undefined { name: read, .. }) if read == name => {}
            Ok(_) if name.starts_with(|c: char| c.is_alphabetic()) => return Err(NameFault::Reserved("a constant")),
            Err(ParseErrorKind::FunctionWithoutArgument { .. }) => return Err(NameFault::Reserved("a function")),
            _ => return Err(NameFault::NotIdentifier),
        }
        match graph.parse(&format!("{name}(1)"), &nothing).map_err(|e| e.kind) {
            Err(ParseErrorKind::UnknownFunction { .. } | ParseErrorKind::VariableCalled { .. }) => {}
            Err(ParseErrorKind::Undefined { .. }) => {}
            _ => return Err(NameFault::Reserved("a function")),
        }
        match self.role(name) {
            Some(role) => Err(NameFault::Taken { by: role.noun().into() }),
            None => Ok(()),
        }
    }

    /// [`Names::check_new`] with the place. Numbers that `--set` replaces cannot have the names by which it
    /// means something else ([`Scene::parse_with`](crate::Scene::parse_with)).
    pub(super) fn check(
        &self,
        source: Source,
        graph: &Graph,
        (name, span): (&str, &Range<usize>),
        role: Role,
    ) -> Result<(), SceneError> {
        let overriding = match role {
            Role::Parameter => overriding(name),
            // any scene may be given this parameter
            _ if name == KAPPA => Some(NameFault::Overriding("the parameter of the formulation `kappa`")),
            Role::Coordinate | Role::RemovalParameter | Role::Memory => overriding(name),
            Role::Time | Role::Definition => None,
        };
        let fault = overriding.map_or_else(|| self.check_new(graph, name), Err);
        fault.map_err(|fault| source.error(span, SceneErrorKind::InvalidName { name: name.into(), fault }))
    }

    /// Reads a number as an expression.
    pub(super) fn parse(&self, source: Source, graph: &Graph, text: &Written) -> Result<Expr, SceneError> {
        graph.parse(&text.text, &Known(self, graph)).map_err(|error| self.fault(source, text, error))
    }

    /// Reads an expression for a number, a vector or a matrix.
    pub(super) fn parse_value(&self, source: Source, graph: &Graph, text: &Written) -> Result<Value, SceneError> {
        graph.parse_value(&text.text, &Known(self, graph)).map_err(|error| self.fault(source, text, error))
    }

    /// The first fault of a formula; the others are noted.
    fn fault(&self, source: Source, text: &Written, mut error: ParseError) -> SceneError {
        for other in std::mem::take(&mut error.also) {
            source.note::<()>(Err(self.fault(source, text, other)));
        }
        let kind = self.better_fault(&error.kind).unwrap_or(SceneErrorKind::Expression(error.kind));
        source.error_within(text, error.offset, error.length, kind)
    }

    /// The coordinate whose time derivative `theta_dot`, `thetadot` or `dtheta` is meant to be.
    fn with_dot(&self, name: &str) -> Option<String> {
        let base = ["_dot", "dot", "_d"].iter().find_map(|end| name.strip_suffix(end));
        let base = [base, name.strip_prefix('d')].into_iter().flatten();
        let moves = |base: &&str| matches!(self.role(base), Some(Role::Coordinate | Role::RemovalParameter));
        base.filter(|base| !base.is_empty()).find(moves).map(String::from)
    }

    /// An undefined derivative of something that is defined has a better explanation than a similar name, and
    /// what has a fault of its own is not undefined.
    fn better_fault(&self, kind: &ParseErrorKind) -> Option<SceneErrorKind> {
        let ParseErrorKind::Undefined { name, .. } = kind else { return None };
        let base = name.trim_end_matches('\'');
        if let Some(base) = self.with_dot(name) {
            return Some(SceneErrorKind::Unavailable { name: name.clone(), reason: Unavailable::Dot(base) });
        }
        if self.faulty.contains(base) {
            return Some(SceneErrorKind::Faulty { name: base.into() });
        }
        if base == name {
            return None;
        }
        let reason = match self.role(base)? {
            Role::Coordinate | Role::RemovalParameter | Role::Definition => Unavailable::Acceleration,
            role => Unavailable::NoDerivative(role.noun()),
        };
        Some(SceneErrorKind::Unavailable { name: name.clone(), reason })
    }
}

/// What `--set` means by this name, apart from the names of the scene.
fn overriding(name: &str) -> Option<NameFault> {
    let numbered = |stem| name.strip_prefix(stem).is_some_and(|i| i.parse::<usize>().is_ok());
    match name {
        "time" => Some(NameFault::Overriding("the start time")),
        "duration" => Some(NameFault::Overriding("the length of the run")),
        _ if numbered("mu0_") => Some(NameFault::Overriding("a multiplier at the start")),
        _ if numbered("mu") => Some(NameFault::Reserved("printed like a multiplier")),
        _ => name.starts_with("P0_").then_some(NameFault::Overriding("a costate")),
    }
}

/// Finds the first symbol of `e` that `reason` rejects, and blames it where it stands in the text.
pub(super) fn check_symbols(
    source: Source,
    graph: &Graph,
    text: &Written,
    e: Expr,
    reason: impl Fn(Symbol) -> Option<Unavailable>,
) -> Result<(), SceneError> {
    for symbol in graph.symbols_of(e) {
        if let Some(reason) = reason(symbol) {
            let name = graph.name(symbol);
            let kind = SceneErrorKind::Unavailable { name: name.clone(), reason };
            return Err(match find_name(&text.text, &name) {
                Some(offset) => source.error_within(text, offset, name.len(), kind),
                None => source.error(&text.place, kind),
            });
        }
    }
    Ok(())
}

/// Where `name`, primes included, stands in `text` as a whole word.
pub fn find_name(text: &str, name: &str) -> Option<usize> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    text.match_indices(name)
        .find(|(i, _)| {
            let before = text[..*i].chars().next_back();
            let after = text[i + name.len()..].chars().next();
            !before.is_some_and(is_part) && !after.is_some_and(is_part)
        })
        .map(|(i, _)| i)
}
