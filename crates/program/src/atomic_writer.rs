//! Where an answer goes: to standard output, or to a file that has its name when it is whole.

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result, ensure};
use tempfile::NamedTempFile;

use crate::{ResumableFile, plain, print};

/// Names of the files that deltaq wrote to a folder that is not its own, one in a line.
pub(crate) const LIST: &str = ".deltaq";

/// How the schema of scenes begins.
const SCHEMA: &str =
    "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"deltaq scene\"";

/// How files of deltaq begin: answers for machines.
const BEGINNINGS: [&str; 2] = ["{\n  \"schema\": \"deltaq/", SCHEMA];

/// What else only they hold: tables of members and points, answers about integrals, the page that explores.
const MARKS: [&str; 5] = [
    ",error_estimate,status,cause\n",
    ",verdict,apart,largest,limit,",
    ",measure,multiplier,",
    "\nansatz        ",
    "<script type=\"application/json\" id=\"chosen\">",
];

/// Bytes of a file that are looked at for them.
const LOOKED_AT: u64 = 8 << 20;

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
    let mut text = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut text));
    read.with_context(|| format!("cannot read {told}"))?;
    let text = String::from_utf8_lossy(&text);
    let ours = BEGINNINGS.iter().any(|head| text.starts_with(head)) || MARKS.iter().any(|mark| text.contains(mark));
    ensure!(
        ours || text.is_empty(),
        "{told} is not of deltaq, as far as it and the list `{LIST}` tell, and not replaced: remove it, or write to \
         another place"
    );
    Ok(())
}

/// Where the pieces of an answer go. What is not closed leaves nothing behind, but a part that a later call
/// goes on with.
pub enum AtomicWriter {
    /// Standard output.
    Terminal,
    /// A file beside its place, and its place.
    Whole(NamedTempFile, PathBuf),
    /// The same of a file that a later call goes on with; or what is not a regular file and stays where it
    /// is.
    Part(File, PathBuf, PathBuf),
}

/// The file that `--out` names; none for standard output, which is `-`.
pub fn file(out: Option<&Path>) -> Option<&Path> {
    out.filter(|path| path.as_os_str() != "-")
}

/// An answer in one piece: written where `out` says, and told; or to be printed.
///
/// # Errors
/// As [`AtomicWriter::whole`].
pub fn keep(out: Option<&Path>, text: String, told: impl FnOnce(&str) -> String) -> Result<String> {
    let Some(path) = file(out) else { return Ok(text) };
    let mut sink = AtomicWriter::whole(path)?;
    sink.write(&text)?;
    sink.close()?;
    Ok(told(&path.display().to_string()))
}

impl AtomicWriter {
    /// To a file that is written in this call, or to a device.
    ///
    /// # Errors
    /// [`may_replace`]; whatever the file system says, with the path.
    pub fn whole(path: &Path) -> Result<AtomicWriter> {
        may_replace(path)?;
        AtomicWriter::over(path)
    }

    /// The same, whatever is there.
    pub(crate) fn over(path: &Path) -> Result<AtomicWriter> {
        let beside = |folder| NamedTempFile::new_in(folder).with_context(|| cannot_write(path));
        place(path)?.or_else(|folder| Ok(AtomicWriter::Whole(beside(folder)?, path.into())))
    }

    /// To standard output or, with a name, to a file, behind the head of the answer; `false` where nobody
    /// reads on. `resume` reads what an earlier call has left of such a file behind its head, demands that it
    /// is of this call (of this ensemble or sweep, which is `what`), and says what of it is kept; without it
    /// the file begins anew.
    ///
    /// # Errors
    /// As [`AtomicWriter::whole`]; and where what is left is of another call.
    pub fn open(
        out: Option<&Path>,
        head: &str,
        what: &str,
        resume: Option<impl FnOnce(&mut ResumableFile, &dyn Fn(bool) -> Result<()>) -> Result<()>>,
    ) -> Result<(AtomicWriter, bool)> {
        let begun = |mut sink: AtomicWriter| sink.write(head).map(|reads_on| (sink, reads_on));
        let Some(path) = file(out) else { return begun(AtomicWriter::Terminal) };
        let Some(resume) = resume else { return begun(AtomicWriter::whole(path)?) };
        may_replace(path)?;
        let folder = match place(path)? {
            Ok(device) => return begun(device),
            Err(folder) => folder,
        };
        let mut beside = path.file_name().unwrap_or_default().to_os_string();
        beside.push(".part");
        let part = folder.join(beside);
        let is_link = fs::symlink_metadata(&part).is_ok_and(|there| there.is_symlink());
        ensure!(
            !is_link,
            "{} is a link, which is not written through: remove it, or take another --out",
            part.display()
        );
        let foreign = |_: &str| {
            let told = part.display();
            Error::msg(format!("{told} is of another {what}, or of another version: remove it, or take another --out"))
        };
        let mut lines = ResumableFile::open(&part, head, foreign)?;
        resume(&mut lines, &|ours| if ours { Ok(()) } else { Err(foreign("")) })?;
        let file = lines.go_on()?;
        Ok((AtomicWriter::Part(file, part, path.into()), true))
    }

    /// Writes a piece, as [`plain`] has it; `false` where nobody reads on.
    ///
    /// # Errors
    /// Whatever the file system says, with the path.
    pub fn write(&mut self, text: &str) -> Result<bool> {
        let text = plain(text);
        let (written, path) = match self {
            AtomicWriter::Terminal => return print(&text),
            AtomicWriter::Whole(file, path) => (file.write_all(text.as_bytes()), path),
            AtomicWriter::Part(file, path, _) => (file.write_all(text.as_bytes()), path),
        };
        written.with_context(|| cannot_write(path)).map(|()| true)
    }

    /// The answer is whole, and gets its name, if it has one.
    ///
    /// # Errors
    /// Whatever the file system says, with the path.
    pub fn close(self) -> Result<Option<PathBuf>> {
        let (moved, path) = match self {
            AtomicWriter::Terminal => return Ok(None),
            AtomicWriter::Whole(temporary, path) => {
                make_readable(temporary.as_file())?;
                (temporary.persist(&path).map(drop).map_err(|error| error.error), path)
            }
            AtomicWriter::Part(_, part, path) => (if part == path { Ok(()) } else { fs::rename(&part, &path) }, path),
        };
        moved.with_context(|| format!("cannot replace {}", path.display())).map(|()| Some(path))
    }
}

fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", path.display())
}

/// What is not a regular file, to be written to as it is; or the folder of a file, which is there from now
/// on.
fn place(path: &Path) -> Result<Result<AtomicWriter, &Path>> {
    ensure!(path.file_name().is_some(), "--out {} names no file", path.display());
    if fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        let file = OpenOptions::new().write(true).open(path).with_context(|| cannot_write(path))?;
        return Ok(Ok(AtomicWriter::Part(file, path.into(), path.into())));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    Ok(Err(folder))
}

/// Temporary files are private; answers are for everybody.
#[cfg(unix)]
fn make_readable(file: &File) -> Result<()> {
    use std::os::unix::fs::PermissionsExt;
    Ok(file.set_permissions(fs::Permissions::from_mode(0o644))?)
}

#[cfg(not(unix))]
fn make_readable(_: &File) -> Result<()> {
    Ok(())
}
