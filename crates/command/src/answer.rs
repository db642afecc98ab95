//! What a command answers, and how the answer comes to the reader.

use std::fmt::{self, Display, Formatter};
use std::io::{ErrorKind, Write, stdout};

use anyhow::{Context, Result};
use serde_json::Value;

use crate::cli::{Output, TextOrJson};
use validation::report::{File, write_all};

/// How a command ended: the text to print, and whether it can be trusted.
pub struct Answer {
    /// For standard output.
    pub text: String,
    /// Why it cannot be trusted, for standard error.
    pub complaint: Option<String>,
}

impl From<String> for Answer {
    fn from(text: String) -> Answer {
        Answer { text, complaint: None }
    }
}

impl Answer {
    /// Prints the text.
    pub(crate) fn print(&self) -> Result<()> {
        print(&self.text).map(|_| ())
    }
}

/// Prints a text, all of it; `false` for a reader that has seen enough and closed the pipe: no error.
pub(crate) fn print(text: &str) -> Result<bool> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(false),
        written => written.context(Unwritten).map(|()| true),
    }
}

/// Standard output takes no more: exit code 1.
#[derive(Debug)]
pub(crate) struct Unwritten;

impl Display for Unwritten {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("cannot write the answer")
    }
}

impl Output {
    /// Writes the files to the folder asked for, if any; then prints JSON of this kind, or text.
    pub(crate) fn answer(
        &self,
        kind: &str,
        files: impl FnOnce() -> Result<Vec<File>>,
        text: impl FnOnce() -> String,
        json: impl FnOnce() -> Value,
    ) -> Result<String> {
        if let Some(folder) = &self.out {
            write_all(folder, &files()?)?;
        }
        Ok(match self.format {
            TextOrJson::Text => text(),
            TextOrJson::Json => pretty(kind, &json()),
        })
    }
}

/// An object as JSON for readers, with an end of line; first its file of `docs/schemas`, and the version.
pub(crate) fn pretty(kind: &str, object: &Value) -> String {
    let version = if matches!(kind, "solve" | "linearize" | "certificate") { 2 } else { 1 };
    let text = format!("{object:#}\n");
    text.replacen('{', &format!("{{\n  \"schema\": \"deltaq/{kind}/{version}\","), 1)
}
