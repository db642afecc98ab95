//! Why there is no fit.

use comparison::Contradicted;
use motion::SolveError;
use scene::TableError;
use symbolic::CompileError;

/// A film that cannot be read, or a question that cannot be asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum FitError {
    /// The table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// What a table says makes no sense, at `FILE:LINE:COLUMN`.
    #[error("{place}: {error}")]
    At { place: String, error: Box<FitError> },
    /// The table shows nothing.
    #[error("there is no column but `t`")]
    NoColumn,
    /// A column is neither in `[film]` nor an expression.
    #[error("no expression belongs to the column `{column}`: it is not in [film], and as an expression: {reason}")]
    Column { column: String, reason: String },
    /// The expression of a column contains what the scene does not have.
    #[error("the column `{column}`: {error}")]
    Expression { column: String, error: CompileError },
    /// A column has no standard deviation.
    #[error("the column `{0}` has no standard deviation, neither in [film] nor by name nor for all columns")]
    NoDeviation(String),
    /// A standard deviation is not positive, or its square is no number.
    #[error("the standard deviation of `{of}` is {found}; it must be from 1e-100 to 1e100")]
    Deviation { of: String, found: f64 },
    /// A film begins before the scene.
    #[error("t = {t} is before the start of the scene, t = {start}")]
    BeforeTheStart { t: f64, start: f64 },
    /// There are no more numbers in the films than unknowns.
    #[error("the films have {found} numbers, and there are {unknowns} unknowns; more numbers are needed")]
    TooShort {
        /// Cells that are not empty.
        found: usize,
        unknowns: usize,
    },
    /// There are more numbers in the films than are fitted.
    #[error("the films have {found} numbers; deltaq fits at most {limit}: leave out rows or columns")]
    TooLong { found: usize, limit: usize },
    /// A quantity cannot be read.
    #[error("`{text}` is not a number with a unit; units are {units}")]
    Quantity { text: String, units: String },
    /// A unit and the label of the scene are of different kinds.
    #[error(
        "`{column}` is said to be in {unit}, and the scene says {label}: give the numbers in the units of the scene, \
         without a unit, or a standard deviation of its own"
    )]
    Unit { column: String, unit: String, label: String },
    /// An unknown cannot be read.
    #[error("`{text}` is not an unknown: {reason}")]
    Unknown { text: String, reason: String },
    /// When a film looks cannot be read.
    #[error("`{text}` is not a film to be made: {reason}")]
    Sampling { text: String, reason: String },
    /// A number that is to be chosen cannot be read, or does not belong there.
    #[error("`{text}` cannot be chosen: {reason}")]
    Choose { text: String, reason: String },
    /// A number of the scene is unknown twice.
    #[error("`{0}` is unknown twice")]
    Twice(String),
    /// Nothing is unknown.
    #[error("no number is unknown, so there is nothing to fit")]
    NoUnknown,
    /// No start of the search leads to a motion through the film.
    #[error("of {starts} starts of the search none leads to a motion: {reason}")]
    NoMotion { starts: usize, reason: String },
    /// The scene lacks a formulation.
    #[error("the scene has no {0} motion")]
    NoMotionOf(&'static str),
    /// The two formulations to be told apart are the same.
    #[error("films are to tell two formulations apart, and both are {0}")]
    ToldFromItself(&'static str),
    /// A standard deviation is estimated from a film that is made already.
    #[error("a film that is not yet made has no standard deviations that could be estimated: give `{0}` one")]
    NothingToEstimate(String),
    /// Proof and fits contradict each other.
    #[error(transparent)]
    Contradicted(#[from] Contradicted),
    /// All unknowns change nothing.
    #[error("the films show none of the unknowns")]
    ShowsNothing,
    /// The motion cannot be set up.
    #[error(transparent)]
    Motion(#[from] SolveError),
}
