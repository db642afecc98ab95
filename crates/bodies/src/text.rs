//! Formulas as text: their parts, sums of terms, vectors.

use symbolic::limits::DEPTH;

/// The parts of `text` between marks that stand outside of brackets.
pub(crate) fn split(text: &str, mark: char) -> Vec<&str> {
    let (mut depth, mut from, mut parts) = (0_i32, 0, Vec::new());
    for (i, c) in text.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ if c == mark && depth == 0 => {
                parts.push(text[from..i].trim());
                from = i + c.len_utf8();
            }
            _ => {}
        }
    }
    parts.push(text[from..].trim());
    parts
}

/// What stands between `open` at the beginning and its bracket, if that is the end of `text`.
pub(crate) fn within<'t>(text: &'t str, open: &str) -> Option<&'t str> {
    let inner = text.trim().strip_prefix(open)?.strip_suffix([')', ']'])?;
    let mut depth = 0_i32;
    let mut closes = |c| {
        depth += i32::from(matches!(c, '(' | '[')) - i32::from(matches!(c, ')' | ']'));
        depth < 0
    };
    (!inner.chars().any(&mut closes)).then(|| inner.trim())
}

/// Whether `text` binds as tightly as a name.
fn is_atom(text: &str) -> bool {
    text.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '\'')) || within(text, "(").is_some()
}

/// `text` as a factor.
pub(crate) fn factor(text: &str) -> String {
    if is_atom(text) { text.into() } else { format!("({text})") }
}

pub(crate) fn is_zero(text: &str) -> bool {
    text.trim().parse::<f64>() == Ok(0.0)
}

/// Three components; a vector of two lies in the plane z = 0.
pub(crate) fn components(vector: &str) -> Option<[String; 3]> {
    let mut parts: Vec<String> = split(within(vector, "[")?, ',').into_iter().map(String::from).collect();
    if parts.len() == 2 {
        parts.push("0".into());
    }
    parts.try_into().ok()
}

/// A vector as it is written, of three components where they can be told.
pub(crate) fn vector(text: &str) -> String {
    components(text).map_or_else(|| text.trim().into(), |parts| format!("[{}]", parts.join(", ")))
}

pub(crate) fn is_zero_vector(text: &str) -> bool {
    components(text).is_some_and(|parts| parts.iter().all(|part| is_zero(part)))
}

/// A sum of terms with their signs: what cancels as it is written is not there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sum(pub(crate) Vec<(bool, String)>);

impl Sum {
    pub(crate) fn read(text: &str) -> Sum {
        Sum::read_within(text, DEPTH)
    }

    fn read_within(text: &str, brackets: usize) -> Sum {
        let mut sum = Sum::default();
        let (mut depth, mut from, mut negative) = (0_i32, 0, false);
        let mut end = |from: usize, to: usize, negative: bool| {
            let term = text[from..to].trim();
            if !term.is_empty() {
                sum.push(negative, term, brackets);
            }
        };
        for (i, c) in text.char_indices() {
            match c {
                '(' | '[' => depth += 1,
                ')' | ']' => depth -= 1,
                '+' | '-' if depth == 0 => {
                    let before = text[from..i].trim_end();
                    if before.is_empty() {
                        negative ^= c == '-';
                        from = i + 1;
                    } else if !before.ends_with(['*', '/', '^']) && !is_exponent(before) {
                        end(from, i, negative);
                        (from, negative) = (i + 1, c == '-');
                    }
                }
                _ => {}
            }
        }
        end(from, text.len(), negative);
        sum
    }

    fn push(&mut self, negative: bool, term: &str, brackets: usize) {
        if let Some(inner) = within(term, "(").filter(|_| brackets > 0) {
            let inner = Sum::read_within(inner, brackets - 1);
            inner.0.iter().for_each(|(sign, term)| self.push(negative ^ sign, term, 0));
        } else if let Some(i) = self.0.iter().position(|(sign, other)| *sign != negative && other == term) {
            self.0.remove(i);
        } else if !is_zero(term) {
            self.0.push((negative, term.into()));
        }
    }

    pub(crate) fn plus(&self, other: &Sum) -> Sum {
        let mut sum = self.clone();
        other.0.iter().for_each(|(sign, term)| sum.push(*sign, term, 0));
        sum
    }

    pub(crate) fn negative(&self) -> Sum {
        Sum(self.0.iter().map(|(sign, term)| (!sign, term.clone())).collect())
    }

    /// Its time derivative, where `moves` says which terms have one.
    pub(crate) fn rate(&self, moves: impl Fn(&str) -> bool) -> Sum {
        let moving = self.0.iter().filter(|(_, term)| moves(term));
        Sum(moving.map(|(sign, term)| (*sign, format!("{}'", factor(term)))).collect())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl std::fmt::Display for Sum {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (negative, term)) in self.0.iter().enumerate() {
            f.write_str(match (i, negative) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            })?;
            f.write_str(term)?;
        }
        if self.0.is_empty() { f.write_str("0") } else { Ok(()) }
    }
}

/// Whether a sign after `before` is one of an exponent, as in `1e-3`.
fn is_exponent(before: &str) -> bool {
    let word = before.rsplit(|c: char| !(c.is_alphanumeric() || c == '.' || c == '_')).next().unwrap_or("");
    word.ends_with(['e', 'E']) && word.starts_with(|c: char| c.is_ascii_digit() || c == '.')
}
