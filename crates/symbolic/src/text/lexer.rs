//! Text to tokens.

use crate::ParseErrorKind;
use crate::store::number::Number;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Token {
    Number(Number),
    /// An identifier with its primes; the text is that of the token's span.
    Name,
    Plus,
    Minus,
    Times,
    Divide,
    Power,
    Open,
    Close,
    OpenList,
    CloseList,
    Comma,
    /// A dot and letters, right after what it is a component of.
    Component,
    /// A prime after a bracket or a component.
    Prime,
    /// A word in quotation marks.
    Word,
    End,
}

/// A token and where it stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spanned {
    pub(crate) token: Token,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// What is wrong, from `start` to `end`.
pub(crate) struct Fault {
    pub(crate) kind: ParseErrorKind,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// The first token at or after byte `at`.
pub(crate) fn token_at(text: &str, at: usize) -> Result<Spanned, Fault> {
    let bytes = text.as_bytes();
    let mut start = at;
    while start < bytes.len() && bytes[start].is_ascii_whitespace() {
        start += 1;
    }
    let Some(&first) = bytes.get(start) else {
        return Ok(Spanned { token: Token::End, start: text.len(), end: text.len() });
    };
    let symbol = |token, length| Ok(Spanned { token, start, end: start + length });
    match first {
        b'+' => symbol(Token::Plus, 1),
        b'-' => symbol(Token::Minus, 1),
        b'*' if bytes.get(start + 1) == Some(&b'*') => symbol(Token::Power, 2),
        b'*' => symbol(Token::Times, 1),
        b'/' => symbol(Token::Divide, 1),
        b'^' => symbol(Token::Power, 1),
        b'(' => symbol(Token::Open, 1),
        b')' => symbol(Token::Close, 1),
        b'[' => symbol(Token::OpenList, 1),
        b']' => symbol(Token::CloseList, 1),
        b',' => symbol(Token::Comma, 1),
        b'\'' if start == at && start > 0 => symbol(Token::Prime, 1),
        b'.' if start == at && bytes.get(start + 1).is_some_and(u8::is_ascii_alphabetic) => {
            let letters = bytes[start + 1..].iter().take_while(|b| b.is_ascii_alphanumeric()).count();
            symbol(Token::Component, 1 + letters)
        }
        b'"' if text[start + 1..].contains('"') => {
            let length = text[start + 1..].find('"').map_or(0, |i| i + 2);
            symbol(Token::Word, length)
        }
        b'0'..=b'9' => number(text, start),
        b'.' if bytes.get(start + 1).is_some_and(u8::is_ascii_digit) => number(text, start),
        b'a'..=b'z' | b'A'..=b'Z' | b'_' => {
            let mut end = start;
            while end < bytes.len() && (bytes[end].is_ascii_alphanumeric() || bytes[end] == b'_') {
                end += 1;
            }
            while end < bytes.len() && bytes[end] == b'\'' {
                end += 1;
            }
            symbol(Token::Name, end - start)
        }
        _ => {
            let found = text[start..].chars().next().unwrap_or('\0');
            let kind = ParseErrorKind::UnexpectedCharacter { found, hint: hint(found) };
            Err(Fault { kind, start, end: start + found.len_utf8() })
        }
    }
}

/// `digits[.digits][e[±]digits]`; an `e` without digits belongs to whatever follows.
fn number(text: &str, start: usize) -> Result<Spanned, Fault> {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while i < bytes.len() && bytes[i].is_ascii_digit() {
            i += 1;
        }
        i
    };
    let mut end = digits(start);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    let literal = &text[start..end];
    match Number::from_decimal(literal) {
        Some(n) => Ok(Spanned { token: Token::Number(n), start, end }),
        None => {
            let kind = ParseErrorKind::NumberOutOfRange { literal: literal.to_owned() };
            Err(Fault { kind, start, end })
        }
    }
}

/// What may have been meant by a character that no formula contains.
fn hint(found: char) -> Option<String> {
    const GREEK: &str = "αalpha βbeta γgamma δdelta εepsilon ζzeta ηeta θtheta κkappa λlambda μmu νnu ξxi πpi ρrho σsigma \
        τtau φphi ϕphi χchi ψpsi ωomega ΩOmega ΦPhi ΔDelta";
    if let Some(name) = GREEK.split(' ').find_map(|letter| letter.strip_prefix(found)) {
        return Some(format!("write {name}"));
    }
    let text = match found {
        '=' => "write what has to be zero: left side - (right side)",
        '−' | '–' | '—' => "the minus sign is -",
        '·' | '×' | '⋅' => "the multiplication sign is *",
        '÷' => "the division sign is /",
        '²' | '³' => "write ^2 or ^3",
        '√' => "write sqrt(…)",
        '’' | '′' | '‘' | '"' => "a time derivative is written with ', as in x'",
        '\'' => "a prime follows a name directly, as in x'",
        '{' | '}' => "use parentheses",
        '|' => "an absolute value is not differentiable; a smooth substitute is sqrt(x^2 + eps^2)",
        '.' => "a number starts or ends with a digit",
        _ => return None,
    };
    Some(text.to_owned())
}

/// The names in a formula, as far as it can be read, without primes: with the place of each.
///
/// ```
/// let names = symbolic::names_in("m*dot(v, r')");
/// assert_eq!(names, [("m", 0), ("dot", 2), ("v", 6), ("r", 9)]);
/// ```
pub fn names_in(text: &str) -> Vec<(&str, usize)> {
    let mut names = Vec::new();
    let mut at = 0;
    while let Ok(Spanned { token, start, end }) = token_at(text, at) {
        match token {
            Token::End => break,
            Token::Name => names.push((text[start..end].trim_end_matches('\''), start)),
            _ => {}
        }
        at = end;
    }
    names
}
