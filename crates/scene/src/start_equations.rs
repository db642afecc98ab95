//! `[start]`: `equations`.

use std::ops::Range;

use bodies::Written;
use symbolic::Expr;

use super::context::Context;
use super::section::Entry;
use crate::{SceneError, SceneErrorKind};

/// `left − right` of each equation, a vector by its components, and where it stands. Without `=` it is what
/// has to be zero.
pub(super) fn read(context: &Context, entry: &Entry) -> Result<Vec<(Expr, Range<usize>)>, SceneError> {
    let mut equations = Vec::new();
    for (i, element) in entry.elements("an array of equations")?.iter().enumerate() {
        let Some(mut components) = context.source.note(sides(context, element)) else { continue };
        let (g, velocities) = (&context.system.graph, context.system.velocities());
        components.retain(|&e| !g.is_zero(e));
        if components.is_empty() || !components.iter().all(|&e| velocities.iter().any(|&s| g.depends_on(e, s))) {
            let kind = SceneErrorKind::StartAtRest { number: i + 1 };
            context.source.note::<()>(Err(element.error(kind)));
        }
        equations.extend(components.into_iter().map(|e| (e, element.span.clone())));
    }
    context.source.no_fault()?;
    Ok(equations)
}

fn sides(context: &Context, element: &Entry) -> Result<Vec<Expr>, SceneError> {
    let Written { text, place } = element.text("an equation in quotes")?;
    let g = &context.system.graph;
    let side = |text: &str| {
        let text = Written { text: text.into(), place: place.clone() };
        context.names.parse_value(context.source, g, &text).map(|value| value.entries().to_vec())
    };
    let Some((left, right)) = text.split_once('=') else { return side(&text) };
    let (left, mut right) = (side(left)?, side(right)?);
    if right.len() == 1 && g.is_zero(right[0]) {
        right = vec![g.zero(); left.len()];
    }
    if left.len() != right.len() {
        return Err(element.error(SceneErrorKind::UnequalSides { left: left.len(), right: right.len() }));
    }
    Ok(left.into_iter().zip(right).map(|(left, right)| g.sub(left, right)).collect())
}
