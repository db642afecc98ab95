//! Taylor coefficients of a motion, from its equations.

use symbolic::{CompileError, Expr, SeriesInput, SeriesTape, SeriesWorkspace, Symbol};

use crate::equations::Equations;

/// `y(t + τ) = Σ_k c_k (τ/unit)^k` from the equations of motion, blocks included.
#[derive(Clone)]
pub(crate) struct Series {
    pub(crate) tape: SeriesTape,
    pub(crate) workspace: SeriesWorkspace<f64>,
}

impl Series {
    pub(crate) fn new(equations: &Equations) -> Result<Self, CompileError> {
        let steady = |symbol: Symbol| (symbol, SeriesInput::Steady);
        let mut inputs = vec![(equations.time, SeriesInput::Time)];
        inputs.extend(equations.states.iter().enumerate().map(|(i, y)| (y.symbol, SeriesInput::State(i))));
        inputs.extend(equations.constant_symbols().into_iter().map(steady));
        for (i, block) in equations.blocks.iter().enumerate() {
            inputs.extend(block.unknowns.iter().map(|&z| (z, SeriesInput::Unknown(i))));
        }
        let rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        let residuals: Vec<Vec<Expr>> = equations.blocks.iter().map(|b| b.residuals.clone()).collect();
        let tape = equations.graph.compile_series(&inputs, &[], &rates, &residuals, &equations.parameters)?;
        Ok(Series { workspace: tape.workspace(1), tape })
    }

    /// The coefficients of the states, component after component, from the last expansion.
    pub(crate) fn write(&self, y: &[f64], coefficients: &mut [f64]) {
        let orders = coefficients.len() / y.len();
        for ((i, y), row) in y.iter().enumerate().zip(coefficients.chunks_exact_mut(orders)) {
            match self.tape.input(1 + i, &self.workspace) {
                Some(series) => row.copy_from_slice(series),
                None => {
                    row.fill(0.0);
                    row[0] = *y;
                }
            }
        }
    }
}
