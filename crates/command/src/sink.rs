//! Where an answer goes piece by piece: to the terminal, or to a file that has its name when it is whole.

use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result, ensure};
use program::Lines;
use program::may_replace;

/// Where the pieces go.
pub(crate) enum Sink {
    /// Standard output.
    Terminal,
    /// What is no regular file, and is written to as it is.
    Device(File, PathBuf),
    /// A file beside its place, and its place.
    Part(File, PathBuf, PathBuf),
}

impl Sink {
    /// To standard output or, with a name, to a file, behind the head of the answer; `false` where nobody
    /// reads on. `resume` reads what an earlier call has left of such a file behind its head, demands that it
    /// is of this call (of this ensemble or sweep, which is `what`), and says what of it is kept.
    pub(crate) fn open(
        path: Option<&Path>,
        head: &str,
        what: &str,
        resume: impl FnOnce(&mut Lines, &dyn Fn(bool) -> Result<()>) -> Result<()>,
    ) -> Result<(Sink, bool)> {
        let begun = |mut sink: Sink| sink.write(head).map(|reads_on| (sink, reads_on));
        let Some(path) = path else { return begun(Sink::Terminal) };
        let name = path.file_name().with_context(|| format!("--out {} names no file", path.display()))?;
        may_replace(path)?;
        if fs::metadata(path).is_ok_and(|there| !there.is_file()) {
            let file = OpenOptions::new().write(true).open(path);
            let file = file.with_context(|| format!("cannot write {}", path.display()))?;
            return begun(Sink::Device(file, path.into()));
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
        let mut beside = name.to_os_string();
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
        let mut lines = Lines::open(&part, head, foreign)?;
        resume(&mut lines, &|ours| if ours { Ok(()) } else { Err(foreign("")) })?;
        let file = lines.go_on()?;
        Ok((Sink::Part(file, part, path.into()), true))
    }

    /// Writes a piece; `false` where nobody reads on.
    pub(crate) fn write(&mut self, text: &str) -> Result<bool> {
        match self {
            Sink::Terminal => program::print(text),
            Sink::Device(file, path) | Sink::Part(file, path, _) => {
                let written = file.write_all(text.as_bytes());
                written.with_context(|| format!("cannot write {}", path.display())).map(|()| true)
            }
        }
    }

    /// The answer is whole.
    pub(crate) fn close(self, what: &str) -> Result<String> {
        let path = match self {
            Sink::Terminal => return Ok(String::new()),
            Sink::Device(_, path) => path,
            Sink::Part(_, part, path) => {
                fs::rename(&part, &path).with_context(|| format!("cannot replace {}", path.display()))?;
                path
            }
        };
        Ok(format!("{what} in {}\n", path.display()))
    }
}
