//! Quantities that are watched along a motion, as numbers: of what is known before the equations of the
//! instant are solved, or of their unknowns as well.

use symbolic::{CompileError, Evaluator, Expr};

use crate::equations::Equations;

/// Some quantities, compiled.
#[derive(Clone)]
pub(crate) struct OfInstant {
    pub(crate) program: Evaluator<f64>,
    /// Whether unknowns of the instant stand in them, and the number of inputs.
    pub(crate) need_unknowns: bool,
    pub(crate) inputs: usize,
}

impl OfInstant {
    pub(crate) fn new(equations: &Equations, quantities: &[Expr]) -> Result<Self, CompileError> {
        let mut inputs = equations.known_symbols();
        let need_unknowns = equations.need_unknowns(quantities);
        if need_unknowns {
            inputs.extend(equations.unknowns());
        }
        Ok(OfInstant { program: equations.evaluator(&inputs, quantities)?, need_unknowns, inputs: inputs.len() })
    }

    /// Number of quantities.
    pub(crate) fn count(&self) -> usize {
        self.program.values().len()
    }

    /// From `t, y, constants, z`.
    pub(crate) fn evaluate(&mut self, inputs: &[f64]) -> &[f64] {
        self.program.evaluate(&inputs[..self.inputs])
    }
}

impl Equations {
    /// Whether unknowns of the instant stand in these.
    pub(crate) fn need_unknowns(&self, quantities: &[Expr]) -> bool {
        let behind = self.symbols_behind(quantities.iter().copied());
        self.unknowns().iter().any(|z| behind.contains(z))
    }
}
