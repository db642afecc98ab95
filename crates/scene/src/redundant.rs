//! Constraints that follow from the others are left out.

use super::context::Context;
use crate::{SceneError, SceneErrorKind};

/// Leaves out what [`mechanics::System::independent_constraints`] finds to follow from the rest; its multiplier is
/// zero. What remains has to leave something to move.
pub(super) fn leave_out(context: &mut Context, multipliers: &mut Vec<f64>) -> Result<(), SceneError> {
    let values = context.values_at_rest();
    let t = values.get(&context.system.time).copied().unwrap_or(0.0);
    let kept = match context.system.virtual_conditions.is_empty() {
        true => context.system.independent_constraints(t, &context.positions),
        false => None,
    };
    let system = &mut context.system;
    if let Some(kept) = kept {
        for (i, &value) in multipliers.iter().enumerate().filter(|(i, value)| !kept.contains(i) && **value != 0.0) {
            let kind = SceneErrorKind::RedundantMultiplier { number: i + 1, value };
            return Err(SceneError::outside(context.source.file, kind));
        }
        *system = system.keeping(&kept);
        context.places = kept.iter().map(|&i| context.places[i].clone()).collect();
        *multipliers = kept.iter().map(|&i| multipliers[i]).collect();
    }
    let (found, dimension) = (system.constraints.len(), system.dimension());
    if found < dimension {
        return Ok(());
    }
    let kind = SceneErrorKind::TooManyConstraints { found, dimension };
    let entry = context.root.section("system")?.and_then(|section| section.get("constraints"));
    Err(match entry {
        Some(entry) => entry.error_at_key(kind),
        None => SceneError::outside(context.source.file, kind),
    })
}
