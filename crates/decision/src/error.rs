//! Reasons why a question cannot be decided.

use integrate::CallError;
use mechanics::StartError;
use symbolic::CompileError;

/// Why a question cannot be put or decided.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum DecisionError {
    /// The equations cannot be read as a condition on the constants.
    #[error("{formulation}: {reason}")]
    Unsuited { formulation: &'static str, reason: String },
    /// The family leaves no solvable system of one instant along the curve.
    #[error("at t = {t} the equations of the {formulation} family are singular along the curve")]
    Singular { formulation: &'static str, t: f64 },
    /// The curve could not be followed.
    #[error("the curve cannot be followed: {reason}")]
    Curve { reason: String },
    /// The limit on steps was reached.
    #[error("the curve cannot be followed: more than {limit} steps")]
    Steps { limit: usize },
    /// It takes longer than a question may.
    #[error(transparent)]
    Stopped(#[from] symbolic::Stopped),
    /// A tape could not be made.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The time loop was called with something it does not take.
    #[error(transparent)]
    Call(#[from] CallError),
    /// The variables of a parametrization have no start.
    #[error(transparent)]
    Start(#[from] StartError),
}
