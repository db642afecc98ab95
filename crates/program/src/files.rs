//! Files are written whole or not at all.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::atomic_writer::{AtomicWriter, LIST, may_replace};

/// A file of a report.
#[derive(Clone, Debug)]
pub struct File {
    /// Path inside the folder of reports.
    pub path: PathBuf,
    /// Text.
    pub text: String,
}

/// Whether all of a folder is deltaq's: it has the verdicts of the main job.
pub fn is_own(folder: &Path) -> bool {
    let verdicts = fs::read_to_string(folder.join("verdicts.json"));
    verdicts.is_ok_and(|text| text.starts_with("{\n  \"schema\": \"deltaq/verdicts/"))
}

/// Writes every file beside its place first; only when all are written are they moved into place. Of what is
/// there only files of deltaq are replaced: it keeps a list of them in the folder.
///
/// # Errors
/// A link or a file that is not of deltaq; whatever the file system says, with the path.
pub fn write_all(folder: &Path, files: &[File]) -> Result<()> {
    if is_own(folder) {
        return write_own(folder, files);
    }
    let list = folder.join(LIST);
    let known = fs::read_to_string(&list).unwrap_or_default();
    let known: BTreeSet<&str> = known.lines().collect();
    let names: Vec<String> = files.iter().map(|file| file.path.display().to_string()).collect();
    for (file, name) in files.iter().zip(&names) {
        let path = folder.join(&file.path);
        if !known.contains(name.as_str()) || fs::symlink_metadata(&path).is_ok_and(|there| there.is_symlink()) {
            may_replace(&path)?;
        }
    }
    let known: BTreeSet<&str> = known.into_iter().chain(names.iter().map(String::as_str)).collect();
    let known = File { path: LIST.into(), text: known.iter().map(|name| format!("{name}\n")).collect() };
    // the list first: of a call that is cut off no file is left that is not in it
    write_own(folder, &[&[known], files].concat())
}

/// [`write_all`] in a folder that is deltaq's, where all files are.
///
/// # Errors
/// A link; whatever the file system says, with the path.
pub fn write_own(folder: &Path, files: &[File]) -> Result<()> {
    let mut waiting = Vec::new();
    for file in files {
        let path = folder.join(&file.path);
        if fs::symlink_metadata(&path).is_ok_and(|there| there.is_symlink()) {
            may_replace(&path)?;
        }
        let is_page = path.extension().is_some_and(|extension| extension == "md");
        let text = if is_page { typeset(&file.text) } else { Cow::from(&file.text) };
        let mut sink = AtomicWriter::over(&path)?;
        sink.write(&text)?;
        waiting.push(sink);
    }
    waiting.into_iter().try_for_each(|sink| sink.close().map(drop))
}

/// A page in whose tables the minus of an exponent is U+2212: browsers end lines behind a hyphen.
fn typeset(page: &str) -> Cow<'_, str> {
    let digit = |text: &str, at: usize| text.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
    let mut text = String::with_capacity(page.len());
    for line in page.split_inclusive('\n') {
        let mut written = 0;
        for (at, found) in line.match_indices("e-").filter(|_| line.trim_start().starts_with('|')) {
            if at > 0 && digit(line, at - 1) && digit(line, at + found.len()) {
                text = text + &line[written..at] + "e\u{2212}";
                written = at + found.len();
            }
        }
        text += &line[written..];
    }
    text.into()
}
