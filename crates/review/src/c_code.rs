//! A C function `y' = F(t, y)` as lines in the notation of scenes: assignments in a row, calls of functions
//! of the same file with the same names, and `solve(n, a, b)` for `a z = b`.

use std::collections::HashMap;

use crate::ReviewError;
use crate::reading::Line;

/// A function: its line, the names of its arguments, and its body.
struct Function<'t> {
    name: &'t str,
    arguments: Vec<&'t str>,
    line: usize,
    body: &'t str,
}

struct Converter<'t> {
    file: &'t str,
    functions: Vec<Function<'t>>,
    /// Names of the state, in its order: coordinates, then velocities.
    state: Vec<String>,
    lines: Vec<Line>,
    solved: usize,
    /// Entries of arrays.
    known: HashMap<String, String>,
    made: usize,
}

/// The equations of `text`; `coordinates` are in the order of the state `(q, q̇)`.
///
/// # Errors
/// [`ReviewError::Unreadable`] with the line.
pub(crate) fn lines(coordinates: &[String], file: &str, text: &str) -> Result<Vec<Line>, ReviewError> {
    let text = without_comments(text);
    let functions = functions(&text);
    let state = coordinates.iter().cloned().chain(coordinates.iter().map(|q| format!("{q}'"))).collect();
    let nothing = || ReviewError::Unreadable {
        place: format!("{file}:1"),
        what: "there is no function that assigns to the entries of an array".into(),
    };
    let assigns = |f: &&Function| f.arguments.last().is_some_and(|out| f.body.contains(&format!("{out}[")));
    let rates = functions.iter().rposition(|f| f.name.ends_with("rates") && assigns(&f));
    let main = rates.or_else(|| functions.iter().rposition(|f| f.arguments.len() > 1 && assigns(&f)));
    let main = main.ok_or_else(nothing)?;
    let known = HashMap::new();
    let mut converter = Converter { file, functions, state, lines: Vec::new(), solved: 0, known, made: 0 };
    converter.function(main, 0)?;
    let function = &converter.functions[main];
    let (n, out, line) = (coordinates.len(), *function.arguments.last().unwrap_or(&""), function.line);
    let entry = |k: usize| converter.known.get(&format!("{out}[{k}]")).cloned();
    let given = (0..2 * n).take_while(|&k| entry(k).is_some()).count();
    let what = format!("`{out}` has {given} entries, and {n} accelerations or {} rates are needed", 2 * n);
    if given != n && given != 2 * n {
        return Err(ReviewError::Unreadable { place: format!("{file}:{line}"), what });
    }
    let mut lines = std::mem::take(&mut converter.lines);
    for (i, q) in coordinates.iter().enumerate() {
        let equal = |primes: &str, k: usize| Line {
            place: format!("{file}:{line}"),
            text: format!("{q}{primes} = {}", entry(k).unwrap_or_default()),
            defines: false,
        };
        lines.extend((given == 2 * n).then(|| equal("'", i)));
        lines.push(equal("''", given - n + i));
    }
    Ok(lines)
}

/// The text with blanks instead of comments and directives.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let start_of_line = out.is_empty() || out.ends_with('\n');
        let length = if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("//") || start_of_line && c == '#' {
            rest.find('\n').unwrap_or(rest.len())
        } else {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        out.extend(rest[..length].chars().filter(|c| *c == '\n'));
        rest = &rest[length..];
    }
    out
}

/// The place of the brace that closes the one at `open`.
fn closing(text: &str, open: usize) -> usize {
    let mut depth = 0;
    for (i, c) in text[open..].char_indices() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if depth == 0 {
            return open + i;
        }
    }
    text.len()
}

fn functions(text: &str) -> Vec<Function<'_>> {
    let (mut found, mut at) = (Vec::new(), 0);
    while let Some(open) = text[at..].find('{').map(|i| at + i) {
        let close = closing(text, open);
        let head = text[at..open].rsplit([';', '}']).next().unwrap_or_default();
        if let (Some(first), Some(last)) = (head.find('('), head.rfind(')'))
            && first < last
            && !head.contains('=')
        {
            let is_part = |c: char| c.is_alphanumeric() || c == '_';
            let name = head[..first].trim().rsplit(|c| !is_part(c)).next().unwrap_or_default();
            let argument = |a: &'_ str| -> usize { a.find('[').unwrap_or(a.len()) };
            let arguments = head[first + 1..last].split(',');
            let arguments =
                arguments.map(|a| a[..argument(a)].trim().rsplit(|c| !is_part(c)).next().unwrap_or_default()).collect();
            let line = 1 + text[..open].matches('\n').count();
            found.push(Function { name, arguments, line, body: &text[open + 1..close.min(text.len())] });
        }
        at = (close + 1).min(text.len());
    }
    found
}

/// The parts of a list, separated by commas outside of brackets.
fn top_level(list: &str) -> Vec<&str> {
    let (mut depth, mut from, mut parts) = (0, 0, Vec::new());
    for (i, c) in list.char_indices() {
        depth += i32::from("([".contains(c)) - i32::from(")]".contains(c));
        if c == ',' && depth == 0 {
            parts.push(&list[from..i]);
            from = i + 1;
        }
    }
    parts.push(&list[from..]);
    parts
}

impl Converter<'_> {
    fn fault(&self, line: usize, what: String) -> ReviewError {
        ReviewError::Unreadable { place: format!("{}:{line}", self.file), what }
    }

    fn function(&mut self, which: usize, depth: usize) -> Result<(), ReviewError> {
        let f = &self.functions[which];
        let (body, first) = (f.body.to_owned(), f.line);
        // the state, or coordinates and velocities
        let inputs = f.arguments.split_last().map_or(&[][..], |(_, inputs)| inputs);
        let arrays: Vec<&str> = inputs.iter().copied().filter(|a| body.contains(&format!("{a}["))).collect();
        let half = if let [_, _] = arrays[..] { self.state.len() / 2 } else { self.state.len() };
        for (array, names) in arrays.iter().zip(self.state.chunks(half.max(1))) {
            for (k, name) in names.iter().enumerate() {
                self.known.insert(format!("{array}[{k}]"), name.clone());
            }
        }
        let mut at = 0;
        while at < body.len() {
            let rest = &body[at..];
            let blank = rest.len() - rest.trim_start_matches(|c: char| c.is_whitespace() || "{};".contains(c)).len();
            at += blank;
            let line = first + body[..at].matches('\n').count();
            let rest = &body[at..];
            let mut end = rest.find(';').unwrap_or(rest.len());
            // { 1, 2, … }; of an array
            if let Some(open) = rest.find('{').filter(|open| *open < end && rest[..*open].trim_end().ends_with('=')) {
                end = closing(rest, open);
                end += rest[end..].find(';').unwrap_or(0);
            }
            let statement: String = rest[..end].split_whitespace().collect::<Vec<_>>().join(" ");
            at += end + 1;
            if !statement.is_empty() {
                self.statement(&statement, line, depth)?;
            }
        }
        Ok(())
    }

    fn statement(&mut self, statement: &str, line: usize, depth: usize) -> Result<(), ReviewError> {
        if statement.starts_with("(void)") || statement.starts_with("return") {
            return Ok(());
        }
        if let Some(condition) = statement.strip_prefix("if") {
            if !condition.contains("return") {
                return Err(self.fault(line, format!("`{statement}`: only `if (…) return` is read")));
            }
            return self.call(condition, line, depth);
        }
        if ["for", "while", "do ", "switch", "else", "goto"].iter().any(|word| statement.starts_with(word)) {
            return Err(self.fault(line, format!("`{statement}` is not read: assignments in a row are")));
        }
        // several declarations in one
        if let Some(list) = statement.trim_start_matches("const ").strip_prefix("double ").filter(|s| !s.contains('{'))
        {
            let parts = top_level(list);
            if parts.len() > 1 {
                return parts.into_iter().try_for_each(|part| self.statement(part.trim(), line, depth));
            }
        }
        let Some((left, right)) = statement.split_once('=') else {
            if statement.contains('(') {
                return self.call(statement, line, depth);
            }
            return Ok(());
        };
        let operator = left.chars().last().filter(|c| "+-*/".contains(*c));
        let left = left.trim_end_matches(['+', '-', '*', '/']).trim();
        let target = left.rsplit(' ').next().unwrap_or(left).trim_start_matches('*').to_owned();
        if let Some(list) = right.trim().strip_prefix('{') {
            let name = target.split('[').next().unwrap_or_default();
            for (k, entry) in list.trim_end_matches([' ', '}']).split(',').enumerate() {
                let e = self.expression(entry, line)?;
                self.define(&format!("{name}[{k}]"), &e, line);
            }
            return Ok(());
        }
        let mut e = self.expression(right, line)?;
        if let Some(operator) = operator {
            let before = self.expression(&target, line)?;
            e = format!("({before}) {operator} ({e})");
        }
        self.define(&target.replace(' ', ""), &e, line);
        Ok(())
    }

    /// A call of a function of the file, or of `solve`; conditions under which there is no answer do not
    /// count.
    fn call(&mut self, text: &str, line: usize, depth: usize) -> Result<(), ReviewError> {
        let inner = text.trim().trim_start_matches('(');
        let Some((name, arguments)) = inner.split_once('(') else { return Ok(()) };
        let name = name.trim();
        let arguments: Vec<&str> = arguments.split(')').next().unwrap_or_default().split(',').map(str::trim).collect();
        if name.ends_with("solve") && arguments.len() == 3 {
            return self.solve(&arguments, line);
        }
        if let Some(which) = self.functions.iter().position(|f| f.name == name) {
            if self.functions[which].arguments != arguments || depth > 3 {
                return Err(self.fault(line, format!("`{name}` is called with other names than it has itself")));
            }
            return self.function(which, depth + 1);
        }
        if text.contains("return") {
            Ok(())
        } else {
            Err(self.fault(line, format!("the function `{name}` is not there")))
        }
    }

    fn solve(&mut self, arguments: &[&str], line: usize) -> Result<(), ReviewError> {
        let (Ok(n), matrix) = (arguments[0].parse::<usize>(), arguments[1]) else {
            return Err(self.fault(line, format!("`{}` is not a number of equations", arguments[0])));
        };
        let right = arguments[2].trim_start_matches('&');
        let (right, first) = right.split_once('[').unwrap_or((right, "0"));
        let first: usize = first.trim_end_matches(']').parse().unwrap_or(0);
        self.solved += 1;
        let unknown = |k: usize, solved: usize| format!("z{solved}_{k}");
        for i in 0..n {
            let mut text = String::new();
            for j in 0..n {
                let entry = self.expression(&format!("{matrix}[{}]", i * n + j), line)?;
                text += &format!("({entry})*{} + ", unknown(j, self.solved));
            }
            let rest = self.expression(&format!("{right}[{}]", first + i), line)?;
            let text = format!("{text}0 = {rest}");
            self.lines.push(Line { place: format!("{}:{line}", self.file), text, defines: false });
        }
        for k in 0..n {
            self.known.insert(format!("{right}[{}]", first + k), unknown(k, self.solved));
        }
        Ok(())
    }

    /// From here on `target` stands for `e`, under a name of its own.
    fn define(&mut self, target: &str, e: &str, line: usize) {
        self.made += 1;
        let name = format!("c{}_", self.made);
        let text = format!("{name} = {e}");
        self.lines.push(Line { place: format!("{}:{line}", self.file), text, defines: true });
        self.known.insert(target.to_owned(), name);
    }

    /// An expression in the notation of scenes.
    fn expression(&self, text: &str, line: usize) -> Result<String, ReviewError> {
        let mut out = String::new();
        let text = text.replace("(double)", "");
        let mut rest = text.trim();
        while let Some(c) = rest.chars().next() {
            if c.is_alphabetic() || c == '_' {
                let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
                let (mut name, mut after) = (rest[..end].to_owned(), rest[end..].trim_start());
                // a member of a structure is a parameter
                for mark in ["->", "."] {
                    if let Some(member) = after.strip_prefix(mark) {
                        let end = member.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(member.len());
                        name = member[..end].to_owned();
                        after = &member[end..];
                    }
                }
                if let Some(index) = after.strip_prefix('[') {
                    let end = index.find(']').unwrap_or(index.len());
                    name = format!("{name}[{}]", index[..end].replace(' ', ""));
                    after = index.get(end + 1..).unwrap_or_default();
                }
                match self.known.get(&name) {
                    Some(known) => out += known,
                    None if name.contains('[') => return Err(self.fault(line, format!("`{name}` has no value here"))),
                    None if name == "M_PI" => out += "pi",
                    None => out += &name,
                }
                rest = after;
                continue;
            }
            if c.is_ascii_digit() || c == '.' {
                let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.')).unwrap_or(rest.len());
                // 1e-3
                let signed = rest[..end].ends_with(['e', 'E']) && rest[end..].starts_with(['-', '+']);
                let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
                let end = if signed { end + 1 + digits(&rest[end + 1..]) } else { end };
                out += rest[..end].trim_end_matches(['f', 'F', 'L', 'l']).trim_end_matches('.');
                rest = &rest[end..];
                continue;
            }
            if !"+-*/(), ".contains(c) {
                return Err(self.fault(line, format!("`{c}` in `{text}` is not read")));
            }
            out.push(c);
            rest = &rest[c.len_utf8()..];
        }
        Ok(out)
    }
}
