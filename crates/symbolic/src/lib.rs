//! Expression graphs: build, parse, differentiate, simplify, print, compile. Knows no mechanics.
#![allow(unused_variables, missing_docs)]
use std::collections::{BTreeSet, HashMap};

/// A node of a [`Graph`]. Equal expressions are the same node (hash-consing).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Expr(u32);

/// A named variable of a [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Symbol(u32);

/// Dense matrix of expressions, row-major.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    entries: Vec<Expr>,
}
impl Matrix {
    pub fn new(rows: usize, columns: usize, entries: Vec<Expr>) -> Self { unimplemented!() }
    pub fn from_fn(rows: usize, columns: usize, entry: impl FnMut(usize, usize) -> Expr) -> Self { unimplemented!() }
    pub fn rows(&self) -> usize { self.rows }
    pub fn columns(&self) -> usize { self.columns }
    pub fn entries(&self) -> &[Expr] { &self.entries }
    pub fn row(&self, i: usize) -> &[Expr] { unimplemented!() }
    pub fn column(&self, j: usize) -> Vec<Expr> { unimplemented!() }
    pub fn transpose(&self) -> Matrix { unimplemented!() }
}
impl std::ops::Index<(usize, usize)> for Matrix {
    type Output = Expr;
    fn index(&self, (i, j): (usize, usize)) -> &Expr { unimplemented!() }
}

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Function { Sin, Cos, Tan, Sinh, Cosh, Tanh, Asin, Acos, Atan, Asinh, Acosh, Atanh, Exp, Log }

/// The arena. Interior mutability: building needs only `&Graph`; `Send`, not `Sync`; `Clone` keeps all ids.
#[derive(Clone, Default)]
pub struct Graph {}

impl Graph {
    pub fn new() -> Self { unimplemented!() }
    // ---- symbols. A name is an identifier followed by primes: `x`, `x'`, `x''`; `mu_1'`. Same name = same symbol.
    pub fn symbol(&self, name: &str) -> Symbol { unimplemented!() }
    pub fn find_symbol(&self, name: &str) -> Option<Symbol> { unimplemented!() }
    pub fn name(&self, symbol: Symbol) -> String { unimplemented!() }
    pub fn variable(&self, symbol: Symbol) -> Expr { unimplemented!() }
    pub fn variables(&self, symbols: &[Symbol]) -> Vec<Expr> { unimplemented!() }
    pub fn as_symbol(&self, e: Expr) -> Option<Symbol> { unimplemented!() }
    // ---- numbers (exact rationals where possible, else f64)
    pub fn zero(&self) -> Expr { unimplemented!() }
    pub fn one(&self) -> Expr { unimplemented!() }
    pub fn integer(&self, n: i64) -> Expr { unimplemented!() }
    pub fn ratio(&self, numerator: i64, denominator: i64) -> Expr { unimplemented!() }
    pub fn number(&self, x: f64) -> Expr { unimplemented!() }
    pub fn as_number(&self, e: Expr) -> Option<f64> { unimplemented!() }
    /// Structurally the number 0 (see [`Graph::vanishes`] for the test that also expands and samples).
    pub fn is_zero(&self, e: Expr) -> bool { unimplemented!() }
    // ---- arithmetic
    pub fn add(&self, a: Expr, b: Expr) -> Expr { unimplemented!() }
    pub fn sub(&self, a: Expr, b: Expr) -> Expr { unimplemented!() }
    pub fn mul(&self, a: Expr, b: Expr) -> Expr { unimplemented!() }
    pub fn div(&self, a: Expr, b: Expr) -> Expr { unimplemented!() }
    pub fn neg(&self, a: Expr) -> Expr { unimplemented!() }
    pub fn pow(&self, base: Expr, exponent: Expr) -> Expr { unimplemented!() }
    pub fn powi(&self, base: Expr, exponent: i32) -> Expr { unimplemented!() }
    pub fn sqrt(&self, a: Expr) -> Expr { unimplemented!() }
    pub fn call(&self, function: Function, argument: Expr) -> Expr { unimplemented!() }
    pub fn atan2(&self, y: Expr, x: Expr) -> Expr { unimplemented!() }
    pub fn sum(&self, terms: &[Expr]) -> Expr { unimplemented!() }
    pub fn product(&self, factors: &[Expr]) -> Expr { unimplemented!() }
    /// Σ aᵢ bᵢ
    pub fn dot(&self, a: &[Expr], b: &[Expr]) -> Expr { unimplemented!() }
    pub fn mat_vec(&self, m: &Matrix, v: &[Expr]) -> Vec<Expr> { unimplemented!() }
    /// mᵀ v
    pub fn transpose_vec(&self, m: &Matrix, v: &[Expr]) -> Vec<Expr> { unimplemented!() }
    pub fn mat_mul(&self, a: &Matrix, b: &Matrix) -> Matrix { unimplemented!() }
    // ---- calculus
    pub fn derivative(&self, e: Expr, symbol: Symbol) -> Expr { unimplemented!() }
    pub fn gradient(&self, e: Expr, symbols: &[Symbol]) -> Vec<Expr> { unimplemented!() }
    /// rows: es, columns: symbols
    pub fn jacobian(&self, es: &[Expr], symbols: &[Symbol]) -> Matrix { unimplemented!() }
    /// de/dt = Σ ∂e/∂s · rate over the given (symbol, rate) pairs (explicit time: include (t, 1)).
    pub fn total_derivative(&self, e: Expr, rates: &[(Symbol, Expr)]) -> Expr { unimplemented!() }
    pub fn substitute(&self, e: Expr, map: &HashMap<Symbol, Expr>) -> Expr { unimplemented!() }
    pub fn expand(&self, e: Expr) -> Expr { unimplemented!() }
    // ---- questions
    pub fn depends_on(&self, e: Expr, symbol: Symbol) -> bool { unimplemented!() }
    pub fn symbols_of(&self, e: Expr) -> BTreeSet<Symbol> { unimplemented!() }
    /// Is `e` identically zero? Exact by expansion where that succeeds, else by evaluation at random points
    /// (fixed seed) against the round-off bound of the evaluation itself. `constants` are numbers to put in first.
    pub fn vanishes(&self, e: Expr, constants: &HashMap<Symbol, f64>) -> Vanishing { unimplemented!() }
    /// Every distinct base that stands in `es` under a negative power, and is not a number.
    pub fn denominators(&self, es: &[Expr]) -> Vec<Expr> { unimplemented!() }
    /// Number of distinct nodes reachable from `es`.
    pub fn size(&self, es: &[Expr]) -> usize { unimplemented!() }
    // ---- text
    /// `scope` maps a name (with its primes) to an expression; `None` means undefined. `known` is offered in the error.
    pub fn parse(&self, text: &str, scope: &dyn Fn(&str) -> Option<Expr>, known: &[String]) -> Result<Expr, ParseError> { unimplemented!() }
    pub fn plain(&self, e: Expr) -> String { unimplemented!() }
    pub fn latex(&self, e: Expr) -> String { unimplemented!() }
    pub fn latex_symbol(&self, symbol: Symbol) -> String { unimplemented!() }
    /// Pull out shared or long subexpressions as named intermediate quantities (names `prefix1`, `prefix2`, …) so that
    /// what remains can be read: (definitions in order of use, rewritten expressions).
    pub fn abbreviate(&self, es: &[Expr], prefix: &str) -> (Vec<(Symbol, Expr)>, Vec<Expr>) { unimplemented!() }
    // ---- evaluation
    /// A flat tape. `constants` are folded in. A symbol that is neither input nor constant is an error that names it.
    pub fn compile(&self, inputs: &[Symbol], outputs: &[Expr], constants: &HashMap<Symbol, f64>) -> Result<Tape, CompileError> { unimplemented!() }
    /// Slow, for single values.
    pub fn evaluate(&self, e: Expr, values: &HashMap<Symbol, f64>) -> Result<f64, CompileError> { unimplemented!() }
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Vanishing {
    /// Simplifies to the number zero.
    Exactly,
    /// Zero within round-off at `points` random points.
    Numerically { points: usize },
    /// Not zero: `value` was found where round-off is at most `bound`.
    No { value: f64, bound: f64 },
}

#[derive(Clone, Debug, PartialEq)]
pub struct ParseError { pub kind: ParseErrorKind, pub text: String, /** byte offset */ pub offset: usize, pub length: usize }
impl ParseError {
    pub fn line(&self) -> usize { unimplemented!() }
    pub fn column(&self) -> usize { unimplemented!() }
}
impl std::fmt::Display for ParseError { fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result { unimplemented!() } }
impl std::error::Error for ParseError {}
#[derive(Clone, Debug, PartialEq)]
pub enum ParseErrorKind { Undefined { name: String, suggestion: Option<String> } /* … */ }
impl std::fmt::Display for ParseErrorKind { fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result { unimplemented!() } }

#[derive(Clone, Debug, PartialEq)]
pub enum CompileError { Unbound { name: String } }
impl std::fmt::Display for CompileError { fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result { unimplemented!() } }
impl std::error::Error for CompileError {}

/// A flat program, generic over the number type; `Send + Sync`.
#[derive(Clone, Debug)]
pub struct Tape {}
impl Tape {
    pub fn inputs(&self) -> usize { unimplemented!() }
    pub fn outputs(&self) -> usize { unimplemented!() }
    /// number of instructions
    pub fn len(&self) -> usize { unimplemented!() }
    pub fn is_empty(&self) -> bool { unimplemented!() }
    /// Registers for one thread of evaluation (holds the constants as well).
    pub fn workspace<T: Scalar>(&self) -> Workspace<T> { unimplemented!() }
    pub fn evaluate<T: Scalar>(&self, inputs: &[T], workspace: &mut Workspace<T>, outputs: &mut [T]) { unimplemented!() }
}
#[derive(Clone, Debug)]
pub struct Workspace<T> { registers: Vec<T> }
pub trait Scalar: Copy { fn from_f64(x: f64) -> Self; }
impl Scalar for f64 { fn from_f64(x: f64) -> f64 { x } }
