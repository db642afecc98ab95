//! A C function `y' = F(t, y)` rewritten in the notation of scenes: assignments in a row, calls of functions
//! of the same file with the same names, and `solve(n, a, b)` for `a z = b`. `a[3]` is the name `a_3_`.

use std::collections::HashSet;

use crate::ReviewError;
use crate::reading::Line;

/// A function: its line, the names of its arguments, and its body.
struct Function<'t> {
    name: &'t str,
    arguments: Vec<&'t str>,
    line: usize,
    body: &'t str,
}

struct Reader<'t> {
    file: &'t str,
    functions: &'t [Function<'t>],
    /// Names of the state, in its order: coordinates, then velocities.
    state: Vec<String>,
    lines: Vec<Line>,
    /// Entries of arrays that have a value.
    entries: HashSet<String>,
}

/// The equations of `text`; `coordinates` are in the order of the state `(q, q̇)`.
///
/// # Errors
/// [`ReviewError::Unreadable`] with the line.
pub(crate) fn lines(coordinates: &[String], file: &str, text: &str) -> Result<Vec<Line>, ReviewError> {
    let text = without_comments(text);
    let functions = functions(&text);
    let state = coordinates.iter().cloned().chain(coordinates.iter().map(|q| format!("{q}'"))).collect();
    let mut reader = Reader { file, functions: &functions, state, lines: Vec::new(), entries: HashSet::new() };
    let assigns = |f: &&Function| f.arguments.last().is_some_and(|out| f.body.contains(&format!("{out}[")));
    let mut from_last = functions.iter().rev();
    let main = from_last.clone().find(|f| f.name.ends_with("rates") && assigns(f));
    let main = main.or_else(|| from_last.find(|f| f.arguments.len() > 1 && assigns(f)));
    let nothing = || reader.fault(1, "there is no function that assigns to the entries of an array".into());
    let main = main.ok_or_else(nothing)?;
    reader.function(main, 0)?;
    let (n, out) = (coordinates.len(), *main.arguments.last().unwrap_or(&""));
    let given = (0..2 * n).take_while(|k| reader.entries.contains(&format!("{out}_{k}_"))).count();
    if given != n && given != 2 * n {
        let what = format!("`{out}` has {given} entries, and {n} accelerations or {} rates are needed", 2 * n);
        return Err(reader.fault(main.line, what));
    }
    for (k, q) in (0..given).zip(coordinates.iter().cycle()) {
        let primes = if k + n < given { "'" } else { "''" };
        reader.say(format!("{q}{primes} = {out}_{k}_"), main.line, false);
    }
    Ok(reader.lines)
}

/// The text without comments and directives, with the same lines.
fn without_comments(text: &str) -> String {
    let mut plain = String::new();
    for (i, part) in text.split("/*").enumerate() {
        let (comment, code) = if i == 0 { ("", part) } else { part.split_once("*/").unwrap_or((part, "")) };
        plain.extend(comment.chars().filter(|c| *c == '\n'));
        plain += code;
    }
    let code = |line: &'_ str| if line.starts_with('#') { 0 } else { line.find("//").unwrap_or(line.len()) };
    plain.lines().map(|line| &line[..code(line)]).collect::<Vec<_>>().join("\n")
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The place of the brace that closes the one at `open`.
fn closing(text: &str, open: usize) -> usize {
    let mut depth = 0;
    let mut closes = |c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        depth == 0
    };
    text[open..].char_indices().find(|&(_, c)| closes(c)).map_or(text.len(), |(i, _)| open + i)
}

/// The last name in a text, before the `[…]` of an array.
fn last_name(text: &str) -> &str {
    text.split('[').next().unwrap_or_default().trim_end().rsplit(|c| !is_part(c)).next().unwrap_or_default()
}

fn functions(text: &str) -> Vec<Function<'_>> {
    let (mut found, mut at) = (Vec::new(), 0);
    while let Some(open) = text[at..].find('{').map(|i| at + i) {
        let close = closing(text, open);
        let head = text[at..open].rsplit([';', '}']).next().unwrap_or_default().trim_end();
        if let Some((name, arguments)) = head.strip_suffix(')').and_then(|head| head.split_once('('))
            && !head.contains('=')
        {
            let arguments = arguments.split(',').map(last_name).collect();
            let (name, line) = (last_name(name), 1 + text[..open].matches('\n').count());
            found.push(Function { name, arguments, line, body: &text[open + 1..close] });
        }
        at = (close + 1).min(text.len());
    }
    found
}

/// The parts of a list, separated by commas outside of brackets.
fn parts(list: &str) -> Vec<&str> {
    let mut depth = 0;
    let is_comma = |c: char| {
        depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
        c == ',' && depth == 0
    };
    list.split(is_comma).map(str::trim).collect()
}

/// The name of an entry of an array.
fn entry(name: &str) -> String {
    name.replace(' ', "").replace(['[', ']'], "_")
}

impl Reader<'_> {
    fn fault(&self, line: usize, what: String) -> ReviewError {
        ReviewError::Unreadable { place: format!("{}:{line}", self.file), what }
    }

    fn say(&mut self, text: String, line: usize, defines: bool) {
        self.lines.push(Line { place: format!("{}:{line}", self.file), text, defines });
    }

    /// From here on `target` stands for `e`.
    fn define(&mut self, target: &str, e: &str, line: usize) {
        let name = entry(target);
        self.say(format!("{name} = {e}"), line, true);
        self.entries.insert(name);
    }

    fn function(&mut self, f: &Function, depth: usize) -> Result<(), ReviewError> {
        // the state, or coordinates and velocities
        let inputs = f.arguments.split_last().map_or(&[][..], |(_, inputs)| inputs);
        let arrays: Vec<&&str> = inputs.iter().filter(|a| f.body.contains(&format!("{a}["))).collect();
        let half = if arrays.len() == 2 { self.state.len() / 2 } else { self.state.len() };
        let state = self.state.clone();
        for (array, names) in arrays.iter().zip(state.chunks(half.max(1))) {
            names.iter().enumerate().for_each(|(k, name)| self.define(&format!("{array}[{k}]"), name, f.line));
        }
        let mut rest = f.body;
        loop {
            rest = rest.trim_start_matches(|c: char| c.is_whitespace() || "{};".contains(c));
            let line = f.line + f.body[..f.body.len() - rest.len()].matches('\n').count();
            let mut end = rest.find(';').unwrap_or(rest.len());
            // { 1, 2, … }; of an array
            if let Some(open) = rest[..end].find('{').filter(|&open| rest[..open].trim_end().ends_with('=')) {
                end = closing(rest, open);
                end += rest[end..].find(';').unwrap_or(0);
            }
            let statement = rest[..end].split_whitespace().collect::<Vec<_>>().join(" ");
            if statement.is_empty() {
                return Ok(());
            }
            self.statement(&statement, line, depth)?;
            rest = &rest[end..];
        }
    }

    fn statement(&mut self, statement: &str, line: usize, depth: usize) -> Result<(), ReviewError> {
        let first = statement.split(|c| !is_part(c)).next().unwrap_or_default();
        match first {
            "return" => return Ok(()),
            "if" if statement.contains("return") => return self.call(&statement[2..], line, depth),
            "if" => return Err(self.fault(line, format!("`{statement}`: only `if (…) return` is read"))),
            "for" | "while" | "do" | "switch" | "else" | "goto" => {
                return Err(self.fault(line, format!("`{statement}` is not read: assignments in a row are")));
            }
            _ if statement.starts_with("(void)") => return Ok(()),
            _ => {}
        }
        // several declarations in one
        let list = parts(statement.trim_start_matches("const ").strip_prefix("double ").unwrap_or_default());
        if list.len() > 1 {
            return list.into_iter().try_for_each(|part| self.statement(part, line, depth));
        }
        let Some((left, right)) = statement.split_once('=') else {
            return if statement.contains('(') { self.call(statement, line, depth) } else { Ok(()) };
        };
        let place = left.trim_end_matches(['+', '-', '*', '/']);
        let operator = left[place.len()..].chars().next();
        let target = place.trim_end().rsplit(' ').next().unwrap_or_default().trim_start_matches('*');
        if let Some(list) = right.trim().strip_prefix('{') {
            let name = target.split('[').next().unwrap_or_default();
            for (k, part) in list.trim_end_matches([' ', '}']).split(',').enumerate() {
                let e = self.expression(part, line)?;
                self.define(&format!("{name}[{k}]"), &e, line);
            }
            return Ok(());
        }
        let mut e = self.expression(right, line)?;
        if let Some(operator) = operator {
            e = format!("({}) {operator} ({e})", self.expression(target, line)?);
        }
        self.define(target, &e, line);
        Ok(())
    }

    /// A call of a function of the file, or of `solve`; conditions under which there is no answer do not
    /// count.
    fn call(&mut self, text: &str, line: usize, depth: usize) -> Result<(), ReviewError> {
        let Some((name, arguments)) = text.trim().trim_start_matches('(').split_once('(') else { return Ok(()) };
        let arguments: Vec<&str> = arguments.split(')').next().unwrap_or_default().split(',').map(str::trim).collect();
        match self.functions.iter().find(|f| f.name == name.trim()) {
            _ if name.trim().ends_with("solve") && arguments.len() == 3 => self.solve(&arguments, line),
            Some(f) if f.arguments == arguments && depth <= 3 => self.function(f, depth + 1),
            Some(_) => Err(self.fault(line, format!("`{name}` is called with other names than it has itself"))),
            None if text.contains("return") => Ok(()),
            None => Err(self.fault(line, format!("the function `{name}` is not there"))),
        }
    }

    fn solve(&mut self, arguments: &[&str], line: usize) -> Result<(), ReviewError> {
        let (Ok(n), matrix) = (arguments[0].parse::<usize>(), arguments[1]) else {
            return Err(self.fault(line, format!("`{}` is not a number of equations", arguments[0])));
        };
        let (right, first) = arguments[2].trim_start_matches('&').split_once('[').unwrap_or((arguments[2], "0"));
        let first: usize = first.trim_end_matches(']').parse().unwrap_or(0);
        let unknown = format!("z{}_", self.lines.len());
        for i in 0..n {
            let product = |j: usize| format!("{matrix}[{}]*{unknown}{j} + ", i * n + j);
            let rows: String = (0..n).map(product).collect();
            let text = format!(
                "{}0 = {}",
                self.expression(&rows, line)?,
                self.expression(&format!("{right}[{}]", first + i), line)?
            );
            self.say(text, line, false);
        }
        (0..n).for_each(|k| self.define(&format!("{right}[{}]", first + k), &format!("{unknown}{k}"), line));
        Ok(())
    }

    /// An expression in the notation of scenes.
    fn expression(&self, text: &str, line: usize) -> Result<String, ReviewError> {
        let (mut out, text) = (String::new(), text.replace("(double)", ""));
        let mut rest = text.trim();
        while let Some(c) = rest.chars().next() {
            let is_word = is_part(c) || c == '.';
            let end = if is_word { rest.find(|c| !is_part(c) && c != '.').unwrap_or(rest.len()) } else { c.len_utf8() };
            let (word, after) = rest.split_at(end);
            rest = after;
            if c.is_ascii_digit() || c == '.' {
                out += word.trim_end_matches(['f', 'F', 'L', 'l']).trim_end_matches('.');
                // 1e-3
                if word.ends_with(['e', 'E']) && after.starts_with(['-', '+']) {
                    out += &after[..1];
                    rest = &after[1..];
                }
            } else if is_word {
                // a member of a structure is a parameter
                if let Some(member) = after.strip_prefix("->") {
                    rest = member;
                } else if let Some(index) = after.strip_prefix('[') {
                    let (index, after) = index.split_once(']').unwrap_or((index, ""));
                    let name = format!("{word}[{}]", index.replace(' ', ""));
                    if !self.entries.contains(&entry(&name)) {
                        return Err(self.fault(line, format!("`{name}` has no value here")));
                    }
                    (out, rest) = (out + &entry(&name), after);
                } else {
                    out += if word == "M_PI" { "pi" } else { word.rsplit('.').next().unwrap_or(word) };
                }
            } else if "+-*/(), ".contains(c) {
                out.push(c);
            } else {
                return Err(self.fault(line, format!("`{c}` in `{text}` is not read")));
            }
        }
        Ok(out)
    }
}
