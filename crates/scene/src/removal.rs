//! Hand-written parametrizations.

use std::collections::{BTreeMap, HashMap};

use bodies::Written;
use symbolic::{Expr, Symbol};

use super::constants;
use super::context::Context;
use super::names::{Names, Role, check_symbols};
use super::section::{Entry, Section, Value};
use crate::{NameFault, SceneError, SceneErrorKind, Unavailable, format};
use mechanics::{Coordinate, DisplacementParameter, MemoryVariable, Removal, RemovalError};

/// All removals of the scene, verified. One without a name is called `given`.
pub(super) fn read_all(context: &Context) -> Result<Vec<Removal>, SceneError> {
    let Some(section) = context.root.section("removal")? else { return Ok(Vec::new()) };
    if section.entries().any(|e| format::REMOVAL.iter().any(|key| key.name == e.key)) {
        return Ok(vec![read(context, "given", &section)?]);
    }
    let own = |e: Entry| match Removal::AUTOMATIC.contains(&e.key) {
        true => {
            let fault = NameFault::Reserved("a removal that every scene has");
            Err(e.error_at_key(SceneErrorKind::InvalidName { name: e.key.into(), fault }))
        }
        false => read(context, e.key, &e.section()?),
    };
    section.entries().map(own).collect()
}

fn read(context: &Context, name: &str, section: &Section) -> Result<Removal, SceneError> {
    section.check_keys(format::REMOVAL);
    context.source.no_fault()?;
    let mut reader = Reader { context, section, names: context.names.clone(), forbidden: HashMap::new() };
    let parameters = reader.parameters()?;
    let defined = reader.coordinate_roles(name, &parameters)?;
    let extra = reader.extra_memory()?;
    reader.forbid(&parameters, &defined);
    let system = &context.system;
    let mut memory = Vec::new();
    let mut coordinates = system.graph.variables(&system.positions());
    for (entry, index, is_rate) in &defined {
        if *is_rate {
            let rate = reader.expression(entry, &[])?;
            let symbol = system.coordinates[*index].position;
            memory.push(MemoryVariable { symbol, rate, coordinate: Some(*index) });
        } else {
            let second: Vec<Symbol> = parameters.iter().map(|u| u.second_rate).collect();
            coordinates[*index] = reader.expression(entry, &second)?;
        }
    }
    for (entry, symbol) in extra {
        memory.push(MemoryVariable { symbol, rate: reader.expression(&entry, &[])?, coordinate: None });
    }
    let removal = Removal {
        name: name.into(),
        start: reader.start(&parameters, &memory)?,
        constants: constants::rule(context, section, &memory)?,
        parameters,
        memory,
        coordinates,
        chart: Vec::new(),
    };
    removal.verify(system).map_err(|error| {
        let place = match error {
            RemovalError::WrongCount { .. } => section.get("parameters").map(|e| e.span),
            _ => None,
        };
        context.source.error(&place.unwrap_or(section.span.clone()), SceneErrorKind::Removal(error))
    })?;
    Ok(removal)
}

/// A coordinate that `rates` (then `true`) or `direct` gives: entry and index.
type Given<'a> = (Entry<'a>, usize, bool);

struct Reader<'a, 'b> {
    context: &'b Context<'a>,
    section: &'b Section<'a>,
    names: Names,
    /// Symbols of the system that the parametrization is to replace, and why they cannot be used.
    forbidden: HashMap<Symbol, Unavailable>,
}

impl<'a> Reader<'a, '_> {
    fn coordinate(&self, name: &str) -> Option<usize> {
        self.context.system.coordinates.iter().position(|c| c.name == name)
    }

    fn parameters(&mut self) -> Result<Vec<DisplacementParameter>, SceneError> {
        let g = &self.context.system.graph;
        let entry = self.section.require("parameters", "an array of names: new ones, or coordinates that stay")?;
        let mut parameters: Vec<DisplacementParameter> = Vec::new();
        for element in entry.elements("an array of names")? {
            let Written { text: name, place } = element.text("a name in quotes")?;
            let coordinate = self.coordinate(&name);
            if coordinate.is_none() {
                self.names.check(self.context.source, g, (&name, &place), Role::RemovalParameter)?;
            }
            let symbol = g.symbol(&name);
            if parameters.iter().any(|u| u.symbol == symbol) {
                let fault = crate::NameFault::Taken { by: Role::RemovalParameter.noun().into() };
                return Err(element.error(SceneErrorKind::InvalidName { name, fault }));
            }
            let (rate, second_rate) = (g.symbol(&format!("{name}'")), g.symbol(&format!("{name}''")));
            let role = if coordinate.is_some() { Role::Coordinate } else { Role::RemovalParameter };
            self.names.insert(&name, role, g.variable(symbol), &g.variables(&[rate, second_rate]));
            parameters.push(DisplacementParameter { symbol, rate, second_rate, coordinate });
        }
        Ok(parameters)
    }

    /// What `rates` and `direct` give. Every coordinate is given once, or is a parameter.
    fn coordinate_roles(
        &self,
        removal: &str,
        parameters: &[DisplacementParameter],
    ) -> Result<Vec<Given<'a>>, SceneError> {
        let names: Vec<String> = self.context.system.coordinates.iter().map(|c| c.name.clone()).collect();
        let mut roles: Vec<Vec<&'static str>> = vec![Vec::new(); names.len()];
        for i in parameters.iter().filter_map(|u| u.coordinate) {
            roles[i].push("a parameter");
        }
        let mut given = Vec::new();
        for (key, role) in [("rates", "in rates"), ("direct", "in direct")] {
            let Some(section) = self.section.section(key)? else { continue };
            for entry in section.entries() {
                let Some(i) = self.coordinate(entry.key) else {
                    return Err(entry.unknown_name("coordinate", &names));
                };
                roles[i].push(role);
                given.push((entry, i, key == "rates"));
            }
        }
        match roles.iter().position(|r| r.len() != 1) {
            None => Ok(given),
            Some(i) => {
                let (removal, coordinate) = (removal.to_string(), names[i].clone());
                let kind = SceneErrorKind::CoordinateRole { removal, coordinate, roles: roles[i].clone() };
                let again = given.iter().rev().find(|(_, index, _)| *index == i).map(|g| &g.0);
                Err(again.map_or_else(
                    || self.context.source.error(&self.section.span, kind.clone()),
                    |entry| entry.error_at_key(kind.clone()),
                ))
            }
        }
    }

    /// Memory variables that are not coordinates.
    fn extra_memory(&mut self) -> Result<Vec<(Entry<'a>, Symbol)>, SceneError> {
        let g = &self.context.system.graph;
        let Some(section) = self.section.section("memory")? else { return Ok(Vec::new()) };
        let mut extra = Vec::new();
        for entry in section.entries() {
            self.names.check(self.context.source, g, (entry.key, &entry.key_span), Role::Memory)?;
            let symbol = g.symbol(entry.key);
            self.names.insert(entry.key, Role::Memory, g.variable(symbol), &[]);
            extra.push((entry, symbol));
        }
        Ok(extra)
    }

    fn forbid(&mut self, parameters: &[DisplacementParameter], given: &[Given]) {
        for (i, Coordinate { position, velocity, .. }) in self.context.system.coordinates.iter().enumerate() {
            if parameters.iter().all(|u| u.coordinate != Some(i)) {
                self.forbidden.insert(*velocity, Unavailable::RemovedVelocity);
            }
            if given.iter().any(|(_, index, is_rate)| *index == i && !is_rate) {
                self.forbidden.insert(*position, Unavailable::DirectCoordinate);
            }
        }
    }

    /// An expression in `(ü, u̇, u, w, t)`, without the symbols `second`.
    fn expression(&self, entry: &Entry, second: &[Symbol]) -> Result<Expr, SceneError> {
        let g = &self.context.system.graph;
        let text = match entry.value()? {
            Value::Number(x) => return Ok(g.number(x)),
            Value::Expression(text) => text,
        };
        let e = self.names.parse(self.context.source, g, &text)?;
        check_symbols(self.context.source, g, &text, e, |s| {
            let reason = self.forbidden.get(&s).cloned();
            reason.or_else(|| second.contains(&s).then_some(Unavailable::SecondRate))
        })?;
        Ok(e)
    }

    /// Start values of parameters, rates and memory variables that are not coordinates.
    fn start(
        &self,
        parameters: &[DisplacementParameter],
        memory: &[MemoryVariable],
    ) -> Result<BTreeMap<Symbol, Expr>, SceneError> {
        let g = &self.context.system.graph;
        let mut start = BTreeMap::new();
        let Some(section) = self.section.section("start")? else { return Ok(start) };
        let own = parameters.iter().filter(|u| u.coordinate.is_none()).flat_map(|u| [u.symbol, u.rate]);
        let extra = memory.iter().filter(|w| w.coordinate.is_none()).map(|w| w.symbol);
        let symbols: Vec<(String, Symbol)> = own.chain(extra).map(|s| (g.name(s), s)).collect();
        for entry in section.entries() {
            let Some((_, symbol)) = symbols.iter().find(|(name, _)| name == entry.key) else {
                let known: Vec<String> = symbols.into_iter().map(|s| s.0).collect();
                let expected = "parameter, rate or memory variable of this removal that is not a coordinate";
                return Err(entry.unknown_name(expected, &known));
            };
            start.insert(*symbol, self.context.written(&entry)?);
        }
        Ok(start)
    }
}
