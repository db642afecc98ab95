//! Files are written whole or not at all.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use tempfile::NamedTempFile;

/// A file of a report.
#[derive(Clone, Debug)]
pub struct File {
    /// Path inside the folder of reports.
    pub path: PathBuf,
    /// Text.
    pub text: String,
}

/// Names of the files that deltaq wrote to a folder that is not its own, one in a line.
const LIST: &str = ".deltaq";

/// How files of deltaq begin: answers for machines, tables of members.
const BEGINNINGS: [&str; 2] = ["{\n  \"schema\": \"deltaq/", "member,"];

/// What else only they hold: a table of points, the page that explores.
const MARKS: [&str; 2] = [",verdict,apart,largest,limit,", "<script type=\"application/json\" id=\"chosen\">"];

/// Whether a file at this place may be written: nothing is there, a device, or what deltaq wrote.
///
/// # Errors
/// A link, and what is not of deltaq.
pub fn may_replace(path: &Path) -> Result<()> {
    let told = path.display();
    let Ok(there) = fs::symlink_metadata(path) else { return Ok(()) };
    if fs::metadata(path).is_ok_and(|behind| !behind.is_file()) {
        return Ok(());
    }
    ensure!(!there.is_symlink(), "{told} is a link, which is not replaced: remove it, or write to another place");
    let text = fs::read(path).with_context(|| format!("cannot read {told}"))?;
    let text = String::from_utf8_lossy(&text);
    let ours = BEGINNINGS.iter().any(|head| text.starts_with(head)) || MARKS.iter().any(|mark| text.contains(mark));
    ensure!(
        ours || text.is_empty(),
        "{told} is not of deltaq, as far as it and the list `{LIST}` tell, and not replaced: remove it, or write to \
         another place"
    );
    Ok(())
}

/// Whether all of a folder is deltaq's: it has the verdicts of the main job.
pub fn is_own(folder: &Path) -> bool {
    let verdicts = fs::read_to_string(folder.join("verdicts.json"));
    verdicts.is_ok_and(|text| text.starts_with("{\n  \"schema\": \"deltaq/verdicts/"))
}

/// Writes one file, beside its place first.
///
/// # Errors
/// [`may_replace`]; whatever the file system says, with the path.
pub fn write_one(path: &Path, text: &str) -> Result<()> {
    may_replace(path)?;
    let parent = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    beside(path, parent, text)?.map_or(Ok(()), |temporary| moved(temporary, path))
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
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent).with_context(|| format!("cannot create {}", parent.display()))?;
        let is_page = path.extension().is_some_and(|extension| extension == "md");
        let text = if is_page { typeset(&file.text) } else { Cow::from(&file.text) };
        let temporary = beside(&path, parent, &text)?;
        waiting.extend(temporary.map(|temporary| (temporary, path)));
    }
    waiting.into_iter().try_for_each(|(temporary, path)| moved(temporary, &path))
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

/// The text in a file beside its place; a device is written to, and nothing waits.
fn beside(path: &Path, parent: &Path, text: &str) -> Result<Option<NamedTempFile>> {
    let cannot = || format!("cannot write {}", path.display());
    if fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        return fs::write(path, text).with_context(cannot).map(|()| None);
    }
    let temporary = NamedTempFile::new_in(parent);
    let mut temporary = temporary.with_context(cannot)?;
    temporary.write_all(text.as_bytes()).with_context(cannot)?;
    Ok(Some(temporary))
}

fn moved(temporary: NamedTempFile, path: &Path) -> Result<()> {
    make_readable(temporary.as_file())?;
    temporary.persist(path).with_context(|| format!("cannot replace {}", path.display())).map(drop)
}

/// Temporary files are private; reports are for everybody.
#[cfg(unix)]
fn make_readable(file: &fs::File) -> Result<()> {
    use std::os::unix::fs::PermissionsExt;
    Ok(file.set_permissions(fs::Permissions::from_mode(0o644))?)
}

#[cfg(not(unix))]
fn make_readable(_: &fs::File) -> Result<()> {
    Ok(())
}
