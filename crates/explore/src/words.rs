//! Equations, and what is decided, in words.

use deltaq::words::{Headline, decisions};
use deltaq::{Comparison, EquationStyle, Extent, derive_at, equations_text, integrability, system_text};
use serde_json::{Value, json};

use crate::question::{Question, Refused};
use crate::run::settings;
use crate::subject::Subject;

/// The system and the equations of every motion, in Markdown with LaTeX.
pub(crate) fn equations(subject: &Subject) -> Result<Value, Refused> {
    let Subject { scene, choices } = subject;
    let motion = |choice: &deltaq::Choice| match derive_at(&scene.system, &scene.start, choice) {
        Ok(equations) => {
            json!({ "label": choice.label, "equations": equations_text(&equations, EquationStyle::Latex) })
        }
        Err(error) => json!({ "label": choice.label, "refused": error.to_string() }),
    };
    let integrability = integrability(scene)?;
    Ok(json!({
        "system": system_text(&scene.system, EquationStyle::Latex),
        "integrability": integrability.to_string(),
        "motions": choices.iter().map(motion).collect::<Vec<_>>(),
    }))
}

/// The verdict, why, how sure that is; and which families have which motions.
pub(crate) fn decision(subject: Subject, question: &Question) -> Result<Value, Refused> {
    let Subject { scene, choices } = subject;
    let settings = settings(question);
    let mut comparison = Comparison::new(scene, Extent::Everything, &settings)?;
    for choice in choices {
        comparison.solve(choice, &settings)?;
    }
    while comparison.decide_next().is_some() {}
    let Headline { verdict, why, sure } = Headline::of(&comparison);
    Ok(json!({ "verdict": verdict, "why": why, "sure": sure, "decisions": decisions(&comparison) }))
}
