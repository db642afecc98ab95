//! Every key that is cited has an entry in a bibliography, and every entry is cited.
//!
//! A key is names and a year in one word, as `LewisMurray1995`, wherever it stands: in links of Markdown
//! (`[Lewis & Murray 1995](references.bib#LewisMurray1995)`), on front pages of crates, in data.

use std::collections::BTreeSet;

use anyhow::{Context, Result};

/// Bibliographies, and the folder whose texts cite each; the first has all that no other one has.
const BIBLIOGRAPHIES: [(&str, &str); 2] = [("docs/references.bib", ""), ("docs/paper/paper.bib", "docs/paper/")];
const CITING: [&str; 4] = [".md", ".rs", ".toml", ".py"];

/// Faults of all citations; how many entries there are.
pub(crate) fn check(names: &[String], faults: &mut Vec<String>) -> Result<usize> {
    let mut cited = vec![BTreeSet::new(); BIBLIOGRAPHIES.len()];
    for name in names.iter().filter(|name| CITING.iter().any(|end| name.ends_with(end)) && !name.contains("/xtask/")) {
        let own = BIBLIOGRAPHIES.iter().rposition(|(_, folder)| name.starts_with(folder)).unwrap_or_default();
        cited[own].extend(keys(&std::fs::read_to_string(name).context(name.clone())?));
    }
    let mut count = 0;
    for ((path, _), cited) in BIBLIOGRAPHIES.iter().zip(&cited) {
        let known = entries(&std::fs::read_to_string(path).context(*path)?);
        faults.extend(known.difference(cited).map(|key| format!("{path}: {key} is cited nowhere")));
        faults.extend(cited.difference(&known).map(|key| format!("{path} has no entry {key}, which is cited")));
        count += known.len();
    }
    Ok(count)
}

fn entries(text: &str) -> BTreeSet<String> {
    let entry = |entry: &str| Some(entry.split_once('{')?.1.split_once(',')?.0.to_owned());
    format!("\n{text}").split("\n@").skip(1).filter_map(entry).collect()
}

/// Words of letters and a year that begin with a capital.
fn keys(text: &str) -> impl Iterator<Item = String> {
    let is_key = |word: &&str| {
        let (name, year) = word.split_at(word.len().saturating_sub(4));
        let is_name = name.len() > 2 && name.starts_with(|c: char| c.is_ascii_uppercase());
        is_name
            && name.chars().all(|c| c.is_ascii_alphabetic())
            && year.parse().is_ok_and(|year: u16| (1600..2100).contains(&year))
    };
    text.split(|c: char| !c.is_ascii_alphanumeric()).filter(is_key).map(String::from)
}

#[test]
fn keys_and_entries_are_found() {
    let found: Vec<String> = keys("[a](b.bib#Lewis2020), `Gao2017`; Lewis 2020, T12, Colour3000, x1999").collect();
    assert_eq!(found, ["Lewis2020", "Gao2017"]);
    assert_eq!(entries("@misc{Gao2017,\n}\n@book{Old1900,\n}\n").len(), 2);
}
