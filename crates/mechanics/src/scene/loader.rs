//! From the text of a scene to the scene.

use std::collections::HashMap;

use symbolic::{Expr, Symbol};
use toml::de::DeTable;

use super::names::{Names, check_symbols};
use super::overrides::Overrides;
use super::section::{Section, Source, Text, Value};
use super::{Scene, constants, removal, start, system};
use crate::{SceneError, SceneErrorKind, System, Unavailable};

/// What the parts of the loader share.
pub(super) struct Context<'a> {
    pub(super) source: Source<'a>,
    pub(super) root: Section<'a>,
    pub(super) overrides: Overrides,
    pub(super) names: Names,
    pub(super) system: System,
    /// `q₀`.
    pub(super) positions: Vec<f64>,
    /// `t₀`.
    pub(super) time: f64,
}

pub(super) fn load(name: &str, file: &str, text: &str, overrides: &[(String, f64)]) -> Result<Scene, SceneError> {
    let source = Source { file, text };
    let size = text.len() as u64;
    if size > super::SIZE_LIMIT {
        return Err(SceneError::outside(file, SceneErrorKind::TooLarge { size, limit: super::SIZE_LIMIT }));
    }
    let table = DeTable::parse(text).map_err(|error| {
        let kind = SceneErrorKind::Syntax { message: error.message().trim().replace('\n', "; ") };
        source.error(&error.span().unwrap_or(0..0), kind)
    })?;
    if table.get_ref().is_empty() {
        return Err(source.error(&(0..0), SceneErrorKind::Empty));
    }
    let root = Section::root(source, table.get_ref());
    root.check_keys(&[
        "title",
        "source",
        "notes",
        "parameters",
        "coordinates",
        "definitions",
        "system",
        "start",
        "removal",
        "vakonomic",
        "run",
    ])?;
    let title = root.require("title", "a string")?.text("a string")?.text;
    let run = root.require("run", "a table with the duration")?.section()?;
    run.check_keys(&["duration"])?;

    let context = system::build(source, root, Overrides::new(source, overrides)?)?;
    let removals = removal::read_all(&context)?;
    let (state, completion) = start::complete(&context, &removals)?;
    let multipliers = constants::multipliers(&context)?;
    let duration = run.require("duration", "a positive number")?;
    let out_of_range = |value| SceneErrorKind::OutOfRange { what: "the duration", value, limit: 0.0 };
    let given = duration.number()?;
    let value = match context.overrides.get("duration") {
        Some(value) if value > 0.0 => value,
        Some(value) => return Err(SceneError::outside(file, out_of_range(value))),
        None if given > 0.0 => given,
        None => return Err(duration.error(out_of_range(given))),
    };
    context.overrides.check_used(source)?;
    Ok(Scene {
        name: name.into(),
        title,
        source: context.root.text_or_empty("source")?,
        notes: context.root.text_or_empty("notes")?,
        system: context.system,
        start: state,
        completion,
        removals,
        multipliers,
        duration: value,
    })
}

impl Context<'_> {
    pub(super) fn parse(&self, text: &Text) -> Result<Expr, SceneError> {
        self.names.parse(self.source, &self.system.graph, text)
    }

    /// The number that `value` is when symbols have `values`; those without one are blamed with the words `known`.
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
        Err(self.source.error(&text.span, SceneErrorKind::NotFinite { what: what.into(), value }))
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
