//! Taylor coefficients of a motion, from its equations.

use symbolic::{CompileError, Expr, SeriesInput, SeriesTape, SeriesWorkspace, Symbol};

use crate::blocks::CompiledBlock;
use crate::equations::Equations;
use crate::plan::Plan;

/// `y(t + τ) = Σ_k c_k (τ/unit)^k` from the equations of motion in some plan and the blocks left in it.
pub(crate) struct Series {
    tape: SeriesTape,
    /// From the first expansion on; nothing is kept in it from one to the next, and its room is large.
    workspace: Option<SeriesWorkspace<f64>>,
    /// Blocks that are solved numerically.
    left: Vec<usize>,
    /// Places in `(t, y, constants, z)` of what the tape takes.
    places: Vec<usize>,
    inputs: Vec<f64>,
}

/// Without the room to work in: most copies are only read.
impl Clone for Series {
    fn clone(&self) -> Self {
        let Series { tape, workspace: _, left, places, inputs } = self;
        let (tape, left, places, inputs) = (tape.clone(), left.clone(), places.clone(), inputs.clone());
        Series { tape, workspace: None, left, places, inputs }
    }
}

impl Series {
    pub(crate) fn new(equations: &Equations, plan: &Plan) -> Result<Self, CompileError> {
        let places = plan.places(equations);
        let tape = Series::tape(equations, plan)?;
        let inputs = vec![0.0; places.len()];
        Ok(Series { tape, workspace: None, left: plan.left.clone(), places, inputs })
    }

    /// Takes `t, y`, constants and the unknowns of blocks that are left.
    pub(crate) fn tape(equations: &Equations, plan: &Plan) -> Result<SeriesTape, CompileError> {
        let steady = |symbol: Symbol| (symbol, SeriesInput::Steady);
        let mut inputs = vec![(equations.time, SeriesInput::Time)];
        inputs.extend(equations.states.iter().enumerate().map(|(i, y)| (y.symbol, SeriesInput::State(i))));
        inputs.extend(equations.constant_symbols().into_iter().map(steady));
        let mut residuals: Vec<Vec<Expr>> = Vec::new();
        for (k, block) in equations.blocks.iter().enumerate() {
            if plan.left.contains(&k) {
                inputs.extend(block.unknowns.iter().map(|&z| (z, SeriesInput::Unknown(residuals.len()))));
                residuals.push(block.residuals.clone());
            }
        }
        let (rates, definitions) = (plan.rates(equations), plan.all_definitions(equations));
        equations.graph.compile_series(&inputs, &definitions, &rates, &residuals, &equations.parameters)
    }

    /// Expands to `order`, from `(t, y, constants, z)`; `z` solves the blocks left, with factors at hand.
    pub(crate) fn expand(&mut self, values: &[f64], unit: f64, order: usize, blocks: &mut [CompiledBlock]) {
        let workspace = self.workspace.get_or_insert_with(|| self.tape.workspace(order));
        self.tape.reorder(workspace, order);
        for (x, &place) in self.inputs.iter_mut().zip(&self.places) {
            *x = values[place];
        }
        let left = &self.left;
        // The factors of a Newton iteration are those of the point before the last.
        let sweeps = if left.iter().any(|&k| !blocks[k].linear) { 2 } else { 1 };
        self.tape.expand(&self.inputs, unit, workspace, sweeps, &mut |block, residual| {
            for x in residual.iter_mut() {
                *x = -*x;
            }
            blocks[left[block]].factors.solve(residual);
        });
    }

    /// The coefficients of the states, component after component, from the last expansion.
    pub(crate) fn write(&self, y: &[f64], coefficients: &mut [f64]) {
        let orders = coefficients.len() / y.len();
        for ((i, y), row) in y.iter().enumerate().zip(coefficients.chunks_exact_mut(orders)) {
            match self.workspace.as_ref().and_then(|workspace| self.tape.input(1 + i, workspace)) {
                Some(series) => row.copy_from_slice(series),
                None => {
                    row.fill(0.0);
                    row[0] = *y;
                }
            }
        }
    }
}
