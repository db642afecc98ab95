//! What is said of one motion beside it: its integrals, and its derivatives by the numbers that can be set.

use deltaq::{Choice, SolveError, sensitivities, setting};
use integrals::{Integrals, NEAR};
use serde_json::{Value, json};

use crate::controls;
use crate::question::{Question, Refused};
use crate::run::settings;
use crate::subject::Subject;

/// The answers of `deltaq integrals` about the first motion, up to the degree that is asked for.
pub(crate) fn integrals(subject: &Subject, question: &Question) -> Result<Value, Refused> {
    let Subject { scene, choices } = subject;
    let Some(choice) = choices.first() else {
        return Ok(json!({ "refused": "no motion is shown" }));
    };
    let found = Integrals::find(scene, choice, question.degree, &[])?;
    let near = found.reversed.as_ref().map(|_| NEAR);
    Ok(json!({ "label": choice.label, "near": near, "degree": question.degree, "lines": found.lines() }))
}

/// The derivatives of the coordinates at the end of every motion by each number that it depends on.
pub(crate) fn derivatives(subject: &Subject, question: &Question) -> Value {
    let controls = controls::of(subject);
    let motions = subject.choices.iter().map(|choice| match of_motion(subject, choice, &controls, question) {
        Ok(found) => found,
        Err(error) => json!({ "label": choice.label, "refused": error.to_string() }),
    });
    json!({ "motions": motions.collect::<Vec<_>>() })
}

fn of_motion(subject: &Subject, choice: &Choice, controls: &[Value], question: &Question) -> Result<Value, SolveError> {
    let scene = &subject.scene;
    let numbers: Vec<(&str, &str)> = controls.iter().filter_map(|control| number(control, choice)).collect();
    let names: Vec<&str> = numbers.iter().map(|(name, _)| *name).collect();
    let end = setting(scene).end;
    let found = sensitivities(scene, choice, &names, &[end], &settings(question))?;
    let Some((derivatives, errors)) = found.derivatives.first().zip(found.errors.first()) else {
        return Ok(json!({ "label": choice.label, "refused": format!("it does not come to t = {end:?} s") }));
    };
    let rows = numbers.iter().zip(derivatives.iter().zip(errors)).map(|((name, unit), (by, error))| {
        json!({ "name": name, "unit": unit, "by": by.coordinates, "error": error.coordinates })
    });
    Ok(json!({ "label": choice.label, "end": end, "rows": rows.collect::<Vec<_>>() }))
}

/// The name and unit of a number that a motion depends on, apart from the duration and from what a search
/// finds.
fn number<'a>(control: &'a Value, choice: &Choice) -> Option<(&'a str, &'a str)> {
    let text = |key: &str| control[key].as_str();
    let name = match text("kind")? {
        "parameter" | "start" | "velocity" => text("name")?,
        "multiplier" if choice.formulation.starts_multipliers => text("name")?,
        "costate" if text("motion") == Some(&choice.label) && !control["value"].is_null() => {
            text("name")?.split('@').next()?
        }
        _ => return None,
    };
    Some((name, text("unit")?))
}
