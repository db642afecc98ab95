//! Verdicts on mutants, kept in a file so that a run that was cut off goes on where it stopped.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::{Value, json};

use super::finder::Mutant;

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verdict {
    /// A test failed.
    Killed,
    /// Every test passed.
    Survived,
    /// It does not compile.
    Unviable,
    /// The tests did not end in time: noticed, too.
    Timeout,
}

impl Verdict {
    pub(crate) const ALL: [Verdict; 4] = [Verdict::Killed, Verdict::Survived, Verdict::Unviable, Verdict::Timeout];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Verdict::Killed => "killed",
            Verdict::Survived => "survived",
            Verdict::Unviable => "unviable",
            Verdict::Timeout => "timeout",
        }
    }
}

/// One verdict with what led to it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) verdict: Verdict,
    /// The test that failed, or why it does not compile.
    pub(crate) note: String,
    pub(crate) seconds: f64,
}

/// All verdicts so far.
pub(crate) struct Results {
    path: PathBuf,
    entries: BTreeMap<String, Value>,
}

impl Results {
    /// Reads the file, if there is one.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let entries = match std::fs::read_to_string(path) {
            Ok(text) => serde_json::from_str(&text)
                .with_context(|| format!("{} does not parse; without it every mutant is run anew", path.display()))?,
            Err(_) => BTreeMap::new(),
        };
        Ok(Results { path: path.to_owned(), entries })
    }

    /// The verdict on a mutant of a source, if it still counts. A mutant that survived may be noticed by tests that
    /// have changed since: its verdict counts for the sources `all` only. What was killed stays killed.
    pub(crate) fn get(&self, mutant: &Mutant, source: &str, all: u64) -> Option<Outcome> {
        let entry = self.entries.get(&key(mutant, source))?;
        let verdict = Verdict::ALL.into_iter().find(|verdict| entry["verdict"] == verdict.name())?;
        if verdict == Verdict::Survived && entry["sources"] != format!("{all:016x}") {
            return None;
        }
        let note = entry["note"].as_str()?.to_owned();
        Some(Outcome { verdict, note, seconds: entry["seconds"].as_f64()? })
    }

    /// Adds a verdict and writes the file.
    pub(crate) fn add(&mut self, mutant: &Mutant, source: &str, all: u64, outcome: &Outcome) -> Result<()> {
        let entry = json!({
            "file": mutant.file,
            "line": mutant.line,
            "original": mutant.original,
            "replacement": mutant.replacement,
            "verdict": outcome.verdict.name(),
            "note": outcome.note,
            "seconds": outcome.seconds,
            "sources": format!("{all:016x}"),
        });
        self.entries.insert(key(mutant, source), entry);
        let text = serde_json::to_string_pretty(&self.entries)?;
        let fresh = self.path.with_extension("new");
        std::fs::write(&fresh, text).with_context(|| fresh.display().to_string())?;
        std::fs::rename(&fresh, &self.path).with_context(|| self.path.display().to_string())
    }
}

/// A number that tells contents apart.
pub(crate) fn hash(of: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

fn key(mutant: &Mutant, source: &str) -> String {
    let (start, end) = (mutant.range.start, mutant.range.end);
    format!("{} {:016x} {start}..{end} {:016x}", mutant.file, hash(&source), hash(&mutant.text))
}
