//! The schemas of scene files, from the reader's own table, and of answers, from their types.

use anyhow::{Result, bail};
use program::schema_of;
use scene::format::{CONSTANTS, Content, FORMAT, Key, REMOVAL, SCENE};
use serde_json::{Map, Value, json};

/// Those of answers, all of them.
const ANSWERS: [fn() -> Value; 15] = [
    schema_of::<crate::connect_command::Connected>,
    schema_of::<crate::ensemble_command::AllMembers>,
    schema_of::<crate::judge_command::AllJudged>,
    schema_of::<crate::linearize_command::Linearized>,
    schema_of::<crate::prove_command::Proved>,
    schema_of::<crate::show_command::List>,
    schema_of::<crate::show_command::Shown>,
    schema_of::<crate::solve_command::Solved>,
    schema_of::<fit::Designed>,
    schema_of::<fit::Fitted>,
    schema_of::<integrals::Answer>,
    schema_of::<integrals::Certified>,
    schema_of::<integrals::NoMultipliers>,
    schema_of::<pages::Verdicts>,
    schema_of::<review::Reviewed>,
];

/// The schema of the answer of this kind, or the names of all: `urn:deltaq:KIND:VERSION`.
///
/// # Errors
/// A kind that there is not.
pub(crate) fn of_answer(kind: Option<&str>) -> Result<String> {
    let all = ANSWERS.map(|schema| schema());
    let names = all.iter().map(|schema| schema["$id"].as_str().unwrap_or_default());
    let kinds: Vec<&str> = names.filter_map(|name| name.split(':').nth(2)).collect();
    let Some(kind) = kind else { return Ok(kinds.join("\n") + "\n") };
    match all.iter().zip(&kinds).find(|(_, own)| **own == kind) {
        Some((schema, _)) => Ok(format!("{schema:#}\n")),
        None => bail!("there is no answer `{kind}`; known: {}", kinds.join(", ")),
    }
}

/// JSON Schema, draft 2020-12.
pub(crate) fn schema() -> Value {
    let mut schema = json!({ "$schema": "https://json-schema.org/draft/2020-12/schema", "title": "deltaq scene" });
    if let (Value::Object(schema), Value::Object(table)) = (&mut schema, table(SCENE)) {
        schema.extend(table);
    }
    schema
}

fn table(keys: &[Key]) -> Value {
    let property = |key: &Key| {
        let mut schema = content(&key.content);
        schema["description"] = json!(key.about);
        (key.name.to_string(), schema)
    };
    let required: Vec<&str> = keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    json!({
        "type": "object",
        "properties": keys.iter().map(property).collect::<Map<_, _>>(),
        "required": required,
        "additionalProperties": false,
    })
}

fn named(content: Value) -> Value {
    json!({ "type": "object", "additionalProperties": content })
}

fn content(what: &Content) -> Value {
    match what {
        Content::Format => json!({ "type": "integer", "minimum": 1, "maximum": FORMAT }),
        Content::Text => json!({ "type": "string" }),
        Content::Number | Content::Expression | Content::Quantity => json!({ "type": ["number", "string"] }),
        Content::Vector | Content::Moments => json!({ "type": ["array", "string"] }),
        Content::Truth => json!({ "type": "boolean" }),
        Content::List(of) => json!({ "type": "array", "items": content(of) }),
        Content::Table(keys) => table(keys),
        Content::Named(of) => named(content(of)),
        Content::Constants => json!({ "anyOf": [{ "const": "zero" }, table(CONSTANTS)] }),
        Content::Removals => json!({ "anyOf": [table(REMOVAL), named(table(REMOVAL))] }),
    }
}
