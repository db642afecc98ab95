//! Numbers outside of files.

use std::fmt;
use std::str::FromStr;

use symbolic::{Fraction, Graph, ParseErrorKind};

/// A number instead of one of a scene: a decimal, or a formula without names as in `pi/3`.
///
/// What is proved of a scene is proved of its numbers as they are written; of a formula an `f64` is another.
///
/// ```
/// use scene::Number;
/// let angle: Number = "2*pi/4".parse().unwrap();
/// assert_eq!((angle.value(), angle.formula()), (std::f64::consts::FRAC_PI_2, Some("2*pi/4")));
/// assert_eq!(Number::from(0.1), "0.1".parse().unwrap());
/// assert!("2*q".parse::<Number>().is_err());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    value: f64,
    formula: Option<String>,
}

impl Number {
    /// It, rounded.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Its text, unless it is a decimal.
    pub fn formula(&self) -> Option<&str> {
        self.formula.as_deref()
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.formula {
            Some(formula) => f.write_str(formula),
            None => write!(f, "{}", self.value),
        }
    }
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        Number { value, formula: None }
    }
}

impl FromStr for Number {
    type Err = ParseErrorKind;

    /// What is not a formula but a number in words (`nan`, `inf`) is that, for whoever refuses it.
    fn from_str(text: &str) -> Result<Self, ParseErrorKind> {
        let text = text.trim();
        let g = Graph::new();
        if let Ok(value) = text.parse::<f64>() {
            let rounded = value.is_finite() && !is_decimal_of(text, value);
            return Ok(Number { value, formula: rounded.then(|| text.to_owned()) });
        }
        let e = g.parse(text, &|_: &str| None).map_err(|error| error.kind)?;
        let value = g.as_number(e).or_else(|| g.evaluate(e, &std::collections::HashMap::new()).ok());
        Ok(Number { value: value.ok_or(ParseErrorKind::NotFinite)?, formula: Some(text.to_owned()) })
    }
}

/// Whether the decimal `text` is the shortest of those that are rounded to `x`, and so not rounded itself.
pub(crate) fn is_decimal_of(text: &str, x: f64) -> bool {
    Fraction::decimal(text).is_some_and(|written| Fraction::decimal(&format!("{x:e}")) == Some(written))
}
