//! Formulas as text, read and written: plain text, LaTeX, vectors and rotations.

pub(crate) mod abbreviate;
pub(crate) mod apply;
pub(crate) mod atoms;
pub(crate) mod domain;
pub(crate) mod excerpt;
pub(crate) mod latex_names;
pub(crate) mod lexer;
pub(crate) mod parse;
pub(crate) mod parse_error;
pub(crate) mod print;
pub(crate) mod print_latex;
pub(crate) mod print_order;
pub(crate) mod print_plain;
pub(crate) mod rotation;
pub(crate) mod suggest;
pub(crate) mod value;
