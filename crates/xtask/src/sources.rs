//! What must hold of the text of files.

use anyhow::{Result, bail, ensure};

use crate::tools::{Outcome, output_of, outside};

/// Longest Rust source, in lines; widest comment in it, in columns.
const LINES: usize = 400;
const COLUMNS: usize = 110;
/// Folders at the root of a file system that hold what belongs to one machine.
const PLACES: [&str; 12] =
    ["home", "root", "Users", "work", "workspace", "workspaces", "builds", "mnt", "opt", "private", "tmp", "var"];
/// Words of private package registries. In two halves, so that this file passes.
const REGISTRIES: [(&str, &str); 3] = [("arti", "factory"), ("jf", "rog.io"), ("replace", "-with =")];
/// The one registry that a lock file may name.
const INDEX: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// No Rust source is over [`LINES`], no comment in it over [`COLUMNS`].
pub(crate) fn lengths() -> Result<Outcome> {
    let mut count = 0;
    let mut long = Vec::new();
    for (name, text) in files()?.iter().filter(|(name, _)| name.ends_with(".rs")) {
        count += 1;
        let lines = text.lines().count();
        if lines > LINES {
            long.push(format!("{name} has {lines} lines"));
        }
        let wide = (1..).zip(text.lines()).filter(|(_, line)| is_wide(line));
        long.extend(wide.map(|(number, _)| format!("the comment at {name}:{number} is over {COLUMNS} columns")));
    }
    if !long.is_empty() {
        bail!("{}", long.join("; "));
    }
    Ok(Outcome::Passed(format!(", {count} files")))
}

/// Is it a comment over [`COLUMNS`] that can be broken: no row of a table, and with a blank after column 40?
fn is_wide(line: &str) -> bool {
    let text = line.trim_start();
    let row = text.trim_start_matches(['/', '!', ' ']).starts_with('|');
    text.starts_with("//") && !row && line.chars().count() > COLUMNS && line.chars().skip(40).any(|c| c == ' ')
}

/// No file names a place on one machine or a private registry.
pub(crate) fn paths() -> Result<Outcome> {
    let files = files()?;
    let mut found = Vec::new();
    for (name, text) in &files {
        for (number, line) in (1..).zip(text.lines()) {
            if let Some(what) = private(name, line) {
                found.push(format!("{name}:{number} names {what}"));
            }
        }
    }
    if !found.is_empty() {
        bail!("{}", found.join("; "));
    }
    Ok(Outcome::Passed(format!(", {} files", files.len())))
}

/// Files that packages have to hold themselves, by the end of their names, and what they are copies of: no
/// symbolic links, which Windows checks out as texts with a path.
const COPIES: [(&str, &str); 3] =
    [("LICENSE-MIT", "LICENSE-MIT"), ("LICENSE-APACHE", "LICENSE-APACHE"), ("explore.html", "reports/explore.html")];

/// Every copy is as its original, and nothing is a symbolic link.
pub(crate) fn copies() -> Result<Outcome> {
    let (mut count, mut found) = (0, Vec::new());
    for name in names()? {
        if std::fs::symlink_metadata(&name).is_ok_and(|data| data.is_symlink()) {
            found.push(format!("{name} is a symbolic link"));
        }
        let is_copy = |(end, original): &&(&str, &str)| name.rsplit('/').next() == Some(*end) && name != *original;
        let Some((_, original)) = COPIES.iter().find(is_copy) else { continue };
        count += 1;
        if std::fs::read(&name).ok() != std::fs::read(original).ok() {
            found.push(format!("{name} is not as {original}"));
        }
    }
    ensure!(found.is_empty(), "{}", found.join("; "));
    Ok(Outcome::Passed(format!(", {count} copies")))
}

/// Name of every file that is tracked, or would be.
pub(crate) fn names() -> Result<Vec<String>> {
    let names = output_of(outside("git").args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"]))?;
    Ok(names.split_terminator('\0').map(str::to_owned).collect())
}

/// What in this line belongs to one machine or to a private registry.
fn private(file: &str, line: &str) -> Option<String> {
    if let Some(place) = PLACES.iter().find(|place| names_place(line, place)) {
        return Some(format!("a path under `{place}` at the root"));
    }
    let lower = line.to_lowercase();
    let registries = REGISTRIES.map(|(head, tail)| format!("{head}{tail}"));
    if let Some(word) = registries.into_iter().find(|word| lower.contains(word)) {
        return Some(format!("`{word}`"));
    }
    let source = line.strip_prefix("source = ").filter(|_| file.ends_with("Cargo.lock"))?.trim_matches('"');
    (source != INDEX).then(|| format!("the source `{source}`"))
}

/// Does the line hold `/place/` where a path begins?
fn names_place(line: &str, place: &str) -> bool {
    let path = format!("/{place}/");
    line.match_indices(&path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && !".-_~)]}*$<".contains(c))
    })
}

/// Name and text of every file that is tracked, or would be. Files that are not text are left out.
fn files() -> Result<Vec<(String, String)>> {
    Ok(names()?.into_iter().filter_map(|name| Some((name.clone(), std::fs::read_to_string(name).ok()?))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_one_machine_are_found() {
        let path = |place: &str| format!("/{place}/someone/file");
        for line in [path("home"), format!("see `{}`", path("tmp")), format!("file://{}", path("Users"))] {
            assert!(private("notes.md", &line).is_some(), "{line}");
        }
        for line in ["a/home/b", "../tmp/x", "/usr/bin/env", "m/s", "https://example.org/work/1", "/target"] {
            assert_eq!(private("notes.md", line), None, "{line}");
        }
    }

    #[test]
    fn wide_comments_are_found() {
        let words = "ω ".repeat(60);
        assert!(is_wide(&format!("    //! {words}")));
        let (short, one) = ("ω ".repeat(50), "ω".repeat(120));
        for line in [format!("/// {short}"), format!("/// | {words}|"), format!("// {one}"), format!("let {words}")] {
            assert!(!is_wide(&line), "{line}");
        }
    }

    #[test]
    fn registries_are_found() {
        let word = REGISTRIES[0].0.to_owned() + REGISTRIES[0].1;
        assert!(private("notes.md", &format!("https://{word}.example.org")).is_some());
        assert_eq!(private("Cargo.lock", &format!("source = \"{INDEX}\"")), None);
        assert!(private("Cargo.lock", "source = \"registry+https://example.org/index\"").is_some());
    }
}
