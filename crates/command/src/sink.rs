//! Where an answer goes piece by piece: to the terminal, or to a file that has its name when it is whole.

use std::fs::{self, File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::answer;

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
    /// To standard output or, with a name, to a file. What an earlier call has left of a file is kept, if
    /// `keep` says how many bytes of it: those of whole rows.
    pub(crate) fn open(path: Option<&Path>, keep: impl FnOnce(&File, &str) -> Result<u64>) -> Result<Sink> {
        let Some(path) = path else { return Ok(Sink::Terminal) };
        let name = path.file_name().with_context(|| format!("--out {} names no file", path.display()))?;
        let open = |path: &Path| {
            let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
            file.with_context(|| format!("cannot write {}", path.display()))
        };
        if fs::metadata(path).is_ok_and(|there| !there.is_file()) {
            let file = OpenOptions::new().write(true).open(path);
            return Ok(Sink::Device(file.with_context(|| format!("cannot write {}", path.display()))?, path.into()));
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
        let mut beside = name.to_os_string();
        beside.push(".part");
        let part = folder.join(beside);
        let mut file = open(&part)?;
        let told = part.display().to_string();
        ensure!(file.try_lock().is_ok(), "{told} is being written by another call");
        let length = keep(&file, &told)?;
        file.set_len(length).with_context(|| format!("cannot write {told}"))?;
        file.seek(SeekFrom::Start(length)).with_context(|| format!("cannot write {told}"))?;
        Ok(Sink::Part(file, part, path.into()))
    }

    /// Writes a piece; `false` where nobody reads on.
    pub(crate) fn write(&mut self, text: &str) -> Result<bool> {
        match self {
            Sink::Terminal => answer::print(text),
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
