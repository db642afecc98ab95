//! `[start]`: given velocities, and what the constraints make of them.

use std::cmp::Ordering;
use std::collections::HashMap;

use symbolic::{Expr, Symbol};

use super::context::Context;
use super::section::Section;
use super::start_equations;
use crate::{SceneError, SceneErrorKind, format};
use mechanics::{Completion, Quantity, Removal, StartData, StartError, State, System, complete_start};

/// The start state of the scene.
pub(super) fn complete(context: &Context, removals: &[Removal]) -> Result<(State, Completion), SceneError> {
    let start = context.root.section("start")?;
    let mut project = false;
    let mut given = Vec::new();
    let mut written = context.written.clone();
    let (mut guess, mut guessed) = (Vec::new(), Vec::new());
    let mut equations = Vec::new();
    // what follows from bodies stands there
    let of = |key: &str| context.root.get(key).map(|e| e.key_span).filter(|span| !span.is_empty());
    let mut place = of("system").or_else(|| of("body")).unwrap_or(0..0);
    if let Some(start) = &start {
        place = start.span.clone();
        start.check_keys(format::START);
        project = start.get("project").map_or(Ok(false), |e| e.boolean())?;
        if let Some(velocities) = start.section("velocities")? {
            place = velocities.span.clone();
            given = rates(context, &velocities, removals.first())?;
            written.extend(expressions(context, &velocities, &given)?);
        }
        if let Some(section) = start.section("guess")? {
            guess = rates(context, &section, removals.first())?;
            guessed = expressions(context, &section, &guess)?;
        }
        if let Some(entry) = start.get("equations") {
            equations = start_equations::read(context, &entry)?;
        }
    }
    let (equations, places): (Vec<Expr>, Vec<_>) = equations.into_iter().unzip();
    for (name, symbol) in rate_names(&context.system, removals.first()) {
        if let Some(value) = context.overrides.written(&name) {
            given.retain(|(s, _)| *s != symbol);
            given.push((symbol, context.evaluate(&value, &name, &context.values_at_rest(), "numbers")?));
            written.retain(|(s, _)| *s != symbol);
            written.push((symbol, context.expression(&value)?));
        }
    }
    let data = StartData {
        time: context.time,
        positions: context.positions.clone(),
        given: given.into_iter().collect::<HashMap<_, _>>(),
        guess: guess.into_iter().collect::<HashMap<_, _>>(),
        equations,
        project,
        removal: removals.first(),
    };
    let completed = complete_start(&context.system, &data).map_err(|error| {
        let place = match &error {
            StartError::ContradictoryEquation { equation, .. } => Some(places[equation - 1].clone()),
            StartError::ProjectedEquations => start.as_ref().and_then(|s| s.get("project")).map(|e| e.key_span),
            error => blamed(context, error).filter(|place| !place.is_empty()).or_else(|| of("body")),
        }
        .unwrap_or(place);
        context.source.error(&place, SceneErrorKind::Start(error))
    });
    completed.map(|(state, completion)| {
        (state, Completion { written, guessed, configured: context.configured.clone(), ..completion })
    })
}

/// Constraints on positions must hold at the start, within `1e-9` of the size of the coordinates.
pub(super) fn check_positions(context: &Context) -> Result<(), SceneError> {
    let values = context.values_at_rest();
    for (number, place, g) in &context.on_positions {
        let residual = context.system.graph.evaluate(*g, &values).unwrap_or(f64::NAN);
        let on = on_position(*number, residual, &context.positions);
        context.source.note(on.map_err(|kind| context.source.error(place, kind)));
    }
    context.source.no_fault()
}

/// Whether positions are on the constraint of this number.
pub(super) fn on_position(number: usize, residual: f64, positions: &[f64]) -> Result<(), SceneErrorKind> {
    let limit = 1e-9 * positions.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    match residual.abs().partial_cmp(&limit) {
        Some(Ordering::Less | Ordering::Equal) => Ok(()),
        // NaN is off, too
        _ => Err(SceneErrorKind::OffPosition { number, residual: residual.abs(), limit }),
    }
}

/// Velocities of the coordinates, and rates of the first removal's own parameters.
pub(super) fn rate_names(system: &System, removal: Option<&Removal>) -> Vec<(String, Symbol)> {
    let own = removal.iter().flat_map(|r| &r.parameters).filter(|u| u.coordinate.is_none()).map(|u| u.rate);
    let symbols = system.velocities().into_iter().chain(own);
    symbols.map(|s| (system.graph.name(s), s)).collect()
}

/// What stands in a section, as it is written, with the symbols that [`rates`] has found for it.
fn expressions(
    context: &Context,
    section: &Section,
    rates: &[(Symbol, f64)],
) -> Result<Vec<(Symbol, Expr)>, SceneError> {
    section.entries().zip(rates).map(|(entry, (symbol, _))| Ok((*symbol, context.written(&entry)?))).collect()
}

fn rates(context: &Context, section: &Section, removal: Option<&Removal>) -> Result<Vec<(Symbol, f64)>, SceneError> {
    let names = rate_names(&context.system, removal);
    let values = context.values_at_rest();
    let mut rates = Vec::new();
    for entry in section.entries() {
        let Some((_, symbol)) = names.iter().find(|(name, _)| name == entry.key) else {
            let known: Vec<String> = names.into_iter().map(|n| n.0).collect();
            let expected = "velocity of a coordinate, nor rate of a parameter of the first removal; as in \"x'\" = 1";
            return Err(entry.unknown_name(expected, &known));
        };
        let known = "parameters, coordinates and t";
        rates.push((*symbol, context.evaluate(&entry.value()?, &entry.path, &values, known)?));
    }
    Ok(rates)
}

/// Where the fault is, if not among the velocities.
fn blamed(context: &Context, error: &StartError) -> Option<std::ops::Range<usize>> {
    let system = context.root.get("system")?.section().ok()?;
    let key = |key: &str| system.get(key).map(|e| e.key_span);
    let constraint = |number: usize| context.places.get(number - 1).cloned();
    match error {
        StartError::DependentConstraints { .. } => key("constraints"),
        StartError::SingularMassMatrix { .. } => key("lagrangian"),
        StartError::NotFinite { quantity, .. } => match quantity {
            Quantity::Lagrangian | Quantity::MassMatrix => key("lagrangian"),
            Quantity::ConstraintJacobian => key("constraints"),
            Quantity::Constraint(number) => constraint(*number),
            Quantity::Force(name) => system.section("forces").ok()??.get(name).map(|e| e.span),
        },
        _ => None,
    }
}
