//! What must hold of prose: habits that readers stumble over, long sentences, long pages.

use anyhow::{Context, Result, bail};

use crate::pages::{Page, is_page, prose};
use crate::sources::names;
use crate::tools::Outcome;
use crate::{numbers, references};

/// Most words of a sentence and of a page, code and formulas counted as one word each.
const SENTENCE: usize = 35;
const PAGE: usize = 1500;
/// Words that belong to no sentence here, and what to say instead.
const HABITS: [(&str, &str); 6] = [
    (" is no ", "is not a"),
    (" are no ", "are not"),
    ("in the place of", "instead of"),
    ("but for ", "except"),
    ("likewise", "also"),
    (", and no ", "a sentence of its own"),
];

/// No page has a sentence over [`SENTENCE`] words, a page over [`PAGE`], one of the [`HABITS`], a number
/// without a source, or a citation without its entry; nor has a message, help or front page such a habit.
pub(crate) fn check() -> Result<Outcome> {
    let (names, mut faults) = (names()?, Vec::new());
    let pages: Vec<Page> =
        names.iter().filter(|name| is_page(name)).map(|name| Page::read(name)).collect::<Result<_>>()?;
    for page in &pages {
        faults.extend(page.faults());
    }
    let sources =
        names.iter().filter(|name| name.starts_with("crates/") && name.contains("/src/") && name.ends_with(".rs"));
    for name in sources {
        faults.extend(in_source(name, &std::fs::read_to_string(name).context(name.clone())?));
    }
    let counted = numbers::check(&pages, &names, &mut faults)?;
    let entries = references::check(&names, &mut faults)?;
    let statements = references::statements(&pages, &names, &mut faults)?;
    if !faults.is_empty() {
        bail!("{}", faults.join("; "));
    }
    let found = format!("{counted} numbers with their source, {entries} references, {statements} citations of theory");
    Ok(Outcome::Passed(format!(", {} pages, {found}", pages.len())))
}

impl Page {
    fn faults(&self) -> Vec<String> {
        let (mut faults, mut words) = (Vec::new(), 0);
        for (line, part) in &self.parts {
            let place = format!("{}:{line}", self.name);
            let text = prose(part);
            words += count(&text);
            faults.extend(habits(&text).map(|(habit, better)| format!("{place} `{}`: {better}", habit.trim())));
            let cells = text.split('|').flat_map(sentences).filter(|sentence| count(sentence) > SENTENCE);
            faults.extend(cells.map(|sentence| {
                let begin: String = sentence.chars().take(40).collect();
                format!("{place} a sentence of {} words: {begin}…", count(sentence))
            }));
        }
        if words > PAGE {
            faults.push(format!("{} has {words} words, at most {PAGE}: split it by task", self.name));
        }
        faults
    }
}

fn count(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count()
}

/// Sentences: each ends with `.`, `!` or `?` before a blank and what can begin another.
fn sentences(text: &str) -> Vec<&str> {
    let (mut found, mut begin) = (Vec::new(), 0);
    for (at, _) in text.match_indices(['.', '!', '?']) {
        let rest = text[at + 1..].trim_start_matches(['*', ')', '"', '_']);
        let next = rest.trim_start();
        let begins = next.starts_with("deltaq") || next.starts_with(|c: char| c.is_uppercase() || "x*([".contains(c));
        if rest.len() != next.len() && begins {
            let end = text.len() - rest.len();
            found.push(&text[begin..end]);
            begin = end;
        }
    }
    found.push(&text[begin..]);
    found
}

/// Habits in a text, and what to say instead.
fn habits(text: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let lower = format!(" {} ", text.to_lowercase());
    let too = [", too.", ", too;", ", too:", ", too)", ", too "].iter().any(|habit| match *habit {
        ", too " => lower.ends_with(habit),
        habit => lower.contains(habit),
    });
    let known = HABITS.into_iter().filter(move |(habit, _)| {
        lower.match_indices(habit).any(|(at, _)| {
            let before = lower[..at].trim_end().rsplit(' ').next().unwrap_or_default();
            let after = lower[at + habit.len()..].split(' ').next().unwrap_or_default();
            let is_verb = habit.starts_with(" is") || habit.starts_with(" are");
            !(is_verb && (before.ends_with("here") || ["longer", "more"].contains(&after)))
        })
    });
    known.chain(too.then_some((", too", "also")))
}

/// Habits in what a user reads of a source: messages of errors, help of the command line, the front page of a
/// crate.
fn in_source(name: &str, text: &str) -> Vec<String> {
    let front = name.ends_with("/src/lib.rs") || name.ends_with("/src/main.rs");
    let help = name.contains("/src/cli");
    let mut faults = Vec::new();
    let (mut message, mut read) = (false, String::new());
    for line in text.lines().map(str::trim) {
        message |= line.starts_with("#[error(");
        let doc = line.strip_prefix("//!").filter(|_| front).or(line.strip_prefix("///").filter(|_| help));
        match doc.or(message.then_some(line)) {
            Some(words) => read = read + " " + words.trim_end_matches('\\').trim(),
            None => read += "\n",
        }
        message &= !line.ends_with(")]");
    }
    for part in read.split('\n').filter(|part| !part.is_empty()) {
        faults.extend(habits(&prose(part)).map(|(habit, better)| format!("{name} `{}`: {better}", habit.trim())));
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn habits_are_found() {
        let found = |text: &str| habits(text).map(|(habit, _)| habit.trim()).collect::<Vec<_>>();
        assert_eq!(found("`x` is no coordinate"), ["is no"]);
        assert_eq!(found("They are no reals, likewise."), ["are no", "likewise"]);
        assert_eq!(found("It stands in the place of f, and no other, too."), ["in the place of", ", and no", ", too"]);
        assert_eq!(found("All but for one, too"), ["but for", ", too"]);
        for text in ["There is no proof.", "it is no longer finite", "too many, too few", "is not a coordinate"] {
            assert!(found(text).is_empty(), "{text}");
        }
    }

    #[test]
    fn long_sentences_and_pages_are_found() {
        let sentence = |words: usize| format!("{}.", vec!["word"; words].join(" "));
        let faults = |text: &str| Page::of("p.md", text).faults();
        assert!(faults(&sentence(SENTENCE)).is_empty());
        assert_eq!(faults(&sentence(SENTENCE + 1)).len(), 1);
        assert_eq!(faults(&format!("{} Next `a b c` one.", sentence(SENTENCE - 1))).len(), 0);
        assert_eq!(faults(&format!("```text\n{}\n```\n", sentence(99))).len(), 0);
        let page = format!("{} ", sentence(10)).repeat(PAGE / 10 + 1).replace("word word", "Word word");
        assert_eq!(faults(&page).len(), 1);
    }

    #[test]
    fn messages_help_and_front_pages_are_read() {
        let error = "#[error(\n    \"`{name}` is no name: \\\n     {why}\"\n)]";
        assert_eq!(in_source("crates/a/src/error.rs", error).len(), 1);
        assert_eq!(in_source("crates/a/src/lib.rs", "//! It is no\n//! sum.\n").len(), 1);
        assert_eq!(in_source("crates/a/src/cli.rs", "/// Prints it, too.\n").len(), 1);
        let short = "#[error(\"a\")]\nIt is no variant";
        assert_eq!(in_source("crates/a/src/error.rs", short).len(), 0);
        assert_eq!(in_source("crates/a/src/b.rs", "// it is no sum\nlet x = 1;\n").len(), 0);
    }
}
