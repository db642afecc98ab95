//! The rows `A = ∂f/∂v` of the constraints as numbers.

use nalgebra::DMatrix;
use symbolic::CompileError;

use crate::equations::Equations;
use crate::of_instant::OfInstant;

/// [`Equations::rows`], compiled.
#[derive(Clone)]
pub(crate) struct Rows {
    pub(crate) entries: OfInstant,
    pub(crate) shape: (usize, usize),
    /// [`crate::ConstraintRows::replaceable`].
    pub(crate) replaceable: bool,
}

impl Rows {
    pub(crate) fn new(equations: &Equations) -> Result<Option<Self>, CompileError> {
        let Some(rows) = &equations.rows else { return Ok(None) };
        let entries = OfInstant::new(equations, rows.jacobian.entries())?;
        let shape = (rows.jacobian.rows(), rows.jacobian.columns());
        let replaceable = rows.replaceable && !entries.need_unknowns;
        Ok(Some(Rows { entries, shape, replaceable }))
    }

    /// `1/det(N Nᵀ)` of the rows `N`, made of length 1: 1 where they are orthogonal, and large where they
    /// nearly depend.
    pub(crate) fn dependence(&mut self, inputs: &[f64]) -> f64 {
        let (h, n) = self.shape;
        let entries = DMatrix::from_row_slice(h, n, self.entries.evaluate(inputs));
        let lengths: f64 = entries.row_iter().map(|row| row.norm_squared()).product();
        lengths / (&entries * entries.transpose()).determinant()
    }
}
