//! Pages of prose in their parts.

use anyhow::{Context, Result};

/// Folders whose pages are checked, and pages elsewhere.
const FOLDERS: [&str; 2] = ["docs/", "reports/"];
const OTHERS: [&str; 5] = ["README.md", "NOTATION.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "crates/python/README.md"];

pub(crate) fn is_page(name: &str) -> bool {
    let is_in_folder = name.ends_with(".md") && FOLDERS.iter().any(|folder| name.starts_with(folder));
    OTHERS.contains(&name) || is_in_folder
}

/// Whether a program writes the page, so that nobody types its numbers.
pub(crate) fn is_written(name: &str) -> bool {
    name.starts_with("reports/")
}

/// A page in its parts.
#[derive(Clone)]
pub(crate) struct Page {
    pub(crate) name: String,
    /// Paragraphs, items of lists, rows of tables, headings: their line and their Markdown.
    pub(crate) parts: Vec<(usize, String)>,
    /// What stands in fences.
    pub(crate) fenced: String,
}

impl Page {
    pub(crate) fn read(name: &str) -> Result<Page> {
        Ok(Page::of(name, &std::fs::read_to_string(name).context(name.to_owned())?))
    }

    pub(crate) fn of(name: &str, text: &str) -> Page {
        let (mut parts, mut fenced, mut inside) = (Vec::<(usize, String)>::new(), String::new(), false);
        let mut open = false;
        for (number, line) in (1..).zip(text.lines()) {
            let (line, fence) = (line.trim(), line.trim_start().starts_with("```"));
            if fence || inside {
                (inside, open) = (inside != fence, false);
                fenced += line;
                fenced.push('\n');
                continue;
            }
            let item = line.starts_with("- ") || line.split_once(". ").is_some_and(|(n, _)| n.parse::<u8>().is_ok());
            let alone = line.starts_with(['|', '#']);
            match parts.last_mut() {
                Some((_, part)) if open && !item && !alone && !line.is_empty() => *part += &format!(" {line}"),
                _ if line.is_empty() => {}
                _ => parts.push((number, line.to_owned())),
            }
            open = !alone && !line.is_empty();
        }
        Page { name: name.into(), parts, fenced }
    }
}

/// The text without targets of links; code and formulas are one word each.
pub(crate) fn prose(markdown: &str) -> String {
    let (mut text, mut rest) = (String::new(), markdown);
    while let Some(c) = rest.chars().next() {
        let end = match c {
            '`' | '$' => rest[1..].find(c).map(|end| (end + 2, "x")),
            '<' if rest[1..].starts_with(|c: char| c.is_ascii_alphabetic() || c == '/') => {
                rest.find('>').map(|end| (end + 1, ""))
            }
            ']' if rest[1..].starts_with('(') => rest.find(')').map(|end| (end + 1, "")),
            _ => None,
        };
        let (taken, shown) = end.unwrap_or((c.len_utf8(), &rest[..c.len_utf8()]));
        text += shown;
        rest = &rest[taken..];
    }
    text
}
