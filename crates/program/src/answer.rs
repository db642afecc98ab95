//! Output of a command.

use std::borrow::Cow;
use std::fmt::{self, Display, Formatter};
use std::io::{ErrorKind, Write, stderr, stdout};

use anyhow::{Context, Result};
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use serde_json::{Value, json};

/// How a command ended: the text to print, and whether it can be trusted.
#[derive(Default)]
pub struct Answer {
    /// For standard output.
    pub text: String,
    /// Why it cannot be trusted, for standard error.
    pub complaint: Option<String>,
    /// Whether the answer is no, to a question that a script asks.
    pub is_no: bool,
}

impl From<String> for Answer {
    fn from(text: String) -> Answer {
        Answer { text, ..Answer::default() }
    }
}

impl Answer {
    /// Prints the text.
    pub fn print(&self) -> Result<()> {
        print(&self.text).map(|_| ())
    }
}

/// A text without what a terminal would obey: of control characters only ends of lines and tabs are left,
/// the others are written as in Rust.
pub fn plain(text: &str) -> Cow<'_, str> {
    let is_obeyed = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    // U+0080 to U+009F begin with the byte C2
    let may_be_obeyed = |b: &u8| b.is_ascii_control() && !matches!(b, b'\n' | b'\t') || *b == 0xC2;
    if !text.as_bytes().iter().any(may_be_obeyed) || !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\r' if rest.peek() == Some(&'\n') => plain.push(c),
            _ if is_obeyed(c) => plain.extend(c.escape_default()),
            _ => plain.push(c),
        }
    }
    Cow::Owned(plain)
}

/// Prints a text, all of it, as [`plain`] has it; `false` for a reader that has seen enough and closed the
/// pipe: no error.
pub fn print(text: &str) -> Result<bool> {
    let mut out = stdout().lock();
    match out.write_all(plain(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        written => written.context(Unwritten).map(|()| true),
    }
}

/// Says something on standard error, as [`plain`] has it, if somebody listens.
pub fn complain(text: &str) {
    let _ = writeln!(stderr(), "{}", plain(text));
}

/// Standard output takes no more: exit code 1.
#[derive(Debug)]
pub struct Unwritten;

impl Display for Unwritten {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("cannot write the answer")
    }
}

/// An answer as JSON for readers, with an end of line; first the name `KIND/N` of its schema, which is that
/// of the type.
///
/// # Errors
/// A map whose keys are no text.
pub fn typed<T: Serialize + JsonSchema>(answer: &T) -> Result<String> {
    Ok(headed(&T::schema_name(), serde_json::to_string_pretty(answer)? + "\n"))
}

/// The JSON schema of what [`typed`] prints of a type, draft 2020-12: no field more, none less.
pub fn schema_of<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().for_serialize().with_transform(Closed);
    let (name, mut schema) = (T::schema_name(), settings.into_generator().into_root_schema_for::<T>().to_value());
    schema["$id"] = format!("urn:deltaq:{}", name.replace('/', ":")).into();
    let head = json!({ "const": format!("deltaq/{name}") });
    let properties = schema["properties"].as_object_mut().into_iter();
    properties.for_each(|properties| _ = properties.shift_insert(0, "schema".into(), head.clone()));
    schema["required"].as_array_mut().into_iter().for_each(|required| required.insert(0, "schema".into()));
    schema
}

/// No field more; no formats, which say how numbers are stored.
#[derive(Clone)]
struct Closed;

impl Transform for Closed {
    fn transform(&mut self, schema: &mut Schema) {
        transform_subschemas(self, schema);
        schema.remove("format");
        if schema.get("properties").is_none() || schema.get("additionalProperties").is_some() {
            return;
        }
        let cases = schema.get_mut("oneOf").and_then(Value::as_array_mut);
        let Some(cases) = cases else {
            schema.insert("additionalProperties".into(), false.into());
            return;
        };
        // each has the common fields besides its own
        cases.iter_mut().filter_map(Value::as_object_mut).for_each(|case| _ = case.remove("additionalProperties"));
        schema.insert("unevaluatedProperties".into(), false.into());
    }
}

/// An object of the evidence as JSON for readers, with an end of line; first its file of `docs/schemas`,
/// version 1. Verdicts are by name.
pub fn pretty(kind: &str, object: &Value) -> String {
    if kind == "verdicts" {
        return printed(kind, &sorted(object.clone()));
    }
    printed(kind, object)
}

/// Every object in it by name.
pub fn sorted(mut object: Value) -> Value {
    object.sort_all_objects();
    object
}

fn printed(kind: &str, object: &Value) -> String {
    headed(&format!("{kind}/1"), format!("{object:#}\n"))
}

fn headed(schema: &str, mut text: String) -> String {
    // JSON leaves some of what [`plain`] takes out
    let is_raw = |c: char| c.is_control() && c != '\n';
    if text.contains(is_raw) {
        text = text.chars().fold(String::new(), |text, c| {
            if is_raw(c) { text + &format!("\\u{:04x}", c as u32) } else { text + c.encode_utf8(&mut [0; 4]) }
        });
    }
    let head = format!("{{\n  \"schema\": \"deltaq/{schema}\",");
    // in place: an answer may take half of the memory
    text.reserve_exact(head.len());
    text.replace_range(..1, &head);
    text
}
