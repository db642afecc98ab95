//! The schema of scene files for editors, from the reader's own table.

use scene::format::{CONSTANTS, Content, Key, REMOVAL, SCENE};
use serde_json::{Map, Value, json};

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
