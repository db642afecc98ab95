//! From questions to answers.

use scene::{Scene, SceneError};
use serde_json::{Value, json};

use crate::cache::Cache;
use crate::question::{Answer, Ask, Question, Refused};
use crate::subject::Subject;
use crate::{controls, further, motions, words};

/// Answers questions; the same ones in the same way, whatever was asked before, but for how near motions at a
/// glance come.
#[derive(Default)]
pub struct Explorer {
    kept: Cache,
}

impl Explorer {
    /// Answers a [`Question`] in JSON.
    pub fn answer(&mut self, question: &str) -> Answer {
        let mut numbers = Vec::new();
        let value = match answered(question, &mut self.kept, &mut numbers) {
            Ok(value) => value,
            Err(Refused::Faulty(error)) => json!({ "faults": faults(&error), "message": error.to_string() }),
            Err(error) => json!({ "refused": error.to_string() }),
        };
        Answer { text: value.to_string(), numbers }
    }
}

fn answered(question: &str, kept: &mut Cache, numbers: &mut Vec<f64>) -> Result<Value, Refused> {
    let question: Question = serde_json::from_str(question)?;
    let subject = Subject::of(&question)?;
    match question.ask {
        Ask::Scene => Ok(scene(&subject)),
        Ask::Motions => motions::sampled(&subject, &question, kept, numbers),
        Ask::Equations => words::equations(&subject),
        Ask::Check => Ok(json!({ "remarks": remarks(&question)? })),
        Ask::Review => Ok(further::review(&subject, &question)?),
        Ask::Text => Ok(json!({ "text": subject.scene.to_toml() })),
        Ask::Integrals => further::integrals(&subject, &question),
        Ask::Derivatives => Ok(further::derivatives(&subject, &question)),
        Ask::Decision => words::decision(subject, &question),
    }
}

/// What a page has to know of a scene before there are motions.
fn scene(subject: &Subject) -> Value {
    let Subject { scene, choices, unknown } = subject;
    let coordinate = |c: &mechanics::Coordinate| json!({ "name": c.name, "unit": c.unit });
    let motion = |c: &motion::Choice| json!({ "label": c.label, "formulation": c.formulation.name });
    json!({
        "title": scene.title, "source": scene.source, "notes": scene.notes,
        "start": scene.start.t, "duration": scene.duration,
        "coordinates": scene.system.coordinates.iter().map(coordinate).collect::<Vec<_>>(),
        "controls": controls::of(subject),
        "motions": choices.iter().map(motion).collect::<Vec<_>>(),
        "unknown": unknown,
    })
}

/// All faults of a text, with their places.
fn faults(error: &SceneError) -> Value {
    std::iter::once(error).chain(&error.also).map(fault).collect()
}

fn fault(e: &SceneError) -> Value {
    json!({ "line": e.line, "column": e.column, "length": e.length, "message": e.kind.to_string() })
}

/// Notes on a text without faults, with their places.
fn remarks(question: &Question) -> Result<Value, SceneError> {
    let set: &[(String, f64)] = &[];
    Ok(Scene::remarks(&question.name, &question.text, set)?.1.iter().map(fault).collect())
}
