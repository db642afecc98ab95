//! Time integration: `y' = F(t, y)`; dense output, events, projection, error estimates, work counters. Knows no mechanics.
#![allow(unused_variables, missing_docs)]

/// What is to be integrated. Row-major square Jacobian.
pub trait Problem {
    fn dimension(&self) -> usize;
    /// F(t, y)
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError>;
    /// ∂F/∂y, row-major
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError>;
    /// Moves `y` onto the invariant manifold; returns the Euclidean length of the move (0 where there is nothing to project onto).
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<f64, EvaluationError> { Ok(0.0) }
    /// Number of event functions; a sign change of one is located and reported.
    fn events(&self) -> usize { 0 }
    fn event_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvaluationError> { Ok(()) }
}

/// F could not be evaluated here. `reason` is the problem's own words ("mass matrix singular: reciprocal condition 3e-17, limit 1e-14").
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluationError { pub reason: String }

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Method { Dop853, Tsit45, Bdf, TrBdf2, Esdirk34 }

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Projection { EveryStep, Off }

#[derive(Clone, Debug)]
pub struct Options {
    pub method: Method,
    pub relative_tolerance: f64,
    pub absolute_tolerance: f64,
    pub projection: Projection,
    pub max_steps: usize,
}
impl Options { pub fn with_tolerance(tolerance: f64) -> Self { unimplemented!() } }

/// A point on the time axis. Integration runs from `t` to `end`, forwards or backwards.
#[derive(Clone, Debug)]
pub struct Start { pub t: f64, pub y: Vec<f64> }

/// `Err` is a bad call (dimension mismatch, tolerance ≤ 0, non-finite start, end = start …); how the run ended is `Solution::status`.
pub fn integrate(problem: &mut dyn Problem, start: &Start, end: f64, options: &Options) -> Result<Solution, CallError> { unimplemented!() }

#[derive(Clone, Debug)]
pub struct Solution { pub status: Status, pub dense: DenseOutput, pub work: Work, pub projection: ProjectionReport }

#[derive(Clone, Debug, PartialEq)]
pub enum Status { Completed, Stopped { t: f64, cause: StopCause } }

#[derive(Clone, Debug, PartialEq)]
pub enum StopCause {
    /// An event function changed sign (or reached zero).
    Event { index: usize },
    /// F could not be evaluated however small the step.
    Evaluation { reason: String },
    /// A rate or a state became NaN or infinite however small the step.
    NotFinite { component: usize },
    StepTooSmall { step: f64, limit: f64 },
    TooManySteps { limit: usize },
    /// the library behind the method gave up
    Solver { reason: String },
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work { pub steps: usize, pub rejected: usize, pub evaluations: usize, pub jacobians: usize }
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProjectionReport { pub projections: usize, pub largest: f64, pub total: f64 }

/// Piecewise polynomial; valid on `[start, end]` of what was integrated.
#[derive(Clone, Debug)]
pub struct DenseOutput {}
impl DenseOutput {
    pub fn start(&self) -> f64 { unimplemented!() }
    pub fn end(&self) -> f64 { unimplemented!() }
    pub fn dimension(&self) -> usize { unimplemented!() }
    pub fn evaluate(&self, t: f64, y: &mut [f64]) { unimplemented!() }
    /// end points of the steps
    pub fn step_times(&self) -> Vec<f64> { unimplemented!() }
}
#[derive(Clone, Debug, PartialEq)]
pub enum CallError { Dimension { expected: usize, found: usize } }
impl std::fmt::Display for CallError { fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result { unimplemented!() } }
impl std::error::Error for CallError {}

/// Root of a scalar function between `a` and `b` (Brent), for events and for questions like "when does the gap pass ε".
pub fn find_root(f: &mut dyn FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Option<f64> { unimplemented!() }
