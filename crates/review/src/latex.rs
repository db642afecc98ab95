//! Equations in LaTeX of the common kind, as lines in the notation of scenes.

use std::collections::HashMap;

use symbolic::Graph;

use crate::ReviewError;
use crate::reading::Line;

/// What only arranges.
const BLANKS: &str = "quad qquad left right bigl bigr Bigl Bigr big Big nonumber displaystyle limits hfill";
const FUNCTIONS: &str = "sin cos tan cot sec csc sinh cosh tanh exp ln log arcsin arctan";

/// The equations of `text`; `names` are those that the scene and their side have.
///
/// # Errors
/// [`ReviewError::Unreadable`] with the place.
pub(crate) fn lines(g: &Graph, names: &[String], file: &str, text: &str) -> Result<Vec<Line>, ReviewError> {
    let plain = |latex: String| latex.replace(['{', '}', ' '], "");
    let table: HashMap<String, String> =
        names.iter().map(|name| (plain(g.latex_symbol(g.symbol(name))), name.clone())).collect();
    let mut lines = Vec::new();
    for (number, piece) in pieces(text) {
        let characters: Vec<char> = piece.chars().collect();
        let mut reader = Reader { characters: &characters, at: 0, depth: 0, table: &table };
        let place = format!("{file}:{number}");
        let text = reader.sum(None).map_err(|what| {
            let near: String = characters.iter().skip(reader.at.saturating_sub(1)).take(20).collect();
            ReviewError::Unreadable { place: place.clone(), what: format!("{what}, near `{}`", near.trim()) }
        })?;
        if !text.trim().is_empty() {
            lines.push(Line { place, text, defines: false });
        }
    }
    Ok(lines)
}

/// Equations with the lines at which they begin: they end at `\\`, at the end of an environment or formula,
/// at an empty line, and before a line with a further `=`.
fn pieces(text: &str) -> Vec<(usize, String)> {
    let mut pieces: Vec<(usize, String)> = vec![(1, String::new())];
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('%').next().unwrap_or_default().trim();
        let ends = line.is_empty() || line.starts_with("```");
        let open = pieces.last().is_some_and(|(_, piece)| piece.contains('='));
        if ends || open && line.contains('=') {
            pieces.push((number, String::new()));
        }
        if line.starts_with("```") {
            continue;
        }
        let mut rest = line.to_owned();
        for mark in ["\\begin", "\\end"] {
            while let Some(at) = rest.find(mark) {
                let end = rest[at..].find('}').map_or(rest.len(), |end| at + end + 1);
                rest.replace_range(at..end, "\\\\");
            }
        }
        for mark in ["\\[", "\\]", "$$", "$"] {
            rest = rest.replace(mark, "\\\\");
        }
        for (i, part) in rest.split("\\\\").enumerate() {
            if i > 0 {
                pieces.push((number, String::new()));
            }
            if let Some((first, piece)) = pieces.last_mut() {
                if piece.trim().is_empty() {
                    *first = number;
                }
                piece.push(' ');
                piece.push_str(part);
            }
        }
    }
    // the rest is words
    pieces.retain(|(_, piece)| piece.contains('='));
    pieces
}

struct Reader<'a> {
    characters: &'a [char],
    at: usize,
    /// Operands that are within one another.
    depth: usize,
    table: &'a HashMap<String, String>,
}

impl Reader<'_> {
    fn peek(&mut self) -> Option<char> {
        while self.characters.get(self.at).is_some_and(|c| c.is_whitespace() || *c == '&' || *c == '~') {
            self.at += 1;
        }
        self.characters.get(self.at).copied()
    }

    fn word(&mut self, part: impl Fn(char) -> bool) -> String {
        self.at = self.at.min(self.characters.len());
        let from = self.at;
        while self.characters.get(self.at).is_some_and(|&c| part(c)) {
            self.at += 1;
        }
        self.characters[from..self.at].iter().collect()
    }

    /// Everything up to `end`.
    fn sum(&mut self, end: Option<char>) -> Result<String, String> {
        let (mut text, mut operand) = (String::new(), false);
        while let Some(c) = self.peek() {
            if Some(c) == end {
                self.at += 1;
                return Ok(text);
            }
            if ",.;".contains(c) && end.is_none() {
                self.at += 1;
            } else if "+-=*/".contains(c) {
                self.at += 1;
                text.push(c);
                operand = false;
            } else if c == '^' {
                self.at += 1;
                text += &format!("^({})", self.argument()?);
            } else if let Some(part) = self.operand()? {
                match part.as_str() {
                    "*" => operand = false,
                    _ if operand => text.push('*'),
                    _ => operand = true,
                }
                text += &part;
            }
        }
        end.map_or(Ok(text), |end| Err(format!("`{end}` is missing")))
    }

    /// `{…}`, or the next sign.
    fn argument(&mut self) -> Result<String, String> {
        match self.peek() {
            Some('{') => {
                self.at += 1;
                self.sum(Some('}'))
            }
            Some(c) if c.is_ascii_digit() => {
                self.at += 1;
                Ok(c.to_string())
            }
            _ => self.operand()?.ok_or_else(|| "something is missing".into()),
        }
    }

    /// A number, name, group or function; nothing where a sign only arranges.
    fn operand(&mut self) -> Result<Option<String>, String> {
        let Some(c) = self.peek() else { return Err("the formula ends too early".into()) };
        if self.depth == 200 {
            return Err("more than 200 operands stand within one another".into());
        }
        self.depth += 1;
        let found = self.operand_at(c);
        self.depth -= 1;
        found
    }

    fn operand_at(&mut self, c: char) -> Result<Option<String>, String> {
        let group = |reader: &mut Self, end| {
            reader.at += 1;
            reader.sum(Some(end)).map(|inner| Some(format!("({inner})")))
        };
        match c {
            '(' => group(self, ')'),
            '[' => group(self, ']'),
            '{' => group(self, '}'),
            c if c.is_ascii_digit() => Ok(Some(self.word(|c| c.is_ascii_digit() || c == '.'))),
            c if c.is_alphabetic() => {
                self.at += 1;
                self.name(c.to_string(), 0).map(Some)
            }
            '\\' => {
                self.at += 1;
                let command = self.word(|c| c.is_ascii_alphabetic());
                self.command(&command)
            }
            other => Err(format!("`{other}` cannot stand here")),
        }
    }

    fn command(&mut self, command: &str) -> Result<Option<String>, String> {
        if command.is_empty() {
            self.at += 1;
            return Ok(None);
        }
        if BLANKS.split(' ').any(|own| own == command) {
            return Ok(None);
        }
        if FUNCTIONS.split(' ').any(|own| own == command) {
            return self.call(&command.replace("arc", "a").replace("log", "ln")).map(Some);
        }
        match command {
            "cdot" | "times" => Ok(Some("*".into())),
            "frac" | "dfrac" | "tfrac" => {
                let (top, bottom) = (self.argument()?, self.argument()?);
                Ok(Some(format!("(({top})/({bottom}))")))
            }
            "sqrt" if self.peek() != Some('[') => Ok(Some(format!("sqrt({})", self.argument()?))),
            "dot" | "ddot" => self.name(String::new(), command.len() - 2).map(Some),
            "mathrm" | "operatorname" | "text" | "mathit" | "label" => {
                self.peek();
                self.at += 1;
                let word = self.word(|c| c != '}').replace('\\', "");
                self.at += 1;
                if command == "label" { Ok(None) } else { self.name(format!("\\mathrm{word}"), 0).map(Some) }
            }
            "sqrt" | "int" | "sum" | "partial" => Err(format!("`\\{command}` is not read")),
            letter => self.name(format!("\\{letter}"), 0).map(Some),
        }
    }

    /// A function: its power before its argument, which is a group, or a number and a name.
    fn call(&mut self, function: &str) -> Result<String, String> {
        let mut power = String::new();
        if self.peek() == Some('^') {
            self.at += 1;
            power = format!("^({})", self.argument()?);
        }
        let mut parts = Vec::new();
        loop {
            let number = self.peek().is_some_and(|c| c.is_ascii_digit());
            let Some(part) = self.operand()? else { continue };
            parts.push(part);
            if !number {
                break;
            }
        }
        if self.peek() == Some('t') && !parts[0].starts_with('(') {
            self.at += 1;
            parts.push("t".into());
        }
        Ok(format!("{function}({}){power}", parts.join("*")))
    }

    /// The scene's name for a letter with dots and a subscript.
    fn name(&mut self, mut letter: String, mut dots: usize) -> Result<String, String> {
        if letter.is_empty() {
            let braced = self.peek() == Some('{');
            self.at += usize::from(braced);
            self.peek();
            letter = match self.word(|c| c == '\\').len() {
                0 => self.characters.get(self.at).map(char::to_string).unwrap_or_default(),
                _ => format!("\\{}", self.word(|c| c.is_ascii_alphabetic())),
            };
            self.at += usize::from(!letter.starts_with('\\'));
            if letter == "\\mathrm" {
                self.at += 1;
                letter += &self.word(|c| c != '}');
                self.at += 1;
            }
            letter += &self.subscript();
            if braced && self.peek() == Some('}') {
                self.at += 1;
            }
        }
        letter += &self.subscript();
        while self.peek() == Some('\'') {
            self.at += 1;
            dots += 1;
        }
        let plain = || {
            let bare = letter.replace("\\mathrm", "").replace("\\var", "").replace('\\', "");
            bare.replace(',', "_")
        };
        Ok(self.table.get(&letter).cloned().unwrap_or_else(plain) + &"'".repeat(dots))
    }

    fn subscript(&mut self) -> String {
        if self.peek() != Some('_') {
            return String::new();
        }
        self.at += 1;
        if self.peek() != Some('{') {
            let sign = self.peek().map_or_else(String::new, String::from);
            self.at += 1;
            return format!("_{sign}");
        }
        self.at += 1;
        let mut depth = 1;
        let mut text = String::from("_");
        while let Some(&c) = self.characters.get(self.at) {
            self.at += 1;
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                c if !c.is_whitespace() => text.push(c),
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
        text
    }
}
