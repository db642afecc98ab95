//! Expressions as straight-line programs, in any [`Scalar`](crate::Scalar) or in another language.

pub(crate) mod bounded;
pub(crate) mod code;
pub(crate) mod evaluate;
pub(crate) mod evaluator;
pub(crate) mod lower;
pub(crate) mod program;
pub(crate) mod saturate;
pub(crate) mod scalar;
pub(crate) mod tape;
