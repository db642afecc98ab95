//! The graph: its nodes, numbers and functions, their canonical form, derivatives.

pub(crate) mod adopt;
pub(crate) mod arena;
pub(crate) mod calculus;
pub(crate) mod expand;
pub(crate) mod factor;
#[doc(hidden)]
pub mod faults;
pub(crate) mod fraction;
pub(crate) mod function;
pub(crate) mod graph;
pub(crate) mod mark;
pub(crate) mod matrix;
pub(crate) mod number;
pub(crate) mod simplify;
pub(crate) mod sum_factor;
