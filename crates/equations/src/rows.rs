//! The rows `A = ∂f/∂v` of the constraints as numbers.

use nalgebra::DMatrix;
use symbolic::{CompileError, Evaluator};

use crate::blocks::EvaluationFailure;
use crate::compiled::Compiled;
use crate::equations::Equations;

/// [`Equations::rows`], compiled.
#[derive(Clone)]
pub(crate) struct Rows {
    pub(crate) program: Evaluator<f64>,
    pub(crate) shape: (usize, usize),
    /// Whether they contain unknowns of the instant, and the number of inputs.
    pub(crate) need_unknowns: bool,
    pub(crate) inputs: usize,
    /// [`crate::ConstraintRows::replaceable`].
    pub(crate) replaceable: bool,
}

impl Rows {
    pub(crate) fn new(equations: &Equations) -> Result<Option<Self>, CompileError> {
        let Some(rows) = &equations.rows else { return Ok(None) };
        let mut inputs = equations.known_symbols();
        let need_unknowns = equations.rows_need_unknowns();
        if need_unknowns {
            inputs.extend(equations.unknowns());
        }
        let program = equations.evaluator(&inputs, rows.jacobian.entries())?;
        let shape = (rows.jacobian.rows(), rows.jacobian.columns());
        let replaceable = rows.replaceable && !need_unknowns;
        Ok(Some(Rows { program, shape, need_unknowns, inputs: inputs.len(), replaceable }))
    }

    /// `1/det(N Nᵀ)` of the rows `N`, made of length 1: 1 where they are orthogonal, and large where they
    /// nearly depend.
    pub(crate) fn dependence(&mut self, inputs: &[f64]) -> f64 {
        let (h, n) = self.shape;
        let entries = DMatrix::from_row_slice(h, n, self.program.evaluate(&inputs[..self.inputs]));
        let lengths: f64 = entries.row_iter().map(|row| row.norm_squared()).product();
        lengths / (&entries * entries.transpose()).determinant()
    }
}

impl Equations {
    /// Whether [`Equations::rows`] contain unknowns of the instant.
    pub(crate) fn rows_need_unknowns(&self) -> bool {
        let entries = self.rows.iter().flat_map(|rows| rows.jacobian.entries().iter().copied());
        let behind = self.symbols_behind(entries);
        self.unknowns().iter().any(|z| behind.contains(z))
    }
}

impl Compiled {
    /// Rows and columns of [`Equations::rows`]; `(0, 0)` where there are none.
    pub fn rank(&self) -> (usize, usize) {
        self.rows.as_ref().map_or((0, 0), |rows| rows.shape)
    }

    /// The entries of [`Equations::rows`] at `(t, y)`, row-major.
    ///
    /// # Errors
    /// As [`Compiled::rates`].
    pub fn rows(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.load(t, y);
        if self.rows.as_ref().is_some_and(|rows| rows.need_unknowns) {
            self.solve_instant(t, y)?;
        }
        if let Some(rows) = &mut self.rows {
            entries.copy_from_slice(rows.program.evaluate(&self.inputs[..rows.inputs]));
        }
        Ok(())
    }

    /// Whether other pivots might be taken ([`Equations::chart`]).
    pub fn has_chart(&self) -> bool {
        self.guards.values().len() > self.guards() || self.rows.as_ref().is_some_and(|rows| rows.replaceable)
    }
}
