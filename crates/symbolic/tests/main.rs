//! Expressions as a user of the crate meets them: one program, one module a subject.

mod algebra;
mod evaluation;
mod properties;
mod series;
mod text;
