//! Equations of motion at one instant, in numbers of any kind: `ẏ = F(t, y, z)` with `R(z; t, y) = 0`.

use symbolic::{CompileError, Evaluator, Expr};

use crate::blocks::{CompiledBlock, EvaluationFailure, Real};
use crate::equations::{Equations, FreeConstant, Named};
use crate::outputs::Sizes;
use crate::series::Series;

/// Equations whose blocks are all solved in numbers, by LU factorization.
///
/// [`crate::Compiled`] has them in `f64`, decisions for their curves as well, and references in double-double
/// arithmetic. The inputs of all programs are `t, y, constants, z`.
#[derive(Clone)]
pub struct Dynamics<T = f64> {
    pub(crate) blocks: Vec<CompiledBlock<T>>,
    pub(crate) rates: Evaluator<T>,
    pub(crate) outputs: Evaluator<T>,
    pub(crate) sizes: Sizes,
    /// `t, y, constants, z` in this order.
    pub(crate) inputs: Vec<T>,
    /// `z` from which blocks that are not linear are solved.
    anchor: Vec<T>,
}

impl<T: Real> Dynamics<T> {
    /// Compiles `equations`; parameters are folded in, and so rounded to `f64`: see
    /// [`Equations::free_parameters`].
    ///
    /// # Errors
    /// [`CompileError`] where an expression contains a symbol that `equations` does not list: its fault.
    pub fn new(equations: &Equations) -> Result<Self, CompileError> {
        let known = equations.known_symbols();
        let mut all = known.clone();
        all.extend(equations.unknowns());
        let mut first = 0;
        let mut blocks = Vec::new();
        for block in &equations.blocks {
            blocks.push(CompiledBlock::new(equations, block, first, &known, &all)?);
            first += block.unknowns.len();
        }
        let rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        let outputs = equations.output_expressions();
        let zero = T::from_f64(0.0);
        Ok(Dynamics {
            blocks,
            rates: equations.evaluator(&all, &rates)?,
            outputs: equations.evaluator(&all, &outputs)?,
            sizes: Sizes {
                states: rates.len(),
                constants: equations.free_constants.len(),
                coordinates: equations.coordinates.len(),
                multipliers: equations.multipliers.len(),
                invariants: equations.invariants.len(),
                guards: equations.guards.len(),
            },
            anchor: vec![zero; all.len() - known.len()],
            inputs: vec![zero; all.len()],
        })
    }

    /// Sets the values of the free constants.
    ///
    /// # Panics
    /// If the length is not that of [`Equations::free_constants`].
    pub fn set_constants(&mut self, constants: &[T]) {
        let first = 1 + self.sizes.states;
        self.inputs[first..first + self.sizes.constants].copy_from_slice(constants);
    }

    /// Sets the point `z` from which blocks that are not linear are solved: one on the same branch, near by.
    ///
    /// # Panics
    /// If the length is not that of [`Equations::unknowns`].
    pub fn set_guess(&mut self, unknowns: &[T]) {
        self.anchor.copy_from_slice(unknowns);
    }

    /// The point set last, or found by [`Dynamics::settle`].
    pub fn guess(&self) -> &[T] {
        &self.anchor
    }

    /// Solves for the unknowns at `(t, y)`.
    ///
    /// # Errors
    /// [`EvaluationFailure`] where the equations of the instant cannot be solved.
    pub fn solve(&mut self, t: T, y: &[T]) -> Result<(), EvaluationFailure> {
        self.load(t, y);
        self.solve_blocks(|_| true)
    }

    /// [`Dynamics::solve`]; blocks that are not linear start from the unknowns found from now on.
    ///
    /// # Errors
    /// As [`Dynamics::solve`].
    pub fn settle(&mut self, t: T, y: &[T]) -> Result<(), EvaluationFailure> {
        self.solve(t, y)?;
        self.anchor.copy_from_slice(&self.inputs[self.sizes.known()..]);
        Ok(())
    }

    /// `F` at the instant that was solved last.
    pub fn rates(&mut self) -> &[T] {
        self.rates.evaluate(&self.inputs)
    }

    /// Coordinates, velocities, multipliers and invariants there.
    pub fn outputs(&mut self) -> &[T] {
        self.outputs.evaluate(&self.inputs)
    }

    /// Expands the motion through that instant to an order in `τ`, with `series` of all blocks.
    pub fn expand(&mut self, series: &mut Series<T>, order: usize) {
        series.expand(&self.inputs, 1.0, order, (&mut self.blocks, 1), |block, residual| block.factors.solve(residual));
    }

    /// Instructions of one evaluation of all programs.
    pub fn steps(&self) -> usize {
        let blocks: usize = self.blocks.iter().map(|block| block.program.tape().len()).sum();
        blocks + self.rates.tape().len() + self.outputs.tape().len()
    }

    pub(crate) fn load(&mut self, t: T, y: &[T]) {
        self.inputs[0] = t;
        self.inputs[1..1 + y.len()].copy_from_slice(y);
    }

    /// Solves those blocks that are `wanted`, where `(t, y)` is loaded.
    pub(crate) fn solve_blocks(&mut self, wanted: impl Fn(usize) -> bool) -> Result<(), EvaluationFailure> {
        let known = self.sizes.known();
        for (k, block) in self.blocks.iter_mut().enumerate() {
            if !wanted(k) {
                continue;
            }
            if block.linear {
                block.step(&self.inputs[..known])?;
                let (r, z) = (block.solution(), &mut self.inputs[known + block.first..]);
                z[..r.len()].copy_from_slice(r);
            } else {
                let (first, end) = (block.first, block.first + block.size);
                self.inputs[known + first..known + end].copy_from_slice(&self.anchor[first..end]);
                block.newton(&mut self.inputs, known)?;
            }
        }
        Ok(())
    }
}

impl Equations {
    /// Coordinates, velocities, multipliers and invariants.
    pub(crate) fn output_expressions(&self) -> Vec<Expr> {
        let named = |list: &[Named]| list.iter().map(|n| n.expression).collect::<Vec<_>>();
        [&self.coordinates[..], &self.velocities, &named(&self.multipliers), &named(&self.invariants)].concat()
    }

    /// The same equations with all parameters as free constants behind their own, and the values of these:
    /// nothing is folded into programs, and so nothing rounded.
    pub fn free_parameters(&self) -> (Equations, Vec<f64>) {
        let mut free = self.clone();
        let mut parameters: Vec<_> = free.parameters.drain().collect();
        parameters.sort_by_key(|(symbol, _)| *symbol);
        free.free_constants.extend(parameters.iter().map(|&(symbol, _)| FreeConstant::new(symbol)));
        (free, parameters.into_iter().map(|(_, value)| value).collect())
    }
}
