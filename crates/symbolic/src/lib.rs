//! Expression graphs: build, parse, differentiate, simplify, print, compile. Independent of mechanics.
//!
//! A [`Graph`] holds expressions in which every value stands once: equal expressions are the same node
//! ([`Expr`]), and so common subexpressions need no search. Constructors keep a canonical form: like
//! terms and factors are merged, numbers are exact fractions while they fit, of any decimal exponent, signs
//! come out of odd and even functions, P sin²u + P cos²u is P. Products of sums are multiplied out by
//! [`Graph::expand`] only. One source serves every use: [`Graph::latex`] for the reader,
//! [`Graph::derivative`] for the equations, and [`Graph::compile`] for numbers in any [`Scalar`] type.
//!
//! ```
//! use std::collections::HashMap;
//! use symbolic::Graph;
//!
//! let graph = Graph::new();
//! let [m, x, v] = ["m", "x", "x'"].map(|name| graph.symbol(name));
//! let lagrangian = graph.parse("m*x'^2/2 - m*cos(x)", &graph)?;
//!
//! let momentum = graph.derivative(lagrangian, v);
//! assert_eq!(graph.plain(momentum), "m*x'");
//! let force = graph.derivative(lagrangian, x);
//! assert_eq!(graph.latex(force), r"m \sin x");
//!
//! let tape = graph.compile(&[x, v], &[momentum, force], &HashMap::from([(m, 2.0)]))?;
//! let mut workspace = tape.workspace::<f64>();
//! let mut values = [0.0; 2];
//! tape.evaluate(&[0.0, 1.5], &mut workspace, &mut values);
//! assert_eq!(values, [3.0, 0.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Map
//!
//! | folder | what |
//! |---|---|
//! | `store` | the graph: nodes, numbers, functions, canonical form, derivatives |
//! | `text` | formulas as text, read and written |
//! | `questions` | is it zero, in which range, of which symbols; what is divided by; where it is steep |
//! | `programs` | straight-line programs: made, evaluated in any [`Scalar`], written in other languages |
//! | `series` | Taylor coefficients along a motion |
//!
//! `cancel` ends long work, `broken` is the border for panics.

mod broken;
mod cancel;
pub mod limits;
mod programs;
mod questions;
mod series;
mod store;
mod text;

pub use broken::{Broken, caught, work_on, worked_on};
pub use cancel::{Stopped, be_patient, cancellable, go_on, question};
pub use programs::bounded::Bounded;
pub use programs::code::{Code, Language};
pub use programs::evaluate::CompileError;
pub use programs::evaluator::Evaluator;
pub use programs::scalar::Scalar;
pub use programs::tape::{Recorded, Tape, Workspace};
pub use questions::identity::Vanishing;
pub use questions::random::SplitMix;
pub use questions::range::Range;
pub use questions::steep::Steep;
pub use series::{
    Correct, Dual, LANES, Lanes, Packs, Product, Products, SeriesInput, SeriesScalar, SeriesTape, SeriesWorkspace,
};
#[doc(hidden)]
pub use store::faults;
pub use store::fraction::Fraction;
pub use store::function::Function;
pub use store::graph::Graph;
pub use store::mark::{Expr, Symbol};
pub use store::matrix::Matrix;
pub use store::number::PI;
pub use text::excerpt::excerpt;
pub use text::lexer::names_in;
pub use text::parse_error::{ParseError, ParseErrorKind};
pub use text::suggest::{callable, nearest};
pub use text::value::{Scope, Turn, Value};
