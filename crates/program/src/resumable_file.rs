//! A file of lines that a run adds to and that goes on where it was cut off: tables of members, of points,
//! logs.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::Path;

use anyhow::{Context, Error, Result, ensure};

/// The file of an earlier, interrupted run, read line by line. Nothing changes it before
/// [`ResumableFile::go_on`].
pub struct ResumableFile {
    reader: BufReader<File>,
    told: String,
    head: String,
    at: u64,
    kept: u64,
}

impl ResumableFile {
    /// Opens or makes the file, for one run at a time. It begins with `head`, or with as much of it as was
    /// written before it was cut off.
    ///
    /// # Errors
    /// A file that cannot be read and written or that another run writes; `foreign`, of its first line, where
    /// it begins with something else.
    pub fn open(path: &Path, head: &str, foreign: impl Fn(&str) -> Error) -> Result<ResumableFile> {
        let told = path.display().to_string();
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let file = file.with_context(|| format!("cannot write {told}"))?;
        ensure!(file.metadata().is_ok_and(|there| there.is_file()), "{told} is not a file, from which a run can go on");
        ensure!(file.try_lock().is_ok(), "{told} is being written by another run");
        let mut lines = ResumableFile { reader: BufReader::new(file), told, head: head.to_owned(), at: 0, kept: 0 };
        let mut there = Vec::new();
        while there.len() < head.len() && lines.line(&mut there)? > 0 {}
        if there == head.as_bytes() {
            (lines.at, lines.kept) = (there.len() as u64, there.len() as u64);
        } else if !head.as_bytes().starts_with(&there) {
            return Err(foreign(String::from_utf8_lossy(&there).lines().next().unwrap_or_default()));
        }
        Ok(lines)
    }

    /// The next whole line behind the head, with its end; none at the end of the file, or at a line cut off.
    ///
    /// # Errors
    /// A file that cannot be read, or is not text.
    pub fn next_line(&mut self) -> Result<Option<String>> {
        let mut line = Vec::new();
        // where the head is not whole there is nothing behind it
        if self.kept == 0 || self.line(&mut line)? == 0 || line.last() != Some(&b'\n') {
            return Ok(None);
        }
        self.at += line.len() as u64;
        let line = String::from_utf8(line).with_context(|| format!("cannot read {}", self.told))?;
        Ok(Some(line))
    }

    fn line(&mut self, bytes: &mut Vec<u8>) -> Result<usize> {
        self.reader.read_until(b'\n', bytes).with_context(|| format!("cannot read {}", self.told))
    }

    /// Bytes of the head and of all lines that were read.
    pub fn at(&self) -> u64 {
        self.at
    }

    /// Number of bytes of the file that are kept, at least those of a whole head.
    pub fn keep(&mut self, bytes: u64) {
        self.kept = bytes.max(self.kept);
    }

    /// The file to go on with behind what is kept; one without anything begins with the head.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn go_on(self) -> Result<File> {
        let cannot = || format!("cannot write {}", self.told);
        let mut file = self.reader.into_inner();
        file.set_len(self.kept).with_context(cannot)?;
        file.seek(SeekFrom::Start(self.kept)).with_context(cannot)?;
        if self.kept == 0 {
            file.write_all(self.head.as_bytes()).with_context(cannot)?;
        }
        Ok(file)
    }
}
