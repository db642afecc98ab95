//! Equations in LaTeX of the common kind, rewritten in the notation of scenes.

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
    let table = names.iter().map(|name| (plain(g.latex_symbol(g.symbol(name))), name.clone())).collect();
    let mut lines = Vec::new();
    for (number, piece) in pieces(text) {
        let mut reader = Reader { tokens: tokens(&piece), at: 0, depth: 0, table: &table };
        let place = format!("{file}:{number}");
        let text = reader.sum("").map_err(|what| {
            let near: String = reader.tokens.iter().skip(reader.at.saturating_sub(1)).take(12).copied().collect();
            ReviewError::Unreadable { place: place.clone(), what: format!("{what}, near `{near}`") }
        })?;
        lines.push(Line { place, text, defines: false });
    }
    Ok(lines)
}

/// Equations with the lines at which they begin: they end at `\\`, at the end of an environment or formula,
/// at an empty line, and before a line with a further `=`.
fn pieces(text: &str) -> Vec<(usize, String)> {
    let mut pieces: Vec<(usize, String)> = vec![(1, String::new())];
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.split('%').next().unwrap_or_default().trim();
        let mut rest = if line.is_empty() || line.starts_with("```") { "$".to_owned() } else { line.to_owned() };
        for mark in ["\\begin", "\\end"] {
            while let Some(at) = rest.find(mark) {
                let end = rest[at..].find('}').map_or(rest.len(), |end| at + end + 1);
                rest.replace_range(at..end, "$");
            }
        }
        if line.contains('=') && pieces.last().is_some_and(|(_, piece)| piece.contains('=')) {
            rest.insert(0, '$');
        }
        for mark in ["\\\\", "\\[", "\\]"] {
            rest = rest.replace(mark, "$");
        }
        for (i, part) in rest.split('$').enumerate() {
            match pieces.last_mut() {
                Some((_, piece)) if i == 0 && !piece.trim().is_empty() => *piece += &format!(" {part}"),
                _ => pieces.push((number, part.to_owned())),
            }
        }
    }
    // the rest is words
    pieces.retain(|(_, piece)| piece.contains('='));
    pieces
}

/// Commands, digits and other signs, without those that only arrange.
fn tokens(text: &str) -> Vec<&str> {
    let (mut tokens, mut rest) = (Vec::new(), text);
    while let Some(c) = rest.chars().next() {
        let letters = |text: &str| text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
        let second = rest[c.len_utf8()..].chars().next().map_or(0, char::len_utf8);
        let length = match c {
            '\\' => 1 + letters(&rest[1..]).max(second),
            _ => c.len_utf8(),
        };
        let (token, after) = rest.split_at(length);
        let command = token.strip_prefix('\\').unwrap_or("x");
        let is_spacing = !command.starts_with(|c: char| c.is_ascii_alphabetic());
        rest = match token {
            "\\label" => after.split_once('}').unwrap_or_default().1,
            _ => after,
        };
        let arranges =
            c.is_whitespace() || "&~".contains(c) || is_spacing || BLANKS.split(' ').any(|own| own == command);
        if !arranges && token != "\\label" {
            tokens.push(token);
        }
    }
    tokens
}

struct Reader<'t> {
    tokens: Vec<&'t str>,
    at: usize,
    /// Operands that are within one another.
    depth: usize,
    table: &'t HashMap<String, String>,
}

impl<'t> Reader<'t> {
    fn peek(&self) -> &'t str {
        self.tokens.get(self.at).unwrap_or(&"")
    }

    fn next(&mut self) -> &'t str {
        self.at += 1;
        self.tokens.get(self.at - 1).unwrap_or(&"")
    }

    /// Everything up to `end`.
    fn sum(&mut self, end: &str) -> Result<String, String> {
        let (mut text, mut operand) = (String::new(), false);
        loop {
            match self.next() {
                token if token == end => return Ok(text),
                "" => return Err(format!("`{end}` is missing")),
                "," | "." | ";" if end.is_empty() => {}
                sign @ ("+" | "-" | "=" | "*" | "/") => (text, operand) = (text + sign, false),
                "\\cdot" | "\\times" => (text, operand) = (text + "*", false),
                "^" => text += &format!("^({})", self.argument()?),
                token => {
                    let times = if operand { "*" } else { "" };
                    (text, operand) = (text + times + &self.operand(token)?, true);
                }
            }
        }
    }

    /// `{…}`, or the next sign.
    fn argument(&mut self) -> Result<String, String> {
        match self.next() {
            "{" => self.sum("}"),
            "" => Err("the formula ends too early".into()),
            digit if is_number(digit) => Ok(digit.into()),
            token => self.operand(token),
        }
    }

    /// `{…}`, or the next sign, as it stands, without brackets.
    fn raw(&mut self) -> String {
        let (mut text, mut depth) = (String::new(), 0);
        loop {
            match self.next() {
                "{" => depth += 1,
                "}" => depth -= 1,
                token => text += token,
            }
            if depth <= 0 || self.at >= self.tokens.len() {
                return text;
            }
        }
    }

    /// A number, name, group or function.
    fn operand(&mut self, token: &str) -> Result<String, String> {
        if self.depth == 200 {
            return Err("more than 200 operands stand within one another".into());
        }
        self.depth += 1;
        let command = token.strip_prefix('\\').unwrap_or_default();
        let found = match token {
            "(" => format!("({})", self.sum(")")?),
            "[" => format!("({})", self.sum("]")?),
            "{" => format!("({})", self.sum("}")?),
            "\\frac" | "\\dfrac" | "\\tfrac" => format!("(({})/({}))", self.argument()?, self.argument()?),
            "\\sqrt" if self.peek() != "[" => format!("sqrt({})", self.argument()?),
            "\\dot" | "\\ddot" => {
                let letter = self.raw();
                self.name(letter, command.len() - 2)
            }
            "\\mathrm" | "\\operatorname" | "\\text" | "\\mathit" => {
                let word = format!("\\mathrm{}", self.raw());
                self.name(word, 0)
            }
            "\\sqrt" | "\\int" | "\\sum" | "\\partial" => return Err(format!("`{token}` is not read")),
            _ if FUNCTIONS.split(' ').any(|own| own == command) => self.call(command)?,
            _ if is_number(token) => {
                let mut number = token.to_owned();
                while is_number(self.peek()) || self.peek() == "." {
                    number += self.next();
                }
                number.trim_end_matches('.').to_owned()
            }
            _ if !command.is_empty() || token.chars().all(char::is_alphabetic) => self.name(token.into(), 0),
            _ => return Err(format!("`{token}` cannot stand here")),
        };
        self.depth -= 1;
        Ok(found)
    }

    /// A function: its power before its argument, which is a group, or numbers, a name and `t`.
    fn call(&mut self, command: &str) -> Result<String, String> {
        let mut power = String::new();
        if self.peek() == "^" {
            self.at += 1;
            power = format!("^({})", self.argument()?);
        }
        let mut parts: Vec<String> = Vec::new();
        loop {
            let token = self.next();
            if token.is_empty() {
                return Err("the formula ends too early".into());
            }
            parts.push(self.operand(token)?);
            if !is_number(token) && (self.peek() != "t" || parts[0].starts_with('(')) {
                return Ok(format!("{}({}){power}", command.replace("arc", "a").replace("log", "ln"), parts.join("*")));
            }
        }
    }

    /// The scene's name for a letter with dots and a subscript.
    fn name(&mut self, mut letter: String, mut dots: usize) -> String {
        if self.peek() == "_" {
            self.at += 1;
            letter += &format!("_{}", self.raw());
        }
        while self.peek() == "'" {
            self.at += 1;
            dots += 1;
        }
        let bare = || letter.replace("\\mathrm", "").replace("\\var", "").replace('\\', "").replace(',', "_");
        self.table.get(&letter).cloned().unwrap_or_else(bare) + &"'".repeat(dots)
    }
}

fn is_number(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_digit())
}
