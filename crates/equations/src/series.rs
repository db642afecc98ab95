//! Taylor coefficients of a motion, from its equations.

use std::collections::BTreeSet;

use symbolic::{CompileError, Expr, SeriesInput, SeriesScalar, SeriesTape, SeriesWorkspace, Symbol};

use crate::blocks::CompiledBlock;
use crate::equations::Equations;
use crate::plan::Plan;

/// `y(t + τ) = Σ_k c_k (τ/unit)^k` from the equations of motion in some plan and the blocks left in it.
pub struct Series<T: SeriesScalar = f64> {
    tape: SeriesTape,
    /// From the first expansion on; nothing is kept in it from one to the next, and its room is large.
    workspace: Option<SeriesWorkspace<T>>,
    /// Blocks that are solved numerically.
    left: Vec<usize>,
    /// Places in `(t, y, constants, z)` of what the tape takes.
    places: Vec<usize>,
    inputs: Vec<T>,
}

/// Without the room to work in: most copies are only read.
impl<T: SeriesScalar> Clone for Series<T> {
    fn clone(&self) -> Self {
        let Series { tape, workspace: _, left, places, inputs } = self;
        let (tape, left, places, inputs) = (tape.clone(), left.clone(), places.clone(), inputs.clone());
        Series { tape, workspace: None, left, places, inputs }
    }
}

impl<T: SeriesScalar> Series<T> {
    pub(crate) fn new(equations: &Equations, plan: &Plan) -> Result<Self, CompileError> {
        let places = plan.places(equations);
        let tape = Series::tape(equations, plan)?;
        let inputs = vec![T::from_f64(0.0); places.len()];
        Ok(Series { tape, workspace: None, left: plan.left.clone(), places, inputs })
    }

    /// Of equations whose blocks are all solved in numbers: for [`crate::Dynamics::expand`].
    ///
    /// # Errors
    /// As [`crate::Dynamics::new`].
    pub fn plain(equations: &Equations) -> Result<Self, CompileError> {
        Series::new(equations, &Plan::plain(equations))
    }
}

impl Series {
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
        let (g, rates, definitions) = (&equations.graph, plan.rates(equations), plan.all_definitions(equations));
        let known = inputs.iter().map(|i| i.0).chain(definitions.iter().map(|d| d.0));
        let known: BTreeSet<Symbol> = known.chain(equations.parameters.keys().copied()).collect();
        // of what the rates do not need, some may be left out
        let mut derivatives = equations.derivatives.clone();
        derivatives.retain(|(symbol, of)| known.contains(symbol) && g.symbols_of(*of).is_subset(&known));
        g.compile_series(&inputs, &definitions, &rates, &residuals, &derivatives, &equations.parameters)
    }

    /// The same in another number type.
    pub(crate) fn again<T: SeriesScalar>(&self) -> Series<T> {
        let (tape, left, places) = (self.tape.clone(), self.left.clone(), self.places.clone());
        Series { tape, workspace: None, left, places, inputs: vec![T::from_f64(0.0); self.places.len()] }
    }
}

impl<T: SeriesScalar> Series<T> {
    /// Expands to `order`, from `(t, y, constants, z)`; `z` solves the blocks left, with factors at hand, by
    /// which `solve` takes `(∂R/∂z)⁻¹` of what is handed to it. A block takes `sweeps` of these, and one more
    /// where it is not linear: the factors of a Newton iteration are those of the point before the last.
    pub(crate) fn expand<U>(
        &mut self,
        values: &[T],
        unit: f64,
        order: usize,
        (blocks, sweeps): (&mut [CompiledBlock<U>], usize),
        solve: fn(&mut CompiledBlock<U>, &mut [T]),
    ) {
        let workspace = self.workspace.get_or_insert_with(|| self.tape.workspace(order));
        self.tape.reorder(workspace, order);
        for (x, &place) in self.inputs.iter_mut().zip(&self.places) {
            *x = values[place];
        }
        let left = &self.left;
        let sweeps = sweeps + usize::from(left.iter().any(|&k| !blocks[k].linear));
        self.tape.expand(&self.inputs, T::from_f64(unit), workspace, sweeps, &mut |block, residual| {
            for x in residual.iter_mut() {
                *x = -*x;
            }
            solve(&mut blocks[left[block]], residual);
        });
    }

    /// [`SeriesTape::work`].
    pub(crate) fn work(&self) -> (usize, usize) {
        self.tape.work()
    }

    /// The coefficients of a state from the last expansion; none of one that is constant in time.
    pub(crate) fn state(&self, i: usize) -> Option<&[T]> {
        self.input(1 + i)
    }

    /// The same of any of `t, y, constants, z`, where all blocks are solved in numbers.
    pub fn input(&self, place: usize) -> Option<&[T]> {
        self.workspace.as_ref().and_then(|workspace| self.tape.input(place, workspace))
    }
}

impl Series {
    /// The coefficients of the states, component after component, from the last expansion.
    pub(crate) fn write(&self, y: &[f64], coefficients: &mut [f64]) {
        let orders = coefficients.len() / y.len();
        for ((i, y), row) in y.iter().enumerate().zip(coefficients.chunks_exact_mut(orders)) {
            match self.state(i) {
                Some(series) => row.copy_from_slice(series),
                None => {
                    row.fill(0.0);
                    row[0] = *y;
                }
            }
        }
    }
}
