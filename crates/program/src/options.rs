//! Options that the programs share.

use std::path::PathBuf;

use anyhow::Result;
use clap::builder::{PathBufValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use serde_json::Value;

use crate::answer::pretty;
use crate::files::{File, write_all};
use crate::parallel;

/// Options of every command.
#[derive(Args, Debug)]
pub struct Common {
    /// No progress bar.
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Number of worker threads; one per processor if left out. Does not affect results.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl Common {
    /// Has the work that follows done by as many threads as are asked for.
    pub fn use_threads(&self) {
        if let Some(threads) = self.threads {
            parallel::use_threads(threads.into());
        }
    }
}

/// What a command with tables answers with.
#[derive(Args, Debug)]
pub struct Output {
    /// Folder for the page and its pictures, or for scene files.
    #[arg(long, value_name = "DIR", value_parser = folder())]
    pub out: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

impl Output {
    /// Writes the files to the folder asked for, if any; then prints JSON of this kind, or text.
    pub fn answer(
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

/// A folder for files; not `-`, which is standard output.
pub fn folder() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.as_os_str() == "-" {
        true => Err("this is standard output, and a folder is needed (./- is one)"),
        false => Ok(path),
    })
}

/// Output formats of commands with tables.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextOrJson {
    /// Tables.
    Text,
    /// One object.
    Json,
}

/// One of `all`, by its name; with a word on it in the help where there is one.
pub fn by_name<T: Copy + Send + Sync + 'static>(
    all: impl IntoIterator<Item = T>,
    name: fn(T) -> &'static str,
    help: Option<fn(T) -> &'static str>,
) -> impl TypedValueParser<Value = T> {
    let all: Vec<T> = all.into_iter().collect();
    let possible: Vec<PossibleValue> = all
        .iter()
        .map(|&one| {
            let value = PossibleValue::new(name(one));
            help.map_or(value.clone(), |help| value.help(help(one)))
        })
        .collect();
    PossibleValuesParser::new(possible)
        .try_map(move |given| all.iter().copied().find(|&one| name(one) == given).ok_or("unknown"))
}
