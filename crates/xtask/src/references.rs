//! Every key that is cited has an entry in a bibliography, and every entry is cited.
//!
//! A key is names and a year in one word, as `LewisMurray1995`. It stands in links of Markdown
//! (`[Lewis & Murray 1995](references.bib#LewisMurray1995)`), on front pages of crates and in data.

use std::collections::BTreeSet;

use anyhow::{Context, Result};

/// Bibliographies, and the folder whose texts cite each; the first has all that no other one has.
const BIBLIOGRAPHIES: [(&str, &str); 2] = [("docs/references.bib", ""), ("docs/paper/paper.bib", "docs/paper/")];
/// Texts that cite.
const CITING: [&str; 4] = [".md", ".rs", ".toml", ".py"];
/// What an entry has at least.
const FIELDS: [&str; 3] = ["author = ", "title = ", "year = "];

/// Faults of all citations; how many entries there are.
pub(crate) fn check(names: &[String], faults: &mut Vec<String>) -> Result<usize> {
    let mut cited = vec![BTreeSet::new(); BIBLIOGRAPHIES.len()];
    for name in names.iter().filter(|name| CITING.iter().any(|end| name.ends_with(end)) && !name.contains("/xtask/")) {
        let own = BIBLIOGRAPHIES.iter().rposition(|(_, folder)| name.starts_with(folder)).unwrap_or_default();
        cited[own].extend(keys(&std::fs::read_to_string(name).context(name.clone())?));
    }
    let mut count = 0;
    for ((path, _), cited) in BIBLIOGRAPHIES.iter().zip(&cited) {
        count += entries(path, &std::fs::read_to_string(path).context(*path)?, cited, faults);
    }
    Ok(count)
}

/// Faults of a bibliography whose keys `cited` are; how many entries it has.
fn entries(path: &str, text: &str, cited: &BTreeSet<String>, faults: &mut Vec<String>) -> usize {
    let entries = || text.split("\n@").skip(1).filter_map(|entry| entry.split_once('{')?.1.split_once(','));
    let known: BTreeSet<&str> = entries().map(|(key, _)| key).collect();
    for (key, fields) in entries() {
        let lacks = FIELDS.iter().filter(|field| !fields.contains(**field));
        faults.extend(lacks.map(|field| format!("{path}: {key} has no {}", field.trim_end_matches(" = "))));
        if !cited.contains(key) {
            faults.push(format!("{path}: {key} is cited nowhere"));
        }
    }
    let unknown = cited.iter().filter(|key| !known.contains(key.as_str()));
    faults.extend(unknown.map(|key| format!("{path} has no entry {key}, which is cited")));
    known.len()
}

/// Words of letters and a year that begin with a capital.
fn keys(text: &str) -> impl Iterator<Item = String> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    let is_key = |word: &&str| {
        let (name, year) = word.split_at(word.len().saturating_sub(4));
        name.len() > 2
            && name.starts_with(|c: char| c.is_ascii_uppercase())
            && name.ends_with(|c: char| c.is_ascii_lowercase())
            && name.chars().all(|c| c.is_ascii_alphabetic())
            && year.parse().is_ok_and(|year: u16| (1600..2100).contains(&year))
    };
    words.filter(is_key).map(String::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn citations_and_entries_belong_together() {
        let found: Vec<String> = keys("[a](b.bib#Lewis2020), `Gao2017`; Lewis 2020, T12, COLOUR2000, x1999").collect();
        assert_eq!(found, ["Lewis2020", "Gao2017"]);
        let text = "% head\n@misc{Gao2017,\n  author = {G}, title = {T}, year = {2017}\n}\n@book{Old1900,\n  year = {1900}\n}\n";
        let mut faults = Vec::new();
        assert_eq!(entries("a.bib", text, &found.into_iter().collect(), &mut faults), 2);
        let said = ["Old1900 has no author", "Old1900 has no title", "Old1900 is cited nowhere", "no entry Lewis2020"];
        assert_eq!(faults.len(), said.len(), "{faults:?}");
        assert!(said.iter().zip(&faults).all(|(said, fault)| fault.contains(said)), "{faults:?}");
    }
}
