//! Errors in formulas, with their places.

use std::fmt;

use crate::text::excerpt::excerpt;

/// A formula that could not be read: what is wrong, and the place.
///
/// ```
/// use symbolic::{Graph, ParseErrorKind};
/// let g = Graph::new();
/// g.symbol("x");
/// let error = g.parse("1 + 2 x", &g).unwrap_err();
/// assert!(matches!(error.kind, ParseErrorKind::ImplicitMultiplication { .. }));
/// assert_eq!((error.line(), error.column()), (1, 7));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParseError {
    /// What is wrong.
    pub kind: ParseErrorKind,
    /// The whole text that was read.
    pub text: Box<str>,
    /// Where the offending piece starts in `text`, in bytes.
    pub offset: usize,
    /// Length of the offending piece in bytes; 0 at the end of the text.
    pub length: usize,
    /// What else is wrong, in the order of the text: names and calls, which leave the rest readable.
    pub also: Box<[ParseError]>,
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum ParseErrorKind {
    /// There is no formula.
    #[error("there is no expression here")]
    Empty,
    /// A character that no formula contains.
    #[error("unexpected character {found:?}{}", hinted(.hint.as_deref()))]
    UnexpectedCharacter { found: char, hint: Option<String> },
    /// Something that cannot stand here.
    #[error("expected {expected}, found `{}`", shortened(.found))]
    UnexpectedToken { found: String, expected: &'static str },
    /// The formula stops too early.
    #[error("the expression ends where {expected} is expected")]
    UnexpectedEnd { expected: &'static str },
    /// An opening parenthesis without its partner.
    #[error("this parenthesis is never closed")]
    UnclosedParenthesis,
    /// A closing parenthesis without its partner.
    #[error("this closing parenthesis has no opening one")]
    UnmatchedParenthesis,
    /// A name that means nothing here.
    #[error("undefined name `{}`{}", shortened(.name), meant(.suggestion.as_deref()))]
    Undefined { name: String, suggestion: Option<String> },
    /// A call of something that is not known at all.
    #[error("unknown function `{}`{}", shortened(.name), meant(.suggestion.as_deref()))]
    UnknownFunction { name: String, suggestion: Option<String> },
    /// A function that has no derivative everywhere.
    #[error("`{name}` is not differentiable, and equations of motion need two derivatives; {instead}")]
    NotSmooth { name: String, instead: &'static str },
    /// A function with too few or too many arguments.
    #[error("`{function}` takes {expected} argument{}, found {found}", plural(*.expected))]
    WrongArgumentCount { function: String, expected: usize, found: usize },
    /// A function that is used like a variable.
    #[error("`{name}` is a function and needs an argument: write {name}(…)")]
    FunctionWithoutArgument { name: String },
    /// A variable that is used like a function.
    #[error("`{name}` is not a function; for a product write {name}*(…)")]
    VariableCalled { name: String },
    /// Numbers of more digits than are held cancel.
    #[error("numbers of more than 18 digits are rounded here and cancel: what is left is not exact; write it itself")]
    NotExact,
    /// Two factors without a multiplication sign between them.
    #[error("a multiplication sign is missing: write {left}*{right}")]
    ImplicitMultiplication { left: String, right: String },
    /// A vector or matrix where a number has to be.
    #[error("expected a number, found {found}")]
    NotANumber { found: String },
    /// Things that cannot be added or multiplied.
    #[error("{left} and {right} cannot be {verb}{}", if *.verb == "multiplied" { "; products of vectors are dot(a, b) and cross(a, b)" } else { "" })]
    Shapes { verb: &'static str, left: String, right: String },
    /// A list that is neither a vector nor a matrix.
    #[error("a vector has two or more numbers, a matrix two or more vectors of one length")]
    NoList,
    /// A function of vectors with something else.
    #[error("`{function}` takes {expected}, found {found}")]
    WrongShape { function: String, expected: &'static str, found: String },
    /// A component that there is not.
    #[error("{shape} has no component `{name}`; they are .x .y .z of a vector, .xx to .zz of a matrix")]
    NoComponent { name: String, shape: String },
    /// Axes of a rotation that mean nothing, or not as many as angles.
    #[error("axes are some of the letters x, y and z with an angle each, as in rotation(zxz, psi, theta, phi); found `{letters}` and {found} angle{}", plural(*.found))]
    Axes { letters: String, found: usize },
    /// A derivative that cannot be written.
    #[error("this has no time derivative here: it contains a velocity, and its derivative would contain accelerations")]
    NoRate,
    /// A literal beyond the range of numbers.
    #[error("the number {} is out of range (about 1e-308 to 1e308)", shortened(.literal))]
    NumberOutOfRange { literal: String },
    /// A divisor that is the number zero.
    #[error("division by zero")]
    DivisionByZero,
    /// A number that is not finite, such as log(0).
    #[error("the value is not finite")]
    NotFinite,
    /// More nested parentheses or powers than are accepted.
    #[error("more than {limit} nested parentheses or powers")]
    TooDeep { limit: usize },
}

impl ParseErrorKind {
    /// Whether the text is not a formula, whatever its names mean.
    pub(crate) fn is_of_grammar(&self) -> bool {
        use ParseErrorKind::*;
        matches!(
            self,
            UnexpectedCharacter { .. }
                | UnexpectedToken { .. }
                | UnexpectedEnd { .. }
                | UnclosedParenthesis
                | UnmatchedParenthesis
                | ImplicitMultiplication { .. }
                | FunctionWithoutArgument { .. }
                | NumberOutOfRange { .. }
                | TooDeep { .. }
        )
    }
}

fn hinted(hint: Option<&str>) -> String {
    hint.map_or_else(String::new, |h| format!("; {h}"))
}

fn meant(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |s| format!("; did you mean `{s}`?"))
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// At most 40 characters of `text`.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

impl ParseError {
    fn line_start(&self) -> usize {
        self.text[..self.offset].rfind('\n').map_or(0, |i| i + 1)
    }

    /// The line of the offending piece, counted from 1.
    pub fn line(&self) -> usize {
        self.text[..self.offset].matches('\n').count() + 1
    }

    /// The column of the offending piece in characters, counted from 1.
    pub fn column(&self) -> usize {
        self.text[self.line_start()..self.offset].chars().count() + 1
    }
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.text[self.line_start()..].split('\n').next().unwrap_or_default();
        let piece = self.text[self.offset..].split('\n').next().unwrap_or_default();
        let length = piece.char_indices().take_while(|(i, _)| *i < self.length).count();
        let [line, carets] = excerpt(line, self.column(), length);
        write!(f, "line {}, column {}: {}", self.line(), self.column(), self.kind)?;
        write!(f, "\n  {line}\n  {carets}")
    }
}

impl std::error::Error for ParseError {}
