//! Errors in scene files, with their places.

use std::fmt;
use std::ops::Range;

use symbolic::{ParseErrorKind, excerpt};

use mechanics::{RemovalError, StartError};

use crate::{NameFault, Remark, Unavailable};

/// A fault in a scene file: the place and what was expected there.
///
/// Displayed as `file:line:column: message`, the line, and carets under the place.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    /// File, or name of the scene.
    pub file: String,
    /// Line, from 1; 0 where the fault is not in the text (an override, a file that cannot be read).
    pub line: usize,
    /// Column in characters, from 1; 0 as for [`SceneError::line`].
    pub column: usize,
    /// The line in question.
    pub source_line: String,
    /// Length of the place in characters, at least 1.
    pub length: usize,
    /// The fault.
    pub kind: Box<SceneErrorKind>,
    /// Further faults, as far as the file could be read, in its order.
    pub also: Vec<SceneError>,
}

/// A fault of a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum SceneErrorKind {
    /// The file is larger than a scene can be.
    #[error("the file has {size} bytes or more; a scene has at most {limit}")]
    TooLarge { size: u64, limit: u64 },
    /// The file could not be read.
    #[error("the file cannot be read: {reason}")]
    Unreadable { reason: std::io::ErrorKind },
    /// The file is not UTF-8.
    #[error("byte {byte:#04x} at offset {offset} is not UTF-8 text")]
    NotUtf8 { byte: u8, offset: usize },
    /// Nothing in it.
    #[error("the scene is empty; it needs title, [coordinates], [system], [start.velocities] and [run]")]
    Empty,
    /// Not TOML.
    #[error("not valid TOML: {message}")]
    Syntax { message: String },
    /// A scene of a format that came later.
    #[error(
        "the scene is of format {format}; this version of deltaq reads formats up to {}: a newer one is needed",
        crate::format::FORMAT
    )]
    NewerFormat { format: u64 },
    /// A key that means nothing here.
    #[error("unknown key `{key}` in {section}{}; known here: {}", meant(.suggestion), .known.join(", "))]
    UnknownKey { key: String, section: String, suggestion: Option<String>, known: Vec<String> },
    /// A name that stands for nothing here.
    #[error("`{name}` is not a {expected}{}", meant(.suggestion))]
    UnknownName { name: String, expected: &'static str, suggestion: Option<String> },
    /// A key that is needed.
    #[error("`{key}` is missing in {section}; expected {expected}")]
    MissingKey { key: &'static str, section: String, expected: &'static str },
    /// A section without content.
    #[error("{section} is empty; expected {expected}")]
    EmptySection { section: String, expected: &'static str },
    /// A value of the wrong type.
    #[error("expected {expected}, found {found}")]
    WrongType { found: &'static str, expected: &'static str },
    /// A word that is not one of those that can stand here.
    #[error("expected {expected}, found {found:?}")]
    WrongWord { found: String, expected: &'static str },
    /// A list of the wrong length.
    #[error("{found} {what} where {expected} are needed")]
    WrongLength { what: &'static str, found: usize, expected: usize },
    /// A number, vector or matrix of the wrong shape.
    #[error("expected {expected}, found {found}")]
    WrongShape { found: String, expected: &'static str },
    /// Too few or too many sizes of a body.
    #[error("the size of a {word} is [{sizes}], found {found} number{}", if *.found == 1 { "" } else { "s" })]
    WrongSizes { word: &'static str, sizes: String, found: usize },
    /// A matrix that does not rotate.
    #[error(
        "no rotation at the start: R Rᵀ differs from the unit matrix by {residual:.3e}, limit {limit:.0e}, and det R is {determinant:.3}"
    )]
    NoRotation {
        /// Largest entry of `R Rᵀ − 1` in magnitude.
        residual: f64,
        limit: f64,
        determinant: f64,
    },
    /// A number that is not finite.
    #[error("{what} must be finite, found {value}")]
    NotFinite { what: String, value: f64 },
    /// A number out of its range.
    #[error("{what} must be greater than {limit}, found {value}")]
    OutOfRange { what: &'static str, value: f64, limit: f64 },
    /// A name that cannot be used.
    #[error("`{name}` cannot be a name: {fault}")]
    InvalidName { name: String, fault: NameFault },
    /// A formula that cannot be read.
    #[error(transparent)]
    Expression(ParseErrorKind),
    /// A name that is defined but cannot be used here.
    #[error("`{name}` cannot be used here: {reason}")]
    Unavailable { name: String, reason: Unavailable },
    /// A constraint that the motion has no part in.
    #[error("constraint {number} contains no velocity and no coordinate")]
    NoVelocity {
        /// Number of the constraint, from 1.
        number: usize,
    },
    /// The sides of a start equation do not go together.
    #[error("the left side has {left} components, the right side {right}")]
    UnequalSides { left: usize, right: usize },
    /// A start equation that no velocity can fulfil.
    #[error("start equation {number} contains no velocity; starts of coordinates stand in [coordinates]")]
    StartAtRest {
        /// Its number, from 1.
        number: usize,
    },
    /// A constraint on positions that the start does not satisfy.
    #[error(
        "constraint {number} is one on positions, and the start is not on it: residual {residual:.3e}, limit {limit:.0e}"
    )]
    OffPosition {
        /// Number of the constraint, from 1.
        number: usize,
        residual: f64,
        limit: f64,
    },
    /// Coordinates without a start that constraints on positions do not determine.
    #[error("{}", configurations(.names, .found))]
    Configurations {
        /// The coordinates.
        names: Vec<String>,
        /// All values that were found for them.
        found: Vec<Vec<f64>>,
    },
    /// Definitions or parameters that need each other.
    #[error("these are defined in a circle: {}", .names.join(" → "))]
    Circle { names: Vec<String> },
    /// A name that could not be read itself.
    #[error("`{name}` has a fault of its own")]
    Faulty { name: String },
    /// An angle in degrees.
    #[error(
        "`{unit}` would have to be converted, and angles are in radians: write unit = \"rad\" and, for the start, \"30*pi/180\"; other units are labels"
    )]
    Degrees { unit: String },
    /// Not as many conditions on virtual displacements as constraints.
    #[error("{found} conditions in `virtual` for {expected} constraints; one for each is needed")]
    VirtualConditions { found: usize, expected: usize },
    /// A condition on virtual displacements without a rate.
    #[error("condition {number} in `virtual` contains no velocity: write δx as x', as in \"x' - y'*tan(phi)\"")]
    NoRate {
        /// Its number, from 1.
        number: usize,
    },
    /// As many constraints as coordinates.
    #[error("{found} constraints for {dimension} coordinates leave nothing to move; at most {} are possible", .dimension.saturating_sub(1))]
    TooManyConstraints { found: usize, dimension: usize },
    /// A multiplier of a constraint that follows from the others.
    #[error("constraint {number} follows from the others: its multiplier is zero, not {value:?}")]
    RedundantMultiplier { number: usize, value: f64 },
    /// A coordinate that a removal does not know what to do with.
    #[error("removal `{removal}`: coordinate `{coordinate}` is {}; it must be exactly one of: a parameter, in rates, in direct", joined(.roles))]
    CoordinateRole { removal: String, coordinate: String, roles: Vec<&'static str> },
    /// No fault, but what a reviewer would ask about.
    #[error(transparent)]
    Remark(Remark),
    /// Bodies from which no formulas follow.
    #[error(transparent)]
    Bodies(bodies::FaultKind),
    /// A wrong parametrization.
    #[error(transparent)]
    Removal(RemovalError),
    /// Start data from which no motion starts.
    #[error(transparent)]
    Start(StartError),
}

fn meant(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map_or_else(String::new, |s| format!(", did you mean `{s}`?"))
}

fn joined(roles: &[&str]) -> String {
    if roles.is_empty() { "none of them".into() } else { roles.join(" and ") }
}

fn configurations(names: &[String], found: &[Vec<f64>]) -> String {
    let one =
        |x: &Vec<f64>| names.iter().zip(x).map(|(name, x)| format!("{name} = {x:.6}")).collect::<Vec<_>>().join(", ");
    let names = names.join(", ");
    match found {
        [] => format!("no start of {names} is known: no values were found that constraints on positions determine"),
        _ => format!(
            "constraints on positions leave {} configurations: {}; choose one by `guess` in [coordinates]",
            found.len(),
            found.iter().map(one).collect::<Vec<_>>().join("; ")
        ),
    }
}

impl SceneError {
    /// The fault `kind` at the bytes `span` of `text`.
    pub(crate) fn at(file: &str, text: &str, span: Range<usize>, kind: SceneErrorKind) -> Self {
        let start = text.floor_char_boundary(span.start);
        let end = text.floor_char_boundary(span.end.max(start));
        let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
        SceneError {
            file: file.into(),
            line: text[..start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            source_line: text[line_start..line_end].trim_end_matches('\r').into(),
            length: text[start..end.min(line_end)].chars().count().max(1),
            kind: Box::new(kind),
            also: Vec::new(),
        }
    }

    /// A fault that is not in the text.
    pub(crate) fn outside(file: &str, kind: SceneErrorKind) -> Self {
        let (file, source_line) = (file.into(), String::new());
        SceneError { file, line: 0, column: 0, source_line, length: 1, kind: Box::new(kind), also: Vec::new() }
    }

    /// All that was found, in the order of the file, as one, without what only follows from another fault.
    pub(crate) fn together(mut faults: Vec<SceneError>) -> Option<Self> {
        let misspelt: Vec<String> = faults.iter().filter_map(SceneError::meant).collect();
        let follows = |fault: &SceneError| match &*fault.kind {
            SceneErrorKind::Faulty { .. } => true,
            SceneErrorKind::MissingKey { key, .. } => misspelt.iter().any(|meant| meant == key),
            _ => false,
        };
        if !faults.iter().all(follows) {
            faults.retain(|fault| !follows(fault));
        }
        faults.sort_by_key(|fault| (fault.line, fault.column));
        faults.dedup();
        let mut faults = faults.into_iter();
        let first = faults.next()?;
        Some(SceneError { also: faults.collect(), ..first })
    }

    /// The key that an unknown one may have been meant for.
    fn meant(&self) -> Option<String> {
        match &*self.kind {
            SceneErrorKind::UnknownKey { suggestion, .. } => suggestion.clone(),
            _ => None,
        }
    }

    /// Each fault apart.
    pub fn each(&self) -> impl Iterator<Item = &SceneError> {
        std::iter::once(self).chain(&self.also)
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.file, self.kind)?;
        } else {
            write!(f, "{}:{}:{}: {}", self.file, self.line, self.column, self.kind)?;
            let [line, carets] = excerpt(&self.source_line, self.column, self.length);
            let number = self.line.to_string();
            let gutter = " ".repeat(number.len());
            write!(f, "\n{number} | {line}\n{gutter} | {carets}")?;
        }
        self.also.iter().try_for_each(|other| write!(f, "\n{other}"))
    }
}

impl std::error::Error for SceneError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.kind {
            SceneErrorKind::Removal(error) => Some(error),
            SceneErrorKind::Start(error) => Some(error),
            SceneErrorKind::Expression(error) => Some(error),
            _ => None,
        }
    }
}
