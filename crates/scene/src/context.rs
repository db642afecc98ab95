//! Context that the parts of the loader share.

use std::collections::HashMap;
use std::ops::Range;

use bodies::Written;
use mechanics::System;
use symbolic::{Expr, Graph, Symbol};

use super::formulas::Found;
use super::machine::Follows;
use super::names::{Names, check_symbols};
use super::overrides::Overrides;
use super::section::{Entry, Section, Source, Value};
use crate::{SceneError, SceneErrorKind, Unavailable};

/// A scene half read: its names, and the system as far as it is known.
pub(super) struct Context<'a> {
    pub(super) source: Source<'a>,
    pub(super) root: Section<'a>,
    pub(super) overrides: Overrides,
    pub(super) names: Names,
    pub(super) system: System,
    /// `q₀`, and the same as written.
    pub(super) positions: Vec<f64>,
    pub(super) written: Vec<(Symbol, Expr)>,
    /// Places of the coordinates that constraints on positions supplied.
    pub(super) configured: Vec<usize>,
    /// `t₀`.
    pub(super) time: f64,
    /// Where each constraint stands.
    pub(super) places: Vec<Range<usize>>,
    /// Constraints on positions as written: number, place, `g(q, t)`.
    pub(super) on_positions: Vec<(usize, Range<usize>, Expr)>,
    /// What follows from bodies, and what became of it.
    pub(super) follows: Follows,
    pub(super) found: Found,
}

impl Context<'_> {
    pub(super) fn parse(&self, text: &Written) -> Result<Expr, SceneError> {
        self.names.parse(self.source, &self.system.graph, text)
    }

    /// The number `value` at `values` of symbols; those without one are blamed with the words `known`.
    pub(super) fn evaluate(
        &self,
        value: &Value,
        what: &str,
        values: &HashMap<Symbol, f64>,
        known: &'static str,
    ) -> Result<f64, SceneError> {
        let text = match value {
            Value::Number(x) => return Ok(*x),
            Value::Expression(text) => text,
        };
        let g = &self.system.graph;
        let e = self.parse(text)?;
        let unknown = |s: Symbol| (!values.contains_key(&s)).then_some(Unavailable::NotYetKnown { known });
        check_symbols(self.source, g, text, e, unknown)?;
        // Every symbol has a value, so all that is left to go wrong is that the result is not finite.
        let value = g.evaluate(e, values).unwrap_or(f64::NAN);
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.source.error(&text.place, SceneErrorKind::NotFinite { what: what.into(), value }))
    }

    /// What stands at `entry`, as it is written.
    pub(super) fn written(&self, entry: &Entry) -> Result<Expr, SceneError> {
        self.expression(&entry.value()?)
    }

    pub(super) fn expression(&self, value: &Value) -> Result<Expr, SceneError> {
        match value {
            Value::Number(x) => Ok(self.system.graph.number(*x)),
            Value::Expression(text) => Ok(unrounded(&self.system.graph, self.parse(text)?)),
        }
    }

    /// A number, or an expression in parameters.
    pub(super) fn constant(&self, entry: &Entry) -> Result<f64, SceneError> {
        self.evaluate(&entry.value()?, &entry.path, &self.system.parameter_values(), "parameters")
    }

    /// Values of parameters and time.
    pub(super) fn constants(&self) -> HashMap<Symbol, f64> {
        let mut values = self.system.parameter_values();
        values.insert(self.system.time, self.time);
        values
    }

    /// Values of parameters, time and positions.
    pub(super) fn values_at_rest(&self) -> HashMap<Symbol, f64> {
        let mut values = self.constants();
        values.extend(self.system.positions().into_iter().zip(self.positions.iter().copied()));
        values
    }
}

/// A formula as it is written; where arithmetic has rounded it to a number, it is none that is known.
pub(super) fn unrounded(g: &Graph, e: Expr) -> Expr {
    if g.as_number(e).is_some() && g.as_fraction(e).is_none() { g.number(f64::NAN) } else { e }
}
