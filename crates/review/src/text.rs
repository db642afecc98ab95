//! Equations as text: one per line, in the notation of scenes.

use crate::reading::Line;

/// The lines of `text`, without comments (`#`, `//`, `%`) and empty ones.
pub(crate) fn lines(file: &str, text: &str) -> Vec<Line> {
    let mut lines = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let end = ["#", "//", "%"].iter().filter_map(|mark| line.find(mark)).min().unwrap_or(line.len());
        for part in line[..end].split(';').filter(|part| !part.trim().is_empty()) {
            lines.push(Line { place: format!("{file}:{number}"), text: part.to_owned(), defines: false });
        }
    }
    lines
}
