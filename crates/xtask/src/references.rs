//! Every key that is cited has an entry in a bibliography, and every entry is cited.
//!
//! A key is names and a year in one word, as `LewisMurray1995`, wherever it stands: in links of Markdown
//! (`[Lewis & Murray 1995](references.bib#LewisMurray1995)`), on front pages of crates, in data.
//!
//! A statement that is cited, as `Theorem 4(d)`, is a heading of the theory. Pages outside of the theory
//! link it, and the number of the heading to which they link is the one that they name.

use std::collections::BTreeSet;

use anyhow::{Context, Result};

use crate::pages::Page;

/// Bibliographies, and the folder whose texts cite each; the first has all that no other one has.
const BIBLIOGRAPHIES: [(&str, &str); 2] = [("docs/references.bib", ""), ("docs/paper/paper.bib", "docs/paper/")];
/// Pages with the statements, and what a statement is called.
const THEORY: &str = "docs/theory";
const KINDS: [&str; 3] = ["Theorem", "Proposition", "Lemma"];
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

/// Faults of citations of statements on pages and in sources; how many there are.
pub(crate) fn statements(pages: &[Page], names: &[String], faults: &mut Vec<String>) -> Result<usize> {
    let theory = |page: &&Page| page.name.starts_with(THEORY);
    let headings = pages.iter().filter(theory).flat_map(|page| &page.parts).filter(|(_, part)| part.starts_with('#'));
    let known: BTreeSet<String> = headings.filter_map(|(_, part)| Some(cited(part).next()?.0)).collect();
    let mut count = 0;
    for page in pages {
        for (line, part) in page.parts.iter().filter(|(_, part)| !part.starts_with('#')) {
            for (statement, anchor) in cited(part) {
                count += 1;
                let right = known.contains(&statement) && anchor.as_ref().is_none_or(|anchor| *anchor == statement);
                if !right || anchor.is_none() && !page.name.starts_with(THEORY) {
                    let target = anchor.unwrap_or_else(|| "nothing".into());
                    faults.push(format!("{}:{line} {statement} is cited and links to {target}", page.name));
                }
            }
        }
    }
    for name in names.iter().filter(|name| name.ends_with(".rs") && !name.contains("/xtask/")) {
        let text = std::fs::read_to_string(name).context(name.clone())?;
        let unknown = cited(&text).map(|(statement, _)| statement).filter(|statement| !known.contains(statement));
        faults.extend(unknown.map(|statement| format!("{name}: the theory has no {statement}")));
    }
    Ok(count)
}

/// Statements that are named in a text, `Theorem 4`, each with the one whose heading is linked there.
fn cited(text: &str) -> impl Iterator<Item = (String, Option<String>)> {
    let number = |text: &str| text[..text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len())].to_owned();
    KINDS.into_iter().flat_map(move |kind| {
        let named = text.split(kind).skip(1).map(move |rest| (number(rest.trim_start_matches('s').trim_start()), rest));
        named.filter(|(own, _)| !own.is_empty()).map(move |(own, rest)| {
            let inner = rest.split_once("](").filter(|(inner, _)| !inner.contains('['));
            let anchor = inner.and_then(|(_, target)| {
                let target = target.split(')').next()?.split_once(&format!("#{}-", kind.to_lowercase()))?.1;
                Some(format!("{kind} {}", number(target)))
            });
            (format!("{kind} {own}"), anchor)
        })
    })
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

#[test]
fn a_cited_statement_is_the_linked_one() {
    let page = |name: &str, text: &str| Page::of(name, text);
    let theory = page("docs/theory.md", "### Theorem 3: a\n\n### Lemma 1: b\n\nBy Theorem 3(i).");
    let faults = |text: &str| {
        let mut faults = Vec::new();
        let count = statements(&[theory.clone(), page("docs/a.md", text)], &[], &mut faults).expect("read");
        (count, faults.len())
    };
    assert_eq!(faults("As [Theorem 3(ii)](theory.md#theorem-3-a) and [Lemma 1](theory.md#lemma-1-b) say."), (3, 0));
    for wrong in ["[Theorem 4](theory.md#theorem-3-a)", "[Theorem 3](theory.md#theorem-4-a)", "Theorem 3", "Lemma 2"] {
        assert_eq!(faults(wrong), (2, 1), "{wrong}");
    }
}
