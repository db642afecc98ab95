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
//! let scope = |name: &str| graph.find_symbol(name).map(|s| graph.variable(s));
//! let lagrangian = graph.parse("m*x'^2/2 - m*cos(x)", &scope, &[])?;
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

mod abbreviate;
mod adopt;
mod apply;
mod arena;
mod atoms;
mod bounded;
mod broken;
mod calculus;
mod cancel;
mod code;
mod divisors;
mod domain;
mod evaluate;
mod evaluator;
mod excerpt;
mod expand;
mod factor;
#[doc(hidden)]
pub mod faults;
mod fraction;
mod function;
mod graph;
mod identity;
mod latex_names;
mod lexer;
mod lower;
mod made_of;
mod mark;
mod matrix;
mod normal_form;
mod number;
mod parse;
mod parse_error;
mod print;
mod print_latex;
mod print_order;
mod print_plain;
mod program;
mod random;
mod range;
mod rational_identity;
mod rotation;
mod saturate;
mod scalar;
mod series;
mod simplify;
mod steep;
mod suggest;
mod sum_factor;
mod tape;
mod value;

pub use bounded::Bounded;
pub use broken::{Broken, caught, work_on, worked_on};
pub use cancel::{Stopped, be_patient, cancellable, go_on, question};
pub use code::{Code, Language};
pub use evaluate::CompileError;
pub use evaluator::Evaluator;
pub use excerpt::excerpt;
pub use fraction::Fraction;
pub use function::Function;
pub use graph::Graph;
pub use identity::Vanishing;
pub use lexer::names_in;
pub use mark::{Expr, Symbol};
pub use matrix::Matrix;
pub use number::PI;
pub use parse_error::{ParseError, ParseErrorKind};
pub use random::{SplitMix, Xorshift};
pub use range::Range;
pub use scalar::Scalar;
pub use series::{
    Correct, Dual, LANES, Lanes, Product, SeriesInput, SeriesScalar, SeriesTape, SeriesWorkspace, Store, Task, Weights,
};
pub use steep::Steep;
pub use suggest::{callable, nearest};
pub use tape::{Recorded, Tape, Workspace};
pub use value::{Scope, Turn, Value};
