//! Parameters, coordinates, definitions and `[system]`.

use symbolic::{Expr, Graph};

use super::context::Context;
use super::names::{Names, Role};
use super::overrides::Overrides;
use super::section::{Entry, Section, Source};
use crate::{SceneError, SceneErrorKind};
use mechanics::{Parameter, System};

/// The parameter that can be set in a scene that does not name it.
const KAPPA: &str = "kappa";

/// Reads everything that makes the system, and the positions at the start.
pub(super) fn build<'a>(
    source: Source<'a>,
    root: Section<'a>,
    overrides: Overrides,
) -> Result<Context<'a>, SceneError> {
    let graph = Graph::new();
    let mut names = Names::default();
    let parameters = parameters(source, &root, &overrides, &graph, &mut names)?;
    let coordinates = root.require("coordinates", "a table with one entry a coordinate")?.section()?;
    if coordinates.is_empty() {
        let (section, expected) =
            (coordinates.title(), "at least one coordinate, as in x = { unit = \"m\", start = 0 }");
        return Err(source.error(&coordinates.span, SceneErrorKind::EmptySection { section, expected }));
    }
    let mut units = Vec::new();
    for entry in coordinates.entries() {
        names.check(source, &graph, entry.key, &entry.key_span)?;
        let section = entry.section()?;
        section.check_keys(&["unit", "start"])?;
        units.push((entry.key, section.text_or_empty("unit")?));
        let q = graph.variable(graph.symbol(entry.key));
        let v = graph.variable(graph.symbol(&format!("{}'", entry.key)));
        names.insert(entry.key, Role::Coordinate, q, &[v]);
    }
    let units: Vec<(&str, &str)> = units.iter().map(|(name, unit)| (*name, unit.as_str())).collect();
    let system = System::new(graph, &units);
    names.insert("t", Role::Time, system.graph.variable(system.time), &[]);
    let mut context =
        Context { source, root, overrides, names, system, positions: Vec::new(), written: Vec::new(), time: 0.0 };
    context.system.parameters = parameters;
    definitions(&mut context)?;
    read_system(&mut context)?;
    context.time = start_time(&context)?;
    positions(&mut context, &coordinates)?;
    Ok(context)
}

fn parameters(
    source: Source,
    root: &Section,
    overrides: &Overrides,
    graph: &Graph,
    names: &mut Names,
) -> Result<Vec<Parameter>, SceneError> {
    let mut parameters = Vec::new();
    let section = root.section("parameters")?;
    for entry in section.iter().flat_map(Section::entries) {
        names.check(source, graph, entry.key, &entry.key_span)?;
        let given = entry.number()?;
        let symbol = graph.symbol(entry.key);
        parameters.push(Parameter { symbol, value: overrides.get(entry.key).unwrap_or(given) });
        names.insert(entry.key, Role::Parameter, graph.variable(symbol), &[]);
    }
    // a number of the family between, which is no part of the system: any scene takes it
    if let Some(value) = overrides.get(KAPPA) {
        let symbol = graph.symbol(KAPPA);
        parameters.push(Parameter { symbol, value });
        names.insert(KAPPA, Role::Parameter, graph.variable(symbol), &[]);
    }
    Ok(parameters)
}

fn definitions(context: &mut Context) -> Result<(), SceneError> {
    let Some(section) = context.root.section("definitions")? else { return Ok(()) };
    for entry in section.entries() {
        context.names.check(context.source, &context.system.graph, entry.key, &entry.key_span)?;
        let e = context.written(&entry)?;
        context.names.insert(entry.key, Role::Definition, e, &[]);
    }
    Ok(())
}

fn read_system(context: &mut Context) -> Result<(), SceneError> {
    let section = context.root.require("system", "a table with the Lagrangian and the constraints")?.section()?;
    section.check_keys(&["lagrangian", "constraints", "forces"])?;
    let lagrangian = section.require("lagrangian", "an expression in quotes")?;
    context.system.lagrangian = context.parse(&lagrangian.text("an expression in quotes")?)?;
    if let Some(entry) = section.get("constraints") {
        context.system.constraints = constraints(context, &entry)?;
    }
    if let Some(forces) = section.section("forces")? {
        let known: Vec<String> = context.system.coordinates.iter().map(|c| c.name.clone()).collect();
        for entry in forces.entries() {
            let Some(i) = known.iter().position(|name| name == entry.key) else {
                return Err(entry.unknown_name("coordinate", &known));
            };
            context.system.forces[i] = context.written(&entry)?;
        }
    }
    Ok(())
}

fn constraints(context: &Context, entry: &Entry) -> Result<Vec<Expr>, SceneError> {
    let (system, g) = (&context.system, &context.system.graph);
    let elements = entry.elements("an array of expressions")?;
    let (found, dimension) = (elements.len(), system.dimension());
    if found >= dimension {
        return Err(entry.error_at_key(SceneErrorKind::TooManyConstraints { found, dimension }));
    }
    let velocities = system.velocities();
    let mut constraints = Vec::new();
    for (index, element) in elements.iter().enumerate() {
        let f = context.parse(&element.text("an expression in quotes")?)?;
        if !velocities.iter().any(|&v| g.depends_on(f, v)) {
            let depends = system.positions().into_iter().any(|q| g.depends_on(f, q));
            let derivative = depends.then(|| shortened(g.plain(g.total_derivative(f, &system.flow()))));
            return Err(element.error(SceneErrorKind::NoVelocity { number: index + 1, derivative }));
        }
        constraints.push(f);
    }
    Ok(constraints)
}

fn shortened(text: String) -> String {
    const LONGEST: usize = 200;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

fn start_time(context: &Context) -> Result<f64, SceneError> {
    let start = context.root.section("start")?;
    let given = match start.and_then(|s| s.get("time")) {
        Some(entry) => entry.number()?,
        None => 0.0,
    };
    Ok(context.overrides.get("time").unwrap_or(given))
}

fn positions(context: &mut Context, coordinates: &Section) -> Result<(), SceneError> {
    let mut values = context.constants();
    for (entry, symbol) in coordinates.entries().zip(context.system.positions()) {
        let start = entry.section()?;
        let start = start.require("start", "a number, or an expression in parameters and earlier coordinates")?;
        let known = "parameters, t and the coordinates above";
        let value = start.value()?;
        let (x, written) = match context.overrides.get(entry.key) {
            Some(x) => (x, context.system.graph.number(x)),
            None => (context.evaluate(&value, &start.path, &values, known)?, context.written(&start)?),
        };
        values.insert(symbol, x);
        context.positions.push(x);
        context.written.push((symbol, written));
    }
    Ok(())
}
