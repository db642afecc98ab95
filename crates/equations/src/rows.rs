//! The rows `A = ∂f/∂v` of the constraints as numbers.

use nalgebra::DMatrix;
use symbolic::{CompileError, Evaluator};

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
