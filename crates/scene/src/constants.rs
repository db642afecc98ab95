//! Free constants of the motions: multipliers `μ₀` and memory costates `P(t₀)`.

use super::context::Context;
use super::scene::multiplier_name;
use super::section::Section;
use crate::{SceneError, SceneErrorKind, format};
use mechanics::{ConstantsRule, MemoryVariable};

/// `μ₀`, given one per constraint; zero where the scene says nothing, and of constraints that follow from
/// others.
pub(super) fn multipliers(context: &Context) -> Result<Vec<f64>, SceneError> {
    let (system, numbers) = (&context.system, context.system.constraint_numbers());
    let expected = numbers.len() + system.redundant.len();
    let mut multipliers = vec![0.0; expected];
    if let Some(section) = context.root.section("vakonomic")? {
        section.check_keys(format::VAKONOMIC);
        if let Some(entry) = section.get("multipliers") {
            let elements = entry.elements("an array of numbers, one per constraint")?;
            if elements.len() != expected {
                let (what, found) = ("multipliers", elements.len());
                return Err(entry.error(SceneErrorKind::WrongLength { what, found, expected }));
            }
            multipliers = elements.iter().map(|e| context.constant(e)).collect::<Result<_, _>>()?;
            let of_redundant = |(number, _): &(usize, _)| (*number, multipliers[number - 1]);
            if let Some((number, value)) = system.redundant.iter().map(of_redundant).find(|(_, value)| *value != 0.0) {
                return Err(elements[number - 1].error(SceneErrorKind::RedundantMultiplier { number, value }));
            }
        }
    }
    for (i, multiplier) in multipliers.iter_mut().enumerate() {
        if let Some(value) = context.overrides.get(&multiplier_name(i)) {
            *multiplier = value;
        }
    }
    Ok(numbers.into_iter().map(|number| multipliers[number - 1]).collect())
}

/// `constants` of one removal.
pub(super) fn rule(
    context: &Context,
    removal: &Section,
    memory: &[MemoryVariable],
) -> Result<ConstantsRule, SceneError> {
    let Some(entry) = removal.get("constants") else { return Ok(ConstantsRule::Zero) };
    if entry.value.is_str() {
        let expected = "\"zero\", { horizon = … } or { start = { … } }";
        let found = entry.text(expected)?.text;
        return match found.as_str() {
            "zero" => Ok(ConstantsRule::Zero),
            _ => Err(entry.error(SceneErrorKind::WrongWord { found, expected })),
        };
    }
    let section = entry.section()?;
    section.check_keys(format::CONSTANTS);
    context.source.no_fault()?;
    match (section.get("horizon"), section.section("start")?) {
        (Some(horizon), None) => {
            let value = context.constant(&horizon)?;
            if value <= context.time {
                let (what, limit) = ("the horizon", context.time);
                return Err(horizon.error(SceneErrorKind::OutOfRange { what, value, limit }));
            }
            Ok(ConstantsRule::Natural { horizon: value })
        }
        (None, Some(start)) => given(context, &start, memory),
        (Some(_), Some(start)) => {
            let (found, expected) = ("horizon and start".into(), "either a horizon or a start");
            Err(context.source.error(&start.span, SceneErrorKind::WrongWord { found, expected }))
        }
        (None, None) => {
            let expected = "{ horizon = … } or { start = { … } }";
            Err(entry.error(SceneErrorKind::EmptySection { section: section.title(), expected }))
        }
    }
}

fn given(context: &Context, start: &Section, memory: &[MemoryVariable]) -> Result<ConstantsRule, SceneError> {
    let names: Vec<String> = memory.iter().map(|w| context.system.graph.name(w.symbol)).collect();
    let mut values = vec![0.0; memory.len()];
    for entry in start.entries() {
        match names.iter().position(|name| name == entry.key) {
            Some(i) => values[i] = context.constant(&entry)?,
            None => return Err(entry.unknown_name("memory variable of this removal", &names)),
        }
    }
    Ok(ConstantsRule::Given(values))
}
