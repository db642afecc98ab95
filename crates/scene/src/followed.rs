//! What follows from bodies, read: constraints that say something, forces, and faults where they stand.

use std::collections::HashMap;

use bodies::Written;
use symbolic::{Expr, Vanishing};

use super::context::{Context, unrounded};
use super::machine::Kind;
use super::start::on_position;
use crate::{SceneError, SceneErrorKind};

/// Faults of the user's formulas, before those of what was made of them.
pub(super) fn explain(context: &Context, unexplained: Vec<SceneError>) -> Result<(), SceneError> {
    let (source, g) = (context.source, &context.system.graph);
    let mut found = false;
    for (text, kind) in &context.follows.texts {
        let read = match (context.names.parse_value(source, g, text), kind) {
            (Err(fault), _) => Err(fault),
            (Ok(symbolic::Value::Scalar(_)), Kind::Number | Kind::Any) | (Ok(_), Kind::Any) => Ok(()),
            (Ok(symbolic::Value::Vector(v)), Kind::Vector) if matches!(v.len(), 2 | 3) => Ok(()),
            (Ok(value), _) => {
                let expected = if *kind == Kind::Number { "a number" } else { "a vector of 2 or 3" };
                Err(source.error(&text.place, SceneErrorKind::WrongShape { found: value.shape(), expected }))
            }
        };
        found |= source.note(read).is_none();
    }
    source.faults.borrow_mut().extend(unexplained.into_iter().filter(|_| !found));
    // what comes next is made of the same formulas
    if context.follows.texts.is_empty() { Ok(()) } else { source.no_fault() }
}

/// Constraints that follow, after those that are written: what vanishes identically, and what another says,
/// is not a constraint.
pub(super) fn rows(context: &mut Context, constraints: &mut Vec<Expr>, on_positions: &mut Vec<(usize, Expr)>) {
    let mut known: Vec<(Expr, String)> =
        constraints.iter().enumerate().map(|(i, &f)| (f, format!("constraint {}", i + 1))).collect();
    for row in std::mem::take(&mut context.follows.made.rows) {
        let (source, g, system) = (context.source, &context.system.graph, &context.system);
        let text = Written { text: row.text, place: row.place };
        let Some(f) = source.note(context.names.parse(source, g, &text)) else { continue };
        let height = row.height.map(|height| Written { text: height, place: text.place.clone() });
        let height = height.and_then(|text| source.note(context.names.parse(source, g, &text)));
        let has_velocity = system.velocities().iter().any(|&v| g.depends_on(f, v));
        let rate = if has_velocity { f } else { g.total_derivative(f, &system.flow()) };
        let is_zero = |e: Expr| g.vanishes(e, &HashMap::new()).is_zero();
        if is_zero(rate) || height.is_some_and(|height| is_zero(g.total_derivative(height, &system.flow()))) {
            let position = height.or((!has_velocity).then_some(f));
            let value = position.map(|position| g.vanishes(position, &system.parameter_values()));
            if let Some(Vanishing::No { value, .. }) = value
                && on_position(0, value, &context.positions).is_err()
            {
                let kind = bodies::FaultKind::Off { what: row.says, value };
                source.note::<()>(Err(source.error(&text.place, SceneErrorKind::Bodies(kind))));
            }
            continue;
        }
        let symbols = g.symbols_of(rate);
        let same = |other: Expr| {
            g.symbols_of(other) == symbols && (is_zero(g.sub(rate, other)) || is_zero(g.add(rate, other)))
        };
        if let Some((_, says)) = known.iter().find(|(other, _)| same(*other)) {
            context.found.left_out.push(format!("{}, as {says} says the same", row.says));
            continue;
        }
        constraints.push(rate);
        if let Some(position) = height.or((!has_velocity).then_some(f)) {
            on_positions.push((constraints.len() - 1, position));
            context.on_positions.push((constraints.len(), text.place.clone(), position));
        }
        context.places.push(text.place);
        context.found.constraints.push(text.text);
        known.push((rate, row.says));
    }
    let g = &context.system.graph;
    for slip in std::mem::take(&mut context.follows.made.slips) {
        let text = Written { text: slip.text, place: slip.place };
        let Some(s) = context.source.note(context.names.parse(context.source, g, &text)) else { continue };
        let is_rate = context.system.velocities().iter().any(|&v| g.depends_on(s, v));
        let rate = if is_rate { s } else { g.total_derivative(s, &context.system.flow()) };
        context.found.slips.extend((!g.is_zero(rate)).then_some(rate));
    }
    context.found.says = known.into_iter().map(|(_, says)| says).collect();
}

/// `Qᵢ = F ∂ℓ/∂qᵢ`, beside the forces that are written.
pub(super) fn works(context: &mut Context) -> Result<(), SceneError> {
    let mut touched = vec![false; context.system.dimension()];
    for work in std::mem::take(&mut context.follows.made.works) {
        let read = |text: String| context.parse(&Written { text, place: work.place.clone() });
        let (along, force) = (read(work.along)?, read(work.force)?);
        let g = &context.system.graph;
        let force = unrounded(g, force);
        let arms: Vec<Expr> = context.system.positions().into_iter().map(|q| g.derivative(along, q)).collect();
        let all: Vec<Expr> = arms.iter().map(|&arm| g.mul(force, arm)).collect();
        for (i, force) in all.into_iter().enumerate() {
            let sum = context.system.graph.add(context.system.forces[i], force);
            touched[i] |= !context.system.graph.is_zero(force);
            context.system.forces[i] = sum;
        }
    }
    let (system, g) = (&context.system, &context.system.graph);
    let all = system.coordinates.iter().zip(&system.forces).zip(touched).filter(|(_, touched)| *touched);
    context.found.forces = all.map(|((c, &force), _)| (c.name.clone(), g.plain(force))).collect();
    Ok(())
}
