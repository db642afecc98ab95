//! Discrete motions: one program, one module per subject.

mod compositions;
mod refusals;
mod structure;
