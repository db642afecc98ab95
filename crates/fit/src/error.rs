//! Why there is no fit.

use deltaq::SolveError;
use scene::TableError;
use symbolic::CompileError;

/// A film that cannot be read, or a question that cannot be asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The table shows nothing.
    #[error("there is no column but `t`")]
    NoColumn,
    /// A column is neither in `[film]` nor an expression.
    #[error("no expression belongs to the column `{column}`: it is not in [film], and as an expression: {reason}")]
    Column {
        /// Its name.
        column: String,
        /// What is wrong with it as an expression.
        reason: String,
    },
    /// The expression of a column contains what the scene does not have.
    #[error("the column `{column}`: {error}")]
    Expression {
        /// Its name.
        column: String,
        /// Why it cannot be evaluated.
        error: CompileError,
    },
    /// A column has no standard deviation.
    #[error("the column `{0}` has no standard deviation, neither in [film] nor by name nor for all columns")]
    NoDeviation(String),
    /// A standard deviation is not positive.
    #[error("the standard deviation of `{of}` is {found}; it must be finite and above 0")]
    Deviation {
        /// Of what.
        of: String,
        /// What was given.
        found: f64,
    },
    /// A film begins before the scene.
    #[error("line {line}: t = {t} is before the start of the scene, t = {start}")]
    BeforeTheStart {
        /// Line of the file.
        line: usize,
        /// The first time.
        t: f64,
        /// The time of the start.
        start: f64,
    },
    /// There are no more numbers in the films than unknowns.
    #[error("the films have {found} numbers, and there are {unknowns} unknowns; more numbers are needed")]
    TooShort {
        /// Cells that are not empty.
        found: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// A quantity cannot be read.
    #[error("`{text}` is no number with a unit; units are {units}")]
    Quantity {
        /// What stands there.
        text: String,
        /// Units that are known.
        units: String,
    },
    /// An unknown cannot be read.
    #[error("`{text}` is no unknown: {reason}")]
    Unknown {
        /// What stands there.
        text: String,
        /// Why not.
        reason: String,
    },
    /// When a film looks cannot be read.
    #[error("`{text}` is no film to be made: {reason}")]
    Sampling {
        /// What stands there.
        text: String,
        /// Why not.
        reason: String,
    },
    /// A number that is to be chosen cannot be read, or does not belong there.
    #[error("`{text}` cannot be chosen: {reason}")]
    Choose {
        /// What stands there.
        text: String,
        /// Why not.
        reason: String,
    },
    /// A number of the scene is unknown twice.
    #[error("`{0}` is unknown twice")]
    Twice(String),
    /// Nothing is unknown.
    #[error("nothing is unknown: there is nothing to fit")]
    NoUnknown,
    /// No start of the search leads to a motion through the film.
    #[error("of {starts} starts of the search none leads to a motion: {reason}")]
    NoMotion {
        /// Starts that were tried.
        starts: usize,
        /// What the first of them says.
        reason: String,
    },
    /// The scene lacks a formulation.
    #[error("the scene has no {0} motion")]
    NoMotionOf(&'static str),
    /// A formulation is to be told from itself.
    #[error("films are to tell two formulations apart, and both are {0}")]
    ToldFromItself(&'static str),
    /// All unknowns change nothing.
    #[error("the films show none of the unknowns")]
    ShowsNothing,
    /// The motion cannot be set up.
    #[error(transparent)]
    Motion(#[from] SolveError),
}
