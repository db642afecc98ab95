//! Equations of motion in any wide type: `ẏ = F(t, y, z)` with `R(z; t, y) = 0`.

use equations::Equations;
use mechanics::linear::Factors;
use symbolic::limits::ITERATIONS;
use symbolic::{CompileError, Evaluator, Expr, SeriesTape, SeriesWorkspace, Symbol, Tape};

use crate::limits::SMALL;
use crate::{ReferenceError, Wide};

const INSTANT: &str = "equations of the instant";

/// Where the numbers of a motion stand among the inputs of its tapes: `t, y, z`, free constants, parameters.
///
/// Parameters are inputs, not folded into the tapes: folding rounds them and their products.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) symbols: Vec<Symbol>,
    pub(crate) states: usize,
    pub(crate) unknowns: usize,
    /// Values of the free constants and the parameters.
    pub(crate) fixed: Vec<f64>,
}

impl Layout {
    fn new(equations: &Equations, constants: &[f64]) -> Self {
        let (states, unknowns) = (equations.state_symbols(), equations.unknowns());
        let sizes = (states.len(), unknowns.len());
        let (names, values) = parameters(equations);
        let symbols = [vec![equations.time], states, unknowns, equations.constant_symbols(), names].concat();
        Layout { symbols, states: sizes.0, unknowns: sizes.1, fixed: [constants, &values].concat() }
    }

    pub(crate) fn compile(&self, equations: &Equations, outputs: &[Expr]) -> Result<Tape, CompileError> {
        equations.graph.compile(&self.symbols, outputs, &Default::default())
    }

    fn first_unknown(&self) -> usize {
        1 + self.states
    }
}

/// Parameters and their values in the order of the symbols.
pub(crate) fn parameters(equations: &Equations) -> (Vec<Symbol>, Vec<f64>) {
    let mut ordered: Vec<(Symbol, f64)> = equations.parameters.iter().map(|(&s, &x)| (s, x)).collect();
    ordered.sort_by_key(|(s, _)| *s);
    ordered.into_iter().unzip()
}

/// Takes a step off `x`; its length relative to what is left.
pub(crate) fn subtract<T: Wide>(x: &mut [T], step: &[T]) -> f64 {
    let (mut length, mut size) = (0.0_f64, f64::MIN_POSITIVE);
    for (x, &dx) in x.iter_mut().zip(step) {
        *x = *x - dx;
        length = length.max(dx.size());
        size = size.max(x.size());
    }
    length / size
}

/// One block: its matrix `∂R/∂z` row-major and `R`.
struct WideBlock<T> {
    first: usize,
    size: usize,
    linear: bool,
    program: Evaluator<T>,
    /// Of the matrix at the solution.
    factors: Factors<T>,
}

/// Outputs of a motion at one time, in extended precision.
#[derive(Clone, Debug, PartialEq)]
pub struct Point<T> {
    /// `q`.
    pub coordinates: Vec<T>,
    /// `q̇`.
    pub velocities: Vec<T>,
    /// Multipliers or costates.
    pub multipliers: Vec<T>,
    /// The states `y` of the equations.
    pub states: Vec<T>,
}

/// Equations of motion at one instant, in a wide type.
pub struct Instant<T> {
    pub(crate) layout: Layout,
    blocks: Vec<WideBlock<T>>,
    rates: Evaluator<T>,
    outputs: Evaluator<T>,
    dimension: usize,
    inputs: Vec<T>,
}

impl<T: Wide> Instant<T> {
    /// Of `equations` with these values of their free constants.
    ///
    /// # Errors
    /// [`ReferenceError`] where they cannot be compiled.
    pub fn new(equations: &Equations, constants: &[f64]) -> Result<Self, ReferenceError> {
        let g = &equations.graph;
        let layout = Layout::new(equations, constants);
        let mut blocks = Vec::new();
        let mut first = 0;
        for block in &equations.blocks {
            let matrix = g.jacobian(&block.residuals, &block.unknowns);
            let linear = !matrix.entries().iter().any(|&e| block.unknowns.iter().any(|&z| g.depends_on(e, z)));
            let outputs = [matrix.entries(), &block.residuals].concat();
            let program = Evaluator::new(layout.compile(equations, &outputs)?);
            let size = block.unknowns.len();
            blocks.push(WideBlock { first, size, linear, program, factors: Factors::new(size) });
            first += size;
        }
        let rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        let multipliers: Vec<Expr> = equations.multipliers.iter().map(|m| m.expression).collect();
        let outputs = [&equations.coordinates[..], &equations.velocities, &multipliers].concat();
        let mut inputs = vec![T::zero(); layout.symbols.len()];
        let fixed = inputs.len() - layout.fixed.len();
        for (input, &x) in inputs[fixed..].iter_mut().zip(&layout.fixed) {
            *input = T::from_f64(x);
        }
        Ok(Instant {
            rates: Evaluator::new(layout.compile(equations, &rates)?),
            outputs: Evaluator::new(layout.compile(equations, &outputs)?),
            dimension: equations.coordinates.len(),
            layout,
            blocks,
            inputs,
        })
    }

    /// Sets the point from which the unknowns are solved next.
    pub fn set_guess(&mut self, unknowns: &[T]) {
        let first = self.layout.first_unknown();
        self.inputs[first..first + unknowns.len()].copy_from_slice(unknowns);
    }

    /// The series of states, from the solution of the instant.
    pub(crate) fn expand(&mut self, tape: &SeriesTape, workspace: &mut SeriesWorkspace<T>) {
        let blocks = &mut self.blocks;
        tape.expand(&self.inputs, T::from_f64(1.0), workspace, 1, &mut |block, residual| {
            residual.iter_mut().for_each(|x| *x = -*x);
            blocks[block].factors.solve(residual);
        });
    }

    /// `z` as solved last.
    pub(crate) fn unknowns(&self) -> &[T] {
        let first = self.layout.first_unknown();
        &self.inputs[first..first + self.layout.unknowns]
    }

    /// Solves the equations of the instant, from the last solution.
    pub(crate) fn solve(&mut self, t: T, y: &[T]) -> Result<(), ReferenceError> {
        self.inputs[0] = t;
        self.inputs[1..1 + y.len()].copy_from_slice(y);
        let z = self.layout.first_unknown();
        for block in &mut self.blocks {
            let place = z + block.first..z + block.first + block.size;
            // a step from a point that is not finite would never come back
            if !self.inputs[place.clone()].iter().all(|x| x.is_finite()) {
                self.inputs[place.clone()].fill(T::zero());
            }
            let mut last = false;
            for step in 0.. {
                block.program.evaluate(&self.inputs);
                let (matrix, residual) = block.program.values_mut().split_at_mut(block.size * block.size);
                block.factors.factorize(matrix).map_err(|singular| ReferenceError::Singular {
                    what: INSTANT,
                    time: t.to_f64(),
                    pivot: singular.reciprocal,
                })?;
                block.factors.solve(residual);
                let relative = subtract(&mut self.inputs[place.clone()], residual);
                if block.linear || last {
                    break;
                }
                last = relative < SMALL;
                if !relative.is_finite() || step > ITERATIONS {
                    return Err(ReferenceError::NotConverged {
                        what: INSTANT,
                        time: t.to_f64(),
                        step: relative,
                        limit: SMALL,
                    });
                }
            }
        }
        Ok(())
    }

    /// `F(t, y)`.
    ///
    /// # Errors
    /// [`ReferenceError`] where the equations of the instant are singular, or Newton's method does not end.
    pub fn rates(&mut self, t: T, y: &[T], rates: &mut [T]) -> Result<(), ReferenceError> {
        self.solve(t, y)?;
        rates.copy_from_slice(self.rates.evaluate(&self.inputs));
        Ok(())
    }

    /// Outputs at `(t, y)`.
    ///
    /// # Errors
    /// As [`Instant::rates`].
    pub fn point(&mut self, t: T, y: &[T]) -> Result<Point<T>, ReferenceError> {
        self.solve(t, y)?;
        let n = self.dimension;
        let values = self.outputs.evaluate(&self.inputs);
        Ok(Point {
            coordinates: values[..n].to_vec(),
            velocities: values[n..2 * n].to_vec(),
            multipliers: values[2 * n..].to_vec(),
            states: y.to_vec(),
        })
    }
}
