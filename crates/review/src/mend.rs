//! Which term of a text is wrong: one after the other is turned round, dropped, halved and doubled, and the
//! review says which of these changes makes the equations right.

use std::ops::Range;

use scene::Scene;
use symbolic::limits::LONG;

use crate::{Asked, Notation, Verdict};

/// A factor of one term that makes equations right, with what it says of the term.
const CHANGES: [(&str, &str); 4] = [
    ("(-1)", "has the wrong sign"),
    ("0", "does not belong there"),
    ("(1/2)", "is twice as large as it should be"),
    ("2", "is half as large as it should be"),
];

/// A term that alone makes equations wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mend {
    /// Its line, from 1.
    pub line: usize,
    /// Its first character, from 1.
    pub column: usize,
    /// Its characters.
    pub term: String,
    /// What is wrong with it.
    pub fault: &'static str,
}

/// The terms of `text`, each of which alone makes wrong equations of right ones; none in another notation
/// than [`Notation::Text`].
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let sledge = scene::catalogue::find("sledge", &[])?;
/// let theirs = "x'' = g*sin(alpha) - l*sin(phi)
///               y'' = l*cos(phi)
///               phi'' = 0*t
///               y'*cos(phi) + x'*sin(phi) = 0";
/// let mends = review::mends(&sledge, theirs, &review::Asked::default());
/// assert!(mends.iter().any(|m| (m.line, &m.term[..], m.fault) == (4, "x'*sin(phi)", "has the wrong sign")));
/// # Ok(())
/// # }
/// ```
pub fn mends(scene: &Scene, text: &str, asked: &Asked) -> Vec<Mend> {
    if Notation::of("", text) != Notation::Text {
        return Vec::new();
    }
    let lines: Vec<&str> = text.lines().collect();
    let places: Vec<_> =
        (0..lines.len()).flat_map(|i| terms(lines[i]).into_iter().map(move |term| (i, term))).collect();
    // so that there is an answer within seconds
    if places.len() > LONG {
        return Vec::new();
    }
    let mut found: Vec<Mend> = Vec::new();
    for (i, at) in places {
        let line = lines[i];
        let term = &line[at.clone()];
        let is_right = |factor: &str| {
            let changed = format!("{}{factor}*({term}){}", &line[..at.start], &line[at.end..]);
            let text: Vec<&str> =
                lines.iter().enumerate().map(|(j, line)| if i == j { &changed } else { *line }).collect();
            crate::read(scene, "", &text.join("\n"), asked, false).is_ok_and(|review| review.verdict == Verdict::Right)
        };
        if let Some((_, fault)) = CHANGES.into_iter().find(|(factor, _)| is_right(factor)) {
            let column = line[..at.start].chars().count() + 1;
            found.push(Mend { line: i + 1, column, term: term.to_owned(), fault });
        }
    }
    found
}

/// What is added up in a line, in brackets, too: places in bytes, the longer one first.
fn terms(line: &str) -> Vec<Range<usize>> {
    let end = ["#", "//", "%"].iter().filter_map(|mark| line.find(mark)).min().unwrap_or(line.len());
    let (mut found, mut starts, mut before) = (Vec::new(), vec![0], [' ', ' ']);
    let mut close = |start: usize, end: usize| {
        let term = &line[start..end];
        let from = start + term.len() - term.trim_start().len();
        if term.contains(char::is_alphabetic) {
            found.push(from..from + term.trim().len());
        }
    };
    for (i, c) in line[..end].char_indices() {
        let is_exponent = matches!(before[1], 'e' | 'E') && (before[0].is_ascii_digit() || before[0] == '.');
        match c {
            '(' | '[' => starts.push(i + 1),
            ')' | ']' if starts.len() > 1 => close(starts.pop().unwrap_or_default(), i),
            '+' | '-' if matches!(before[1], '*' | '/' | '^') || is_exponent => {}
            '+' | '-' | '=' | ',' | ';' => {
                if let Some(start) = starts.last_mut() {
                    close(std::mem::replace(start, i + 1), i);
                }
            }
            _ => {}
        }
        if c != ' ' {
            before = [before[1], c];
        }
    }
    starts.into_iter().for_each(|start| close(start, end));
    found.sort_by_key(|term| (term.start, std::cmp::Reverse(term.end)));
    found
}
