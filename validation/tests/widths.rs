//! No table of a committed page is wider than the page: 850 pixels of a column on a screen, in letters of 16.

use std::path::{Path, PathBuf};

const PAGE: f64 = 850.0;
/// Padding left and right, and a border.
const AROUND: f64 = 27.0;

/// Width of a character of a sans-serif letter (Noto Sans), in pixels.
fn width(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | 'I' => 4.5,
        ' ' | 'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' | '/' => 5.5,
        'm' | 'w' | 'M' | 'W' | '@' => 14.0,
        'A'..='Z' => 10.3,
        _ => 9.15,
    }
}

/// A cell as it is read: links by their text, formulas without their commands, no marks of Markdown.
fn shown(cell: &str) -> String {
    let mut text = String::new();
    let mut rest = cell.trim();
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        match c {
            ']' if rest.starts_with('(') => rest = rest.split_once(')').map_or("", |(_, behind)| behind),
            '\\' if rest.starts_with(|c: char| c.is_ascii_alphabetic()) => {
                rest = rest.trim_start_matches(|c: char| c.is_ascii_alphabetic());
                text.push('x');
            }
            '[' | '*' | '`' | '$' | '{' | '}' | '^' | '_' | '\\' => {}
            c => text.push(c),
        }
    }
    text
}

/// The longest part of a cell in which a browser ends no line: a word, a formula.
fn longest(cell: &str) -> f64 {
    let breaks = |c: char| c == ' ' || c == '-';
    let of = |part: &str| shown(part).trim_end().chars().map(width).sum::<f64>();
    let parts = cell.split('$').enumerate();
    parts.fold(0.0_f64, |most, (i, part)| match i % 2 {
        // digits and letters of formulas are narrower
        1 => most.max(0.85 * of(part)),
        _ => part.split_inclusive(breaks).map(of).fold(most, f64::max),
    })
}

/// The least widths of the tables of a page, with the line in which each begins.
fn tables(page: &str) -> Vec<(usize, f64)> {
    let mut tables: Vec<(usize, Vec<f64>)> = Vec::new();
    let mut inside = false;
    for (number, line) in page.lines().enumerate() {
        let line = line.trim();
        let is_row = line.starts_with('|') && line.len() > 1;
        if is_row && !inside {
            tables.push((number + 1, Vec::new()));
        }
        inside = is_row;
        let (Some((_, columns)), true) = (tables.last_mut(), is_row) else { continue };
        let line = line.replace("\\|", "∣");
        for (i, cell) in line.trim_matches('|').split('|').enumerate() {
            let least = if cell.trim_matches(['-', ':', ' ']).is_empty() { 0.0 } else { longest(cell) };
            match columns.get_mut(i) {
                Some(column) => *column = column.max(least),
                None => columns.push(least),
            }
        }
    }
    tables.into_iter().map(|(line, columns)| (line, columns.iter().map(|column| column + AROUND).sum())).collect()
}

fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            pages(&entry, found);
        } else if entry.extension().is_some_and(|extension| extension == "md") {
            found.push(entry);
        }
    }
}

#[test]
fn no_table_is_wider_than_a_page() {
    let mut found = Vec::new();
    pages(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports"), &mut found);
    let mut wide = Vec::new();
    for path in &found {
        let text = std::fs::read_to_string(path).expect("a page");
        let over = tables(&text).into_iter().filter(|(_, width)| *width > PAGE);
        wide.extend(over.map(|(line, width)| format!("{}:{line}: {width:.0} pixels", path.display())));
    }
    assert!(found.len() > 20 && wide.is_empty(), "{} pages; too wide:\n{}", found.len(), wide.join("\n"));
}

#[test]
fn a_wide_table_is_seen() {
    let row = |cell: &str| format!("| {} |\n", [cell; 12].join(" | "));
    let rule = "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    let width = |cell: &str| tables(&(row("x") + rule + &row(cell)))[0].1;
    assert!(width("5.2e−11") > PAGE && width("5e−1") < PAGE, "{} and {}", width("5.2e−11"), width("5e−1"));
    assert!(width("so we do it as an ox") < PAGE, "{}", width("many tiny words in a row"));
}
