//! Numbers outside of files.

use symbolic::{Graph, ParseErrorKind};

/// The number that an expression without names stands for, as in `pi/3`; what is no expression but a number
/// in words (`nan`, `inf`) is that, for whoever refuses it.
///
/// # Errors
/// What is wrong with the expression.
///
/// ```
/// assert_eq!(scene::number("2*pi/4"), Ok(std::f64::consts::FRAC_PI_2));
/// assert!(scene::number("2*q").is_err());
/// ```
pub fn number(text: &str) -> Result<f64, ParseErrorKind> {
    if let Ok(number) = text.trim().parse() {
        return Ok(number);
    }
    let g = Graph::new();
    let e = g.parse(text, &|_| None, &[]).map_err(|error| error.kind)?;
    g.as_number(e).or_else(|| g.evaluate(e, &std::collections::HashMap::new()).ok()).ok_or(ParseErrorKind::NotFinite)
}
