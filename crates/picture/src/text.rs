//! Text and numbers as an SVG document holds them.

/// Escape for element content and attribute values. Characters that XML forbids become U+FFFD.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
    out
}

/// Width of a text in pixels, rather over than under: the viewer's font is not known.
pub fn width(text: &str, size: f64) -> f64 {
    text.chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | 'I' | ' ' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | '(' | ')' => 0.36,
            'r' | 't' | 'f' | '-' => 0.44,
            'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.95,
            '⁰' | '¹' | '²' | '³' | '⁴' | '⁵' | '⁶' | '⁷' | '⁸' | '⁹' | '⁻' => 0.42,
            'A'..='Z' => 0.72,
            '\u{2e80}'.. => 1.0,
            '−' | '×' | '≤' | '≥' | '=' | '+' | '<' | '>' => 0.84,
            _ => 0.63,
        })
        .sum::<f64>()
        * size
}

/// The text, cut with an ellipsis where it is wider than `limit` pixels.
pub fn fit(text: &str, size: f64, limit: f64) -> String {
    if width(text, size) <= limit {
        return text.to_owned();
    }
    let mut kept = String::new();
    for c in text.chars() {
        kept.push(c);
        if width(&kept, size) + size > limit {
            break;
        }
    }
    kept.push('…');
    kept
}

/// The text in lines of at most `limit` pixels, broken between words.
pub fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, size) + width(" ", size) + width(word, size) <= limit => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fit(word, size, limit)),
        }
    }
    lines
}

/// A power of ten as it is written by hand: `10⁻⁶`.
pub fn power_of_ten(exponent: i32) -> String {
    let mut out = String::from("10");
    for c in exponent.to_string().chars() {
        out.push(match c {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32(0x2070 + u32::from(digit) - u32::from('0')).unwrap_or(digit),
        });
    }
    out
}

/// A number with `decimals` decimals, a true minus sign, and no negative zero.
pub fn decimal(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// Whole tenths of a pixel.
pub fn tenths(pixels: f64) -> i64 {
    (pixels * 10.0).round() as i64
}

/// Append tenths of a pixel in the shortest form: `-.5`, `3`, `12.5`.
pub fn push_tenths(out: &mut String, tenths: i64) {
    use std::fmt::Write;
    if tenths < 0 {
        out.push('-');
    }
    let (whole, rest) = (tenths.unsigned_abs() / 10, tenths.unsigned_abs() % 10);
    // Writing to a string does not fail.
    let _ = match (whole, rest) {
        (whole, 0) => write!(out, "{whole}"),
        (0, rest) => write!(out, ".{rest}"),
        (whole, rest) => write!(out, "{whole}.{rest}"),
    };
}

/// A length or coordinate in pixels, rounded to tenths.
pub fn px(pixels: f64) -> String {
    let mut out = String::new();
    push_tenths(&mut out, tenths(pixels));
    out
}
