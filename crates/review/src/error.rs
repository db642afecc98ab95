//! Why equations are not reviewed.

use scene::TableError;
use symbolic::{CompileError, ParseError, ParseErrorKind};

/// Equations that cannot be read, or of which nothing can be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum ReviewError {
    /// A formula that cannot be read.
    #[error("{place}:{}: {}{}{}", .error.column(), .error.kind, hint(.error), shown(.error))]
    Formula { place: String, error: Box<ParseError> },
    /// Something else at a place that cannot be read.
    #[error("{place}: {what}")]
    Unreadable { place: String, what: String },
    /// The table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// `--where` says what cannot be meant.
    #[error("where {text}: {what}")]
    Where { text: String, what: String },
    /// An expression of the scene cannot be evaluated.
    #[error(transparent)]
    Compile(#[from] CompileError),
}

fn shown(error: &ParseError) -> String {
    let [line, marks] = symbolic::excerpt(&error.text, error.column(), error.length.max(1));
    format!("\n  {line}\n  {marks}")
}

/// A coordinate that the scene does not have.
fn hint(error: &ParseError) -> &'static str {
    match &error.kind {
        ParseErrorKind::Undefined { name, .. } if name.ends_with("''") => {
            "; is it a coordinate of theirs? A formula says which of the scene it stands for (--where)"
        }
        _ => "",
    }
}
