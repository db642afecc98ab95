//! What is said of one motion beside it: its integrals, its derivatives by the numbers that can be set, and
//! whether equations are its.

use integrals::Integrals;
use motion::{Choice, sensitivities, setting};
use review::{Asked, Mend, Reviewed, Verdict, mends};
use serde_json::{Value, json};

use crate::controls;
use crate::question::{Question, Refused};
use crate::run::settings;
use crate::subject::Subject;

/// The answers of `deltaq integrals` about the first motion, up to the degree that is asked for.
pub(crate) fn integrals(subject: &Subject, question: &Question) -> Result<Value, Refused> {
    let Subject { scene, choices, .. } = subject;
    let Some(choice) = choices.first() else {
        return Ok(json!({ "refused": "no motion is shown" }));
    };
    let found = Integrals::find(scene, choice, question.degree, &[])?;
    let near = found.where_it_holds();
    Ok(json!({ "label": choice.label, "near": near, "degree": question.degree, "lines": found.lines() }))
}

/// Whether somebody's equations are d'Alembert–Lagrange's; if not, whose they are, and the terms that make
/// them wrong.
pub(crate) fn review(subject: &Subject, question: &Question) -> Result<Value, Refused> {
    let asked = Asked::default();
    let found = review::review(&subject.scene, "yours", &question.theirs, &asked)?;
    let mends =
        if found.verdict == Verdict::Wrong { mends(&subject.scene, &question.theirs, &asked) } else { Vec::new() };
    let mend = |m: &Mend| json!({ "line": m.line, "column": m.column, "length": m.term.chars().count(), "message": format!("`{}` {}", m.term, m.fault) });
    let mut answer = json!(Reviewed { scene: &subject.scene.name, file: "yours", found: &found });
    answer["mends"] = mends.iter().map(mend).collect();
    Ok(answer)
}

/// The derivatives of the coordinates at the end of every motion by each number that it depends on.
pub(crate) fn derivatives(subject: &Subject, question: &Question) -> Value {
    let controls = controls::of(subject);
    let motions = subject.choices.iter().map(|choice| of_motion(subject, choice, &controls, question));
    json!({ "motions": motions.collect::<Vec<_>>() })
}

/// By all numbers at once; if one of them is refused, by each alone: then the others have theirs, and it is
/// said why one has not. A motion that stops on the way does so whatever it is derived by.
fn of_motion(subject: &Subject, choice: &Choice, controls: &[Value], question: &Question) -> Value {
    let numbers: Vec<(&str, &str)> = controls.iter().filter_map(|control| number(control, choice)).collect();
    let end = setting(&subject.scene).end;
    let derived = |numbers: &[(&str, &str)]| rows(subject, choice, numbers, end, question);
    let found = derived(&numbers).unwrap_or_else(|error| {
        let alone: Vec<_> = numbers.iter().map(|number| derived(&[*number]).flatten()).collect();
        if alone.iter().all(Result::is_err) {
            return Err(error);
        }
        let rows = numbers.iter().zip(alone).map(|((name, unit), found)| {
            found.unwrap_or_else(|refused| vec![json!({ "name": name, "unit": unit, "refused": refused })])
        });
        Ok(rows.flatten().collect())
    });
    match found {
        Ok(rows) => json!({ "label": choice.label, "end": end, "rows": rows }),
        Err(refused) => json!({ "label": choice.label, "refused": refused }),
    }
}

/// A row per number, or why the motion has none; an error if a number is refused.
fn rows(
    subject: &Subject,
    choice: &Choice,
    numbers: &[(&str, &str)],
    end: f64,
    question: &Question,
) -> Result<Result<Vec<Value>, String>, String> {
    let names: Vec<&str> = numbers.iter().map(|(name, _)| *name).collect();
    let found = sensitivities(&subject.scene, choice, &names, &[end], &settings(question));
    let found = found.map_err(|error| error.to_string())?;
    if let Some(complaint) = found.complaint() {
        return Ok(Err(complaint));
    }
    let at_end = found.derivatives.into_iter().flatten().zip(found.errors.into_iter().flatten());
    let rows = numbers.iter().zip(at_end).map(|((name, unit), (by, error))| {
        json!({ "name": name, "unit": unit, "by": by.coordinates, "error": error.coordinates })
    });
    Ok(Ok(rows.collect()))
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
