//! Parameters, coordinates, definitions and `[system]`.

use std::cell::RefCell;
use std::collections::HashMap;

use symbolic::{Graph, Symbol};

use super::context::{Context, unrounded};
use super::followed;
use super::formulas::Found;
use super::machine::Follows;
use super::names::{Names, OF_LAWS, Role};
use super::order::in_order;
use super::overrides::Overrides;
use super::section::{Entry, Section, Source, Value};
use crate::{NameFault, SceneError, SceneErrorKind, format};
use mechanics::{Configurations, Constancy, Parameter, System, Watched};

/// Reads everything that makes the system, and the positions at the start.
pub(super) fn build<'a>(
    source: Source<'a>,
    root: Section<'a>,
    overrides: Overrides,
    follows: Follows,
) -> Result<Context<'a>, SceneError> {
    let graph = Graph::new();
    let mut names = Names::default();
    let parameters = match source.note(root.section("parameters")).flatten() {
        Some(section) => parameters(&section, &overrides, &graph, &mut names),
        None => Vec::new(),
    };
    let coordinates = root.require("coordinates", "a table with one entry a coordinate")?.section()?;
    if coordinates.is_empty() {
        let (section, expected) =
            (coordinates.title(), "at least one coordinate, as in x = { unit = \"m\", start = 0 }");
        return Err(source.error(&coordinates.span, SceneErrorKind::EmptySection { section, expected }));
    }
    let mut units = Vec::new();
    for entry in coordinates.entries() {
        source.note(names.check(source, &graph, (entry.key, &entry.key_span), Role::Coordinate));
        let unit = source.note(entry.section()).and_then(|section| source.note(unit(&section)));
        units.push((entry.key, unit.unwrap_or_default()));
        let q = graph.variable(graph.symbol(entry.key));
        let v = graph.variable(graph.symbol(&format!("{}'", entry.key)));
        names.insert(entry.key, Role::Coordinate, q, &[v]);
    }
    let units: Vec<(&str, &str)> = units.iter().map(|(name, unit)| (*name, unit.as_str())).collect();
    let system = System::new(graph, &units);
    names.insert("t", Role::Time, system.graph.variable(system.time), &[]);
    names.insert_flow(&system);
    let mut context = Context {
        source,
        root,
        overrides,
        names,
        system,
        positions: Vec::new(),
        written: Vec::new(),
        configured: Vec::new(),
        time: 0.0,
        places: Vec::new(),
        on_positions: Vec::new(),
        follows,
        found: Found::default(),
    };
    context.system.parameters = parameters;
    for name in OF_LAWS.into_iter().filter(|name| context.names.role(name).is_none()) {
        // a number of a law, which is no part of the system: any scene takes it
        if let Some(value) = context.overrides.get(name) {
            let symbol = context.system.graph.symbol(name);
            context.system.parameters.push(Parameter { symbol, value, formula: None });
        }
    }
    definitions(&mut context)?;
    source.note(read_system(&mut context));
    context.system.domains = context.system.graph.lost_domains(&context.system.written());
    for (section, constancy) in [("invariants", Constancy::Expected), ("observables", Constancy::Free)] {
        source.note(watched(&mut context, section, constancy));
    }
    context.time = source.note(start_time(&mut context)).unwrap_or_default();
    positions(&mut context, &coordinates)?;
    Ok(context)
}

/// The label of a coordinate's unit.
fn unit(section: &Section) -> Result<String, SceneError> {
    section.check_keys(format::COORDINATE);
    let unit = section.text_or_empty("unit")?;
    let degrees = matches!(unit.as_str(), "deg" | "degree" | "degrees" | "°");
    match section.get("unit").filter(|_| degrees) {
        Some(entry) => Err(entry.error(SceneErrorKind::Degrees { unit })),
        None => Ok(unit),
    }
}

/// Parameters that are numbers. One that is given by others is an expression in them, and follows them.
fn parameters(section: &Section, overrides: &Overrides, graph: &Graph, names: &mut Names) -> Vec<Parameter> {
    let source = section.source;
    let mut written = Vec::new();
    for entry in section.entries() {
        let checked = names.check(source, graph, (entry.key, &entry.key_span), Role::Parameter);
        let value = source.note(checked).and_then(|()| {
            let given = source.note(entry.value())?;
            Some(overrides.written(entry.key).unwrap_or(given))
        });
        match value {
            Some(value) => written.push((entry, value)),
            // it is a number in any case
            None if names.role(entry.key).is_none() => {
                names.insert_parameter(entry.key, graph, graph.variable(graph.symbol(entry.key)));
            }
            None => {}
        }
    }
    let places: HashMap<&str, usize> = written.iter().enumerate().map(|(i, (e, _))| (e.key, i)).collect();
    let mut parameters = Vec::new();
    for (entry, value) in in_order(source, written, Role::Parameter, names) {
        let is_formula = matches!(value, Value::Expression(_));
        let read = match value {
            Value::Number(x) => Ok(graph.number(x)),
            Value::Expression(text) => names.parse(source, graph, &text),
        };
        let e = source.note(read).unwrap_or_else(|| graph.number(f64::NAN));
        let given_by_others = !graph.symbols_of(e).is_empty();
        let value = if given_by_others { e } else { graph.variable(graph.symbol(entry.key)) };
        names.insert_parameter(entry.key, graph, value);
        if !given_by_others {
            let formula = is_formula.then(|| unrounded(graph, e));
            // 2 cos(π/3) − 1 is 0, and no last digit of 1
            let value = graph.evaluate(graph.constant(e), &HashMap::new()).unwrap_or(f64::NAN);
            parameters.push((places[entry.key], Parameter { symbol: graph.symbol(entry.key), value, formula }));
        }
    }
    parameters.sort_by_key(|(place, _)| *place);
    parameters.into_iter().map(|(_, parameter)| parameter).collect()
}

fn definitions(context: &mut Context) -> Result<(), SceneError> {
    let Some(section) = context.root.section("definitions")? else {
        return followed::explain(context, Vec::new());
    };
    let source = context.source;
    let mut written = Vec::new();
    for entry in section.entries() {
        let checked =
            context.names.check(source, &context.system.graph, (entry.key, &entry.key_span), Role::Definition);
        match source.note(checked.and_then(|()| entry.value())) {
            Some(value) => written.push((entry, value)),
            None if context.names.role(entry.key).is_none() => {
                context.names.insert_faulty(entry.key, Role::Definition);
            }
            None => {}
        }
    }
    let unexplained = RefCell::default();
    for (entry, value) in in_order(source, written, Role::Definition, &mut context.names) {
        let follows = context.follows.made.definitions.iter().any(|made| made.name == entry.key);
        let source = if follows { Source { faults: &unexplained, ..source } } else { source };
        let value = match value {
            Value::Number(x) => Ok(symbolic::Value::Scalar(context.system.graph.number(x))),
            Value::Expression(text) => context.names.parse_value(source, &context.system.graph, &text),
        };
        match source.note(value) {
            Some(value) => {
                if let Some(e) = value.scalar() {
                    context.system.graph.give_name(e, entry.key);
                }
                context.names.define(entry.key, value);
            }
            None => context.names.insert_faulty(entry.key, Role::Definition),
        }
    }
    followed::explain(context, unexplained.into_inner())
}

fn read_system(context: &mut Context) -> Result<(), SceneError> {
    let source = context.source;
    let section = context.root.require("system", "a table with the Lagrangian and the constraints")?.section()?;
    section.check_keys(format::SYSTEM);
    let lagrangian = section.require("lagrangian", "an expression in quotes");
    let lagrangian = lagrangian.and_then(|entry| context.parse(&entry.text("an expression in quotes")?));
    if let Some(lagrangian) = source.note(lagrangian) {
        context.system.lagrangian = lagrangian;
    }
    source.note(constraints(context, &section));
    if let Some(entry) = section.get("virtual") {
        source.note(virtual_conditions(context, &entry));
    }
    let Some(forces) = section.section("forces")? else { return followed::works(context) };
    let known: Vec<String> = context.system.coordinates.iter().map(|c| c.name.clone()).collect();
    for entry in forces.entries() {
        let place = known.iter().position(|name| name == entry.key);
        let force = place.ok_or_else(|| entry.unknown_name("coordinate", &known)).and_then(|i| {
            let force = context.written(&entry)?;
            Ok((i, force))
        });
        if let Some((i, force)) = source.note(force) {
            context.system.forces[i] = force;
        }
    }
    followed::works(context)
}

/// What the user wants to see: a vector by its components. Positions that are to stay where they are as well.
fn watched(context: &mut Context, section: &str, constancy: Constancy) -> Result<(), SceneError> {
    if constancy == Constancy::Expected {
        for (number, _, g) in &context.on_positions {
            let name = format!("constraint {number} on positions");
            context.system.watched.push(Watched { name, expression: *g, constancy: Constancy::Certain });
        }
    }
    let Some(section) = context.root.section(section)? else { return Ok(()) };
    for entry in section.entries() {
        if entry.key.starts_with(['=', '+', '-', '@']) || entry.key.contains(char::is_control) {
            let kind = SceneErrorKind::InvalidName { name: entry.key.into(), fault: NameFault::Formula };
            return Err(context.source.error(&entry.key_span, kind));
        }
        let read = entry.text("an expression in quotes");
        let read = read.and_then(|text| context.names.parse_value(context.source, &context.system.graph, &text));
        let Some(value) = context.source.note(read) else { continue };
        for (i, &expression) in value.entries().iter().enumerate() {
            let name = match &value {
                symbolic::Value::Scalar(_) => entry.key.to_string(),
                symbolic::Value::Vector(_) if i < 3 => format!("{}.{}", entry.key, &"xyz"[i..=i]),
                _ => format!("{} {}", entry.key, i + 1),
            };
            context.system.watched.push(Watched { name, expression, constancy });
        }
    }
    Ok(())
}

/// Each element is a constraint, or a vector of them. One on positions is kept as its time derivative.
fn constraints(context: &mut Context, section: &Section) -> Result<(), SceneError> {
    let source = context.source;
    let (mut constraints, mut on_positions) = (Vec::new(), Vec::new());
    let entry = section.get("constraints");
    let elements = entry.as_ref().map(|entry| entry.elements("an array of expressions")).transpose()?;
    for (index, element) in elements.iter().flatten().enumerate() {
        let read = element.text("an expression in quotes");
        let read = read.and_then(|text| context.names.parse_value(source, &context.system.graph, &text));
        let read = source.note(read);
        let components = read.as_ref().map_or(&[][..], |value| value.entries());
        // components of a vector that are 0 = 0 whatever moves say nothing
        for f in components.iter().filter(|f| components.len() == 1 || !context.system.graph.is_zero(**f)) {
            let system = &context.system;
            let g = &system.graph;
            let depends = |symbols: Vec<Symbol>| symbols.into_iter().any(|s| g.depends_on(*f, s));
            context.places.push(element.span.clone());
            if depends(system.velocities()) {
                constraints.push(*f);
            } else if depends(system.positions()) {
                on_positions.push((constraints.len(), *f));
                constraints.push(g.total_derivative(*f, &system.flow()));
                context.on_positions.push((constraints.len(), element.span.clone(), *f));
            } else {
                source.note::<()>(Err(element.error(SceneErrorKind::NoVelocity { number: index + 1 })));
            }
        }
    }
    followed::rows(context, &mut constraints, &mut on_positions);
    context.system.constraints = constraints;
    context.system.on_positions = on_positions;
    Ok(())
}

/// What virtual displacements satisfy, as many conditions as constraints; each element one, or a vector of
/// them.
fn virtual_conditions(context: &mut Context, entry: &Entry) -> Result<(), SceneError> {
    let source = context.source;
    let mut conditions = Vec::new();
    for (index, element) in entry.elements("an array of expressions")?.iter().enumerate() {
        let text = element.text("an expression in quotes")?;
        for &w in context.names.parse_value(source, &context.system.graph, &text)?.entries() {
            let (g, velocities) = (&context.system.graph, context.system.velocities());
            if !velocities.into_iter().any(|s| g.depends_on(w, s)) {
                source.note::<()>(Err(element.error(SceneErrorKind::NoRate { number: index + 1 })));
            }
            conditions.push(w);
        }
    }
    let (found, expected) = (conditions.len(), context.system.constraints.len());
    if found != expected {
        return Err(entry.error_at_key(SceneErrorKind::VirtualConditions { found, expected }));
    }
    context.system.virtual_conditions = conditions;
    Ok(())
}

fn start_time(context: &mut Context) -> Result<f64, SceneError> {
    let start = context.root.section("start")?;
    let given = match start.and_then(|s| s.get("time")) {
        Some(entry) => {
            context.constant(&entry)?;
            entry.value()?
        }
        None => Value::Number(0.0),
    };
    let value = context.overrides.written("time").unwrap_or(given);
    if let Value::Expression(text) = &value {
        let written = (context.system.time, unrounded(&context.system.graph, context.parse(text)?));
        context.written.push(written);
    }
    context.evaluate(&value, "time", &context.system.parameter_values(), "parameters")
}

fn positions(context: &mut Context, coordinates: &Section) -> Result<(), SceneError> {
    let mut values = context.constants();
    let (mut missing, mut guesses) = (Vec::new(), Vec::new());
    for (i, (entry, symbol)) in coordinates.entries().zip(context.system.positions()).enumerate() {
        let given = entry.section().ok().filter(|section| section.get("start").is_none());
        if let Some(section) = given.filter(|_| !context.system.on_positions.is_empty())
            && context.overrides.written(entry.key).is_none()
        {
            missing.push((i, entry.clone()));
            guesses.extend(section.get("guess").and_then(|guess| context.source.note(guess.number())).map(|x| (i, x)));
            context.positions.push(0.0);
            continue;
        }
        let read = || -> Result<_, SceneError> {
            let start = entry.section()?;
            let start = start.require("start", "a number, or an expression in parameters and earlier coordinates")?;
            let known = "parameters, t and the coordinates above";
            let value = start.value()?;
            let value = context.overrides.written(entry.key).unwrap_or(value);
            Ok((context.evaluate(&value, &start.path, &values, known)?, context.expression(&value)?))
        };
        let (x, written) = match read() {
            Ok(read) => read,
            Err(fault) => {
                // what is no number for the sake of another fault is none of its own
                let follows = context.positions.iter().any(|x| x.is_nan());
                if !(follows && matches!(*fault.kind, SceneErrorKind::NotFinite { .. })) {
                    context.source.note::<()>(Err(fault));
                }
                (f64::NAN, context.system.graph.zero())
            }
        };
        values.insert(symbol, x);
        context.positions.push(x);
        context.written.push((symbol, written));
    }
    match missing.first() {
        Some((_, first)) if context.positions.iter().all(|x| x.is_finite()) => {
            let places: Vec<usize> = missing.iter().map(|(i, _)| *i).collect();
            supply_positions(context, first, &places, &guesses)
        }
        _ => Ok(()),
    }
}

/// Coordinates without a start, from the constraints on positions.
fn supply_positions(
    context: &mut Context,
    entry: &Entry,
    places: &[usize],
    guesses: &[(usize, f64)],
) -> Result<(), SceneError> {
    guesses.iter().for_each(|&(i, x)| context.positions[i] = x);
    let configurations = Configurations::new(&context.system, &[], places);
    let configurations = configurations.map_err(|error| entry.error(SceneErrorKind::Start(error.into())));
    let found = configurations?.all(context.time, &context.positions);
    let chosen = match &found[..] {
        [one] => one,
        [nearest, ..] if !guesses.is_empty() => nearest,
        _ => {
            let names = places.iter().map(|&i| context.system.coordinates[i].name.clone()).collect();
            return Err(entry.error_at_key(SceneErrorKind::Configurations { names, found }));
        }
    };
    for (&i, &x) in places.iter().zip(chosen) {
        context.positions[i] = x;
        context.written.push((context.system.positions()[i], context.system.graph.number(x)));
        context.found.starts.push((context.system.coordinates[i].name.clone(), x));
    }
    context.configured = places.to_vec();
    Ok(())
}
