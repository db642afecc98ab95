//! When pages were measured that the main job does not write, and with which code: their last line.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result, bail};

/// How a last line begins.
const BEGINS: &str = "Measured on ";

/// Pages in the folder of reports, and the folders of sources that they speak of.
pub const PAGES: [(&str, &[&str]); 11] = [
    ("evidence/films.md", &["crates/fit/src", "crates/vakonomic/src", "crates/chetaev/src"]),
    ("evidence/judge.md", &["validation/judge", "crates/judge/src", "crates/first-order/src"]),
    (
        "evidence/engine.md",
        &["validation/engine/src", "crates/chetaev/src", "crates/integrate/src", "crates/motion/src"],
    ),
    (
        "evidence/peers.md",
        &[
            "validation/peers",
            "crates/symbolic/src",
            "crates/equations/src",
            "crates/integrate/src",
            "crates/python/src",
        ],
    ),
    (
        "measured/error-vs-time.md",
        &[
            "validation/bench/src",
            "crates/symbolic/src",
            "crates/equations/src",
            "crates/integrate/src",
            "crates/motion/src",
        ],
    ),
    (
        "measured/scaling.md",
        &[
            "validation/src/scaling",
            "crates/symbolic/src",
            "crates/equations/src",
            "crates/reduction/src",
            "crates/integrate/src",
        ],
    ),
    (
        "measured/ivp.md",
        &[
            "validation/src/ivp",
            "validation/ivp",
            "crates/symbolic/src",
            "crates/equations/src",
            "crates/integrate/src",
        ],
    ),
    ("integrals/integrals.md", &["crates/integrals/src", "crates/decision/src/exact", "validation/integrals"]),
    ("measured/machine-code.md", &["crates/symbolic/src"]),
    (
        "sweeps/sledge-sweep.md",
        &["crates/decision/src", "crates/integrate/src", "crates/motion/src", "crates/comparison/src"],
    ),
    (
        "sweeps/turntable-sweep.md",
        &["crates/decision/src", "crates/integrate/src", "crates/motion/src", "crates/comparison/src"],
    ),
];

/// Puts the line under a page of the folder of reports, instead of an older one.
///
/// # Errors
/// A page that is not among these; files that cannot be read or written.
pub fn write(root: &Path, reports: &Path, page: &str) -> Result<()> {
    let path = reports.join(page);
    let Some((_, folders)) = PAGES.iter().find(|(name, _)| *name == page) else {
        let known: Vec<&str> = PAGES.iter().map(|(name, _)| *name).collect();
        bail!("{page} is not a page that says when it was measured; those are {}", known.join(", "));
    };
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let (body, _) = split(&text);
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |past| past.as_secs());
    let line = line(&date(seconds), folders, digest(root, folders)?);
    fs::write(&path, format!("{}\n\n{line}\n", body.trim_end()))
        .with_context(|| format!("cannot write {}", path.display()))
}

/// How a page relates to the code that it speaks of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Age {
    /// Measured with this code.
    Current,
    /// Measured on that day with other code.
    Older(String),
    /// It does not say when it was measured.
    Unknown,
    /// There is no such page.
    Missing,
}

/// The age of every page.
///
/// # Errors
/// Where sources cannot be read.
pub fn ages(root: &Path, reports: &Path) -> Result<Vec<(&'static str, Age)>> {
    let age = |(page, folders): (&'static str, &[&str])| {
        let Ok(text) = fs::read_to_string(reports.join(page)) else { return Ok((page, Age::Missing)) };
        let age = match split(&text).1 {
            Some((_, kept)) if kept == digest(root, folders)? => Age::Current,
            Some((date, _)) => Age::Older(date.into()),
            None => Age::Unknown,
        };
        Ok((page, age))
    };
    PAGES.into_iter().map(age).collect()
}

fn line(date: &str, folders: &[&str], digest: u64) -> String {
    format!("{BEGINS}{date} with the code of {}: digest {digest:016x}.", folders.join(", "))
}

/// A page without its last line, and what that says: date and digest.
fn split(page: &str) -> (&str, Option<(&str, u64)>) {
    let last = page.trim_end().rfind('\n').map_or(0, |end| end + 1);
    let told = page[last..].trim_end().strip_prefix(BEGINS).and_then(|line| {
        let (date, rest) = line.split_once(" with the code of ")?;
        let digest = rest.rsplit_once(": digest ")?.1.trim_end_matches('.');
        Some((date, u64::from_str_radix(digest, 16).ok()?))
    });
    (if told.is_some() { &page[..last] } else { page }, told)
}

/// FNV-1a over the paths and the bytes of all sources in Rust and Python in these folders, which differs
/// where any of them does; line ends count as one character.
fn digest(root: &Path, folders: &[&str]) -> Result<u64> {
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in folders {
        collect(&root.join(folder), &mut files)?;
    }
    files.sort();
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bytes: &[u8]| {
        for byte in bytes.iter().filter(|byte| **byte != b'\r').chain(&[0]) {
            digest = (digest ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for file in files {
        let path = file.strip_prefix(root).unwrap_or(&file);
        let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
        add(parts.join("/").as_bytes());
        add(&fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?);
    }
    Ok(digest)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry.with_context(|| format!("cannot read {}", folder.display()))?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "py") {
            files.push(path);
        }
    }
    Ok(())
}

/// The day of a time in seconds since 1970, by the calendar of Gregory: `2026-11-24`.
pub fn date(seconds: u64) -> String {
    let mut days = seconds / 86_400;
    let is_leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let (mut year, mut month) = (1970, 1);
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    for length in [31, 28 + u64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}
