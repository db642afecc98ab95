//! A line of a text with carets under a place in it.

use crate::limits::LINE;

/// A window of `line` round `column` (in characters, from 1), with carets under the next `length` characters.
///
/// ```
/// assert_eq!(symbolic::excerpt("1 + 2 x", 7, 1), ["1 + 2 x", "      ^"]);
/// ```
pub fn excerpt(line: &str, column: usize, length: usize) -> [String; 2] {
    let line = line.trim_end_matches('\r');
    let before = column.saturating_sub(1);
    let first = before.saturating_sub(LINE);
    let dots = |cut: bool| if cut { "…" } else { "" };
    // control characters, tabs among them, become spaces, so that the carets stand right
    let printable = |c: char| if c.is_control() { ' ' } else { c };
    let shown: String = line.chars().skip(first).take(before - first + LINE).map(printable).collect();
    let shown = format!("{}{shown}{}", dots(first > 0), dots(line.chars().count() > before + LINE));
    let margin = before - first + usize::from(first > 0);
    [shown, " ".repeat(margin) + &"^".repeat(length.clamp(1, LINE))]
}
