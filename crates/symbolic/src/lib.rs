//! Expression graphs: build, parse, differentiate, simplify, print, compile. Knows no mechanics.
#![allow(missing_docs)]

mod abbreviate;
mod arena;
mod calculus;
mod evaluate;
mod expand;
mod function;
mod graph;
mod identity;
mod latex_names;
mod lexer;
mod lower;
mod matrix;
mod normal;
mod number;
mod order;
mod parse;
mod parse_error;
mod print;
mod print_latex;
mod print_plain;
mod program;
mod questions;
mod scalar;
mod simplify;
mod suggest;
mod tape;

pub use evaluate::CompileError;
pub use function::Function;
pub use graph::{Expr, Graph, Symbol};
pub use identity::Vanishing;
pub use matrix::Matrix;
pub use parse_error::{ParseError, ParseErrorKind};
pub use scalar::Scalar;
pub use tape::{Tape, Workspace};
