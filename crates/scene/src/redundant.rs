//! Constraints that follow from the others are left out.

use super::context::Context;
use crate::{SceneError, SceneErrorKind};

/// Leaves out what [`mechanics::System::independent_constraints`] finds to follow from the rest. What
/// remains has to leave something to move.
pub(super) fn leave_out(context: &mut Context) -> Result<(), SceneError> {
    let values = context.values_at_rest();
    let t = values.get(&context.system.time).copied().unwrap_or(0.0);
    let system = &mut context.system;
    if system.virtual_conditions.is_empty()
        && let Some(kept) = system.independent_constraints(t, &context.positions)
    {
        *system = system.keeping(&kept);
        context.places = kept.iter().map(|&i| context.places[i].clone()).collect();
    }
    let (found, dimension) = (system.constraints.len(), system.dimension());
    if found < dimension || found == 0 {
        return Ok(());
    }
    let kind = SceneErrorKind::TooManyConstraints { found, dimension };
    let entry = context.root.section("system")?.and_then(|section| section.get("constraints"));
    Err(match (entry, context.places.last()) {
        (Some(entry), _) => entry.error_at_key(kind),
        (None, Some(place)) => context.source.error(place, kind),
        (None, None) => SceneError::outside(context.source.file, kind),
    })
}
