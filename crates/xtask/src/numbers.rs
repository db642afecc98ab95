//! Every number that is typed into prose has a source.
//!
//! A source is a block in fences on the same page, which tests run; a page that is linked in the same
//! paragraph, which the main job writes; or a line of `docs/numbers.txt`,
//!
//! ```text
//! docs/guide.md | 600 | MEMORY: usize = 600 << 20
//! ```
//!
//! which says what text of a source or test contains the number, or several numbers as they stand on the
//! page. A linked page is a source where one of its lines has the number beside a word of the paragraph. Not
//! asked are whole numbers of one digit, years, and formulas up to two digits. A theorem that is cited exists
//! under this number, which is also that of the place it links to.

use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result};

use crate::pages::{Page, is_written, prose};

const LIST: &str = "docs/numbers.txt";
/// Words before the number of a statement.
const STATEMENTS: [&str; 6] = ["Theorem", "Theorems", "Proposition", "Propositions", "Lemma", "RFC"];

/// What is listed for a number on a page.
struct Listed<'a> {
    page: &'a str,
    numbers: &'a str,
    text: &'a str,
}

impl Listed<'_> {
    /// Whether it is about this number, in this paragraph of a page.
    fn is_of(&self, page: &str, part: &str, number: &str) -> bool {
        self.page == page && holds(part, self.numbers) && holds(self.numbers, number)
    }
}

/// Faults of all numbers; how many were looked at.
pub(crate) fn check(pages: &[Page], names: &[String], faults: &mut Vec<String>) -> Result<usize> {
    let list = std::fs::read_to_string(LIST).context(LIST)?;
    let listed: Vec<Listed> = list.lines().filter_map(read).collect();
    let is_source =
        |name: &&String| [".rs", ".toml", ".py", "theory.md"].iter().any(|end| name.ends_with(end)) || is_written(name);
    let sources: Vec<String> =
        names.iter().filter(is_source).filter_map(|name| std::fs::read_to_string(name).ok()).collect();
    for Listed { page, numbers, text } in &listed {
        if !plain(text).contains(&plain(numbers)) {
            faults.push(format!("{LIST}: {numbers} of {page} is not in `{text}`"));
        } else if !sources.iter().any(|source| source.contains(text)) {
            faults.push(format!("{LIST}: no source contains `{text}`"));
        } else if !pages.iter().any(|own| own.name == *page && own.parts.iter().any(|(_, part)| holds(part, numbers))) {
            faults.push(format!("{LIST}: {numbers} is not on {page}"));
        }
    }
    let mut counted = 0;
    for page in pages.iter().filter(|page| !is_written(&page.name)) {
        counted += each(page, &listed, faults);
    }
    Ok(counted)
}

fn read(line: &str) -> Option<Listed<'_>> {
    let mut parts = line.splitn(3, '|').map(str::trim);
    Some(Listed { page: parts.next()?, numbers: parts.next()?, text: parts.next()? })
}

/// Faults of the numbers of a page.
fn each(page: &Page, listed: &[Listed], faults: &mut Vec<String>) -> usize {
    let mut counted = 0;
    for (line, part) in &page.parts {
        let linked: Vec<String> =
            links(&page.name, part).filter_map(|path| std::fs::read_to_string(path).ok()).collect();
        for number in numbers(part) {
            counted += 1;
            let is_listed = listed.iter().any(|own| own.is_of(&page.name, part, &number));
            let known =
                is_listed || holds(&page.fenced, &number) || linked.iter().any(|text| says(text, &number, part));
            if !known {
                faults.push(format!("{}:{line} {number} has no source: link it, or list it in {LIST}", page.name));
            }
        }
    }
    counted
}

/// Files that are linked.
fn links(page: &str, part: &str) -> impl Iterator<Item = PathBuf> {
    let folder = Path::new(page).parent().unwrap_or(Path::new("")).to_owned();
    let targets: Vec<&str> = part.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()).collect();
    let place = move |target: &str| {
        let mut path = PathBuf::new();
        for component in folder.join(target).components() {
            match component {
                Component::ParentDir => drop(path.pop()),
                other => path.push(other),
            }
        }
        path
    };
    targets.into_iter().filter(|target| !target.contains("://")).map(place).collect::<Vec<_>>().into_iter()
}

/// The numbers of a paragraph that need a source.
fn numbers(part: &str) -> Vec<String> {
    let mut found = scan(&prose(part), 2);
    // in formulas, only what was measured
    let formulas: String = part.split('$').skip(1).step_by(2).map(|formula| format!("{formula} ")).collect();
    found.extend(scan(&formulas, 3));
    found
}

/// Numbers with this many digits that count, or more; with a decimal point or a power of ten always in prose.
fn scan(text: &str, least: usize) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let digit = |i: usize| chars.get(i).is_some_and(char::is_ascii_digit);
    let (mut found, mut i) = (Vec::new(), 0);
    while i < chars.len() {
        let glued = i > 0 && (chars[i - 1].is_alphanumeric() || "._/-:^".contains(chars[i - 1]));
        if !digit(i) || glued {
            i += 1;
            continue;
        }
        let begin = i;
        let group = |i: usize| chars.get(i) == Some(&',') && (1..4).all(|k| digit(i + k)) && !digit(i + 4);
        while digit(i) || chars.get(i) == Some(&'.') && digit(i + 1) || group(i) {
            i += 1;
        }
        if chars.get(i) == Some(&'e')
            && (digit(i + 1) || chars.get(i + 1).is_some_and(|c| "-−+".contains(*c)) && digit(i + 2))
        {
            i += 2;
            while digit(i) {
                i += 1;
            }
        }
        let number: String = chars[begin..i].iter().collect();
        let before: String = chars[..begin].iter().collect();
        let word = before.trim_end().rsplit(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
        let (mantissa, power) = number.split_once('e').map_or((&number[..], false), |(m, _)| (m, true));
        let digits = plain(mantissa).replace('.', "").trim_start_matches('0').len();
        let year = mantissa.len() == 4 && number.parse::<u16>().is_ok_and(|year| (1600..2100).contains(&year));
        let ordinal = begin == 0 && chars.get(i) == Some(&'.');
        let counts = digits >= least || least == 2 && (power || number.contains('.'));
        if counts
            && !year
            && !ordinal
            && !STATEMENTS.contains(&word)
            && !chars.get(i).is_some_and(|c| c.is_alphabetic())
        {
            found.push(number);
        }
    }
    found
}

/// Whether a line of this text has the number and a word of the paragraph.
fn says(text: &str, number: &str, part: &str) -> bool {
    let own = words(&prose(part));
    text.lines().any(|line| holds(line, number) && words(line).iter().any(|word| own.contains(word)))
}

/// Words of at least four letters, without endings of plurals.
fn words(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_alphabetic()).filter(|word| word.len() > 3);
    words.map(|word| word.to_lowercase().trim_end_matches('s').to_owned()).collect()
}

fn plain(number: &str) -> String {
    number.replace([',', '_'], "").replace('−', "-")
}

/// Whether a text contains this number, not as a part of another one.
fn holds(text: &str, number: &str) -> bool {
    let (text, number) = (plain(text), plain(number));
    text.match_indices(&number).any(|(at, _)| {
        let is_part = |c: char| c.is_ascii_digit() || c == '.';
        let after = text[at + number.len()..].trim_start_matches("[..]");
        !text[..at].ends_with(is_part) && !after.starts_with(|c: char| c.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_need_a_source() {
        assert_eq!(scan("41 samples, 2 of 1,000 at 1e-3, 0.5 s, 3.14", 2), ["41", "1,000", "1e-3", "0.5", "3.14"]);
        for text in ["in 1995", "Theorem 12", "x12", "lambda_12", "5 of 7", "1. one"] {
            assert!(scan(text, 2).is_empty(), "{text}");
        }
        assert_eq!(numbers("it is $x(2) = 1.99$ m, `10` and [a](12.md)"), ["1.99"]);
        assert_eq!(links("docs/a.md", "[b](../reports/c.md#d)").collect::<Vec<_>>(), [Path::new("reports/c.md")]);
    }

    #[test]
    fn a_number_is_not_a_part_of_another() {
        assert!(holds("a 1e-3, 4096.", "4096") && holds("1_000_000", "1,000,000") && holds("2.51[..]", "2.51"));
        assert!(!holds("14096", "4096") && !holds("40961", "4096") && !holds("0.15", "15"));
    }

    /// Of every number of every page one digit is changed: each change is found.
    #[test]
    fn a_falsified_number_is_found() {
        std::env::set_current_dir(crate::root()).expect("the project");
        let list = std::fs::read_to_string(LIST).expect("the list");
        let listed: Vec<Listed> = list.lines().filter_map(read).collect();
        let (mut tried, mut missed) = (0, Vec::new());
        for name in crate::sources::names()
            .expect("names")
            .iter()
            .filter(|name| crate::pages::is_page(name) && !is_written(name))
        {
            let page = Page::of(name, &std::fs::read_to_string(name).expect("a page"));
            for (line, part) in &page.parts {
                for number in numbers(part) {
                    let last = number.rfind(|c: char| c.is_ascii_digit()).expect("a digit");
                    let digit = number.as_bytes()[last] - b'0';
                    let wrong = format!("{}{}{}", &number[..last], (digit + 3) % 10, &number[last + 1..]);
                    let forged = part.replacen(&number, &wrong, 1);
                    let forged = Page { name: name.clone(), parts: vec![(*line, forged)], fenced: page.fenced.clone() };
                    let mut faults = Vec::new();
                    each(&forged, &listed, &mut faults);
                    tried += 1;
                    if !faults.iter().any(|fault| fault.contains(&format!(" {wrong} "))) {
                        missed.push(format!("{name}:{line}: {wrong} instead of {number}"));
                    }
                }
            }
        }
        println!("{tried} numbers, each with one wrong digit; not found: {missed:?}");
        assert!(tried >= 20 && missed.is_empty(), "{missed:?}");
    }
}
