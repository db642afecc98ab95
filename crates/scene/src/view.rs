//! `[view]`: the bodies that are drawn.

use mechanics::{Body, Kind, Shape, State, Touch, View};
use symbolic::limits::NOTHING;
use symbolic::{Evaluator, Expr, Graph, Matrix};

use super::context::Context;
use super::names::check_symbols;
use super::section::{Entry, Section, Value};
use crate::{SceneError, SceneErrorKind, Unavailable, format};

/// All bodies, in a copy of the system's graph: no equation is to depend on what is drawn.
pub(super) fn read(context: &Context) -> Result<View, SceneError> {
    let Some(section) = context.root.section("view")? else { return Ok(View::default()) };
    let names: Vec<String> = section.entries().map(|entry| entry.key.to_string()).collect();
    let mut view = View { graph: context.system.graph.clone(), bodies: Vec::new() };
    for entry in section.entries() {
        if let Some(body) = context.source.note(body(context, &view.graph, &entry, &names)) {
            view.bodies.push(body);
        }
    }
    Ok(view)
}

/// At the start everything is finite, and what rotates is a rotation.
pub(super) fn check(context: &Context, view: &View, start: &State) -> Result<(), SceneError> {
    let Some(section) = context.root.section("view")? else { return Ok(()) };
    for (entry, body) in section.entries().zip(&view.bodies) {
        context.source.note(check_body(context, &entry.section()?, &view.graph, body, start));
    }
    Ok(())
}

fn body(context: &Context, g: &Graph, entry: &Entry, names: &[String]) -> Result<Body, SceneError> {
    let section = entry.section()?;
    section.check_keys(format::BODY);
    let at = match section.get("at") {
        Some(entry) => place(context, g, &entry)?,
        None => [g.zero(); 3],
    };
    let unit = || Matrix::from_fn(3, 3, |i, j| if i == j { g.one() } else { g.zero() });
    let rotation = section.get("rotation").map_or_else(|| Ok(unit()), |entry| rotation(context, g, &entry))?;
    let mut touches = Vec::new();
    if let Some(section) = section.section("touches")? {
        for entry in section.entries() {
            let body = names.iter().position(|name| name == entry.key);
            let body = body.ok_or_else(|| entry.unknown_name("body in [view]", names))?;
            touches.push(Touch { body, at: place(context, g, &entry)? });
        }
    }
    Ok(Body { name: entry.key.into(), shape: shape(context, &section)?, at, rotation, touches })
}

fn shape(context: &Context, section: &Section) -> Result<Shape, SceneError> {
    let word = section.require("shape", format::SHAPES)?;
    let found = word.text(format::SHAPES)?.text;
    let Some(&(kind, _, sizes)) = Kind::ALL.iter().find(|(_, word, _)| *word == found) else {
        return Err(word.error(SceneErrorKind::WrongWord { found, expected: format::SHAPES }));
    };
    let list = section.require("size", "a list of numbers, or expressions in parameters")?;
    let elements = list.elements("a list of numbers, or expressions in parameters")?;
    if elements.len() != sizes.len() {
        let (sizes, found) = (sizes.join(", "), elements.len());
        return Err(list.error(SceneErrorKind::WrongSizes { word: kind.word(), sizes, found }));
    }
    // a motion with a parameter below zero is not refused for its picture
    let length = |element: &Entry| context.constant(element).map(f64::abs);
    Ok(Shape { kind, size: elements.iter().map(length).collect::<Result<_, _>>()? })
}

/// A vector of three numbers, or of two in the plane z = 0.
fn place(context: &Context, g: &Graph, entry: &Entry) -> Result<[Expr; 3], SceneError> {
    let value = value(context, g, entry, "a vector in quotes")?;
    match value {
        symbolic::Value::Vector(ref v) if v.len() == 3 => Ok([v[0], v[1], v[2]]),
        symbolic::Value::Vector(ref v) if v.len() == 2 => Ok([v[0], v[1], g.zero()]),
        other => Err(wrong(entry, &other, "a vector of 2 or 3")),
    }
}

/// A matrix, or an angle about the z axis.
fn rotation(context: &Context, g: &Graph, entry: &Entry) -> Result<Matrix, SceneError> {
    let value = value(context, g, entry, "a matrix or an angle in quotes")?;
    match value {
        symbolic::Value::Matrix(ref m, _) if (m.rows(), m.columns()) == (3, 3) => Ok(m.clone()),
        symbolic::Value::Scalar(angle) => {
            let [cos, sin] = [symbolic::Function::Cos, symbolic::Function::Sin].map(|f| g.call(f, angle));
            let (zero, one) = (g.zero(), g.one());
            Ok(Matrix::new(3, 3, vec![cos, g.neg(sin), zero, sin, cos, zero, zero, zero, one]))
        }
        other => Err(wrong(entry, &other, "a matrix of 3 by 3 or an angle")),
    }
}

fn wrong(entry: &Entry, value: &symbolic::Value, expected: &'static str) -> SceneError {
    entry.error(SceneErrorKind::WrongShape { found: value.shape(), expected })
}

/// An expression without velocities.
fn value(context: &Context, g: &Graph, entry: &Entry, expected: &'static str) -> Result<symbolic::Value, SceneError> {
    let text = match entry.value()? {
        Value::Number(x) => return Ok(symbolic::Value::Scalar(g.number(x))),
        Value::Expression(_) => entry.text(expected)?,
    };
    let value = context.names.parse_value(context.source, g, &text)?;
    let velocities = context.system.velocities();
    for &e in value.entries() {
        check_symbols(context.source, g, &text, e, |s| velocities.contains(&s).then_some(Unavailable::Velocity))?;
    }
    Ok(value)
}

fn check_body(context: &Context, section: &Section, g: &Graph, body: &Body, start: &State) -> Result<(), SceneError> {
    let blame = |key: &str, kind| {
        let span = section.get(key).map_or(section.span.clone(), |entry| entry.span);
        section.source.error(&span, kind)
    };
    let system = &context.system;
    let inputs = [&[system.time], &system.positions()[..]].concat();
    let values = |key: &str, expressions: &[Expr]| {
        let tape = g.compile(&inputs, expressions, &system.parameter_values());
        let tape = tape.map_err(|error| blame(key, SceneErrorKind::Start(error.into())))?;
        let values = Evaluator::<f64>::new(tape).evaluate(&[&[start.t], &start.q[..]].concat()).to_vec();
        let what = || format!("{}.{key} at the start", section.path);
        match values.iter().find(|x| !x.is_finite()) {
            Some(&value) => Err(blame(key, SceneErrorKind::NotFinite { what: what(), value })),
            None => Ok(values),
        }
    };
    values("at", &body.at)?;
    values("touches", &body.touches.iter().flat_map(|touch| touch.at).collect::<Vec<_>>())?;
    let r = values("rotation", body.rotation.entries())?;
    let r = [0, 3, 6].map(|i| [r[i], r[i + 1], r[i + 2]]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let off = |i: usize, j: usize| (dot(&r[i], &r[j]) - f64::from(u8::from(i == j))).abs();
    let residual = (0..9).map(|k| off(k / 3, k % 3)).fold(0.0, f64::max);
    let cross = [0, 1, 2].map(|i| r[0][(i + 1) % 3] * r[1][(i + 2) % 3] - r[0][(i + 2) % 3] * r[1][(i + 1) % 3]);
    let determinant = dot(&cross, &r[2]);
    if residual > NOTHING || determinant < 0.0 {
        return Err(blame("rotation", SceneErrorKind::NoRotation { residual, limit: NOTHING, determinant }));
    }
    Ok(())
}
