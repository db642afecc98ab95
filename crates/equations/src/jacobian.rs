//! `∂F/∂y` of compiled equations.

use symbolic::{Bounded, CompileError, Evaluator, Expr};

use crate::blocks::CompiledBlock;
use crate::definitions::jacobian;
use crate::equations::Equations;

/// `∂F/∂y` by the implicit function theorem, exact derivatives from the graph.
#[derive(Clone)]
pub(crate) struct Jacobian {
    /// ∂(rates)/∂y row-major, then ∂(rates)/∂z row-major, then ∂R/∂y row-major, block after block.
    program: Evaluator<f64>,
    states: usize,
    unknowns: usize,
    column: Vec<f64>,
}

impl Jacobian {
    pub(crate) fn new(equations: &Equations) -> Result<Self, CompileError> {
        let g = &equations.graph;
        let (states, unknowns) = (equations.state_symbols(), equations.unknowns());
        let rates: Vec<Expr> = equations.states.iter().map(|y| y.rate).collect();
        let residuals: Vec<Expr> = equations.blocks.iter().flat_map(|block| block.residuals.clone()).collect();
        let (definitions, outputs) =
            jacobian(g, &equations.definitions, &[(&rates, &states), (&rates, &unknowns), (&residuals, &states)]);
        let inputs = [&equations.known_symbols()[..], &unknowns].concat();
        let largest = equations.blocks.iter().map(|b| b.unknowns.len()).max().unwrap_or(0);
        Ok(Jacobian {
            program: equations.evaluator_by(&definitions, &inputs, &outputs)?,
            states: rates.len(),
            unknowns: unknowns.len(),
            column: vec![0.0; largest],
        })
    }

    /// Writes `∂F/∂y`, row-major, at `t, y, constants, z`; `z` solves the blocks, whose factors are at hand.
    pub(crate) fn write(&mut self, inputs: &[f64], blocks: &mut [CompiledBlock], jacobian: &mut [f64]) {
        let n = self.states;
        let values = self.program.evaluate(inputs);
        let (direct, rest) = values.split_at(n * n);
        let (by_unknown, mut by_state) = rest.split_at(n * self.unknowns);
        jacobian.copy_from_slice(direct);
        for block in blocks {
            let size = block.size;
            for column in 0..n {
                let b = &mut self.column[..size];
                for (i, x) in b.iter_mut().enumerate() {
                    *x = -by_state[i * n + column];
                }
                if b.iter().all(|&x| x == 0.0) {
                    continue;
                }
                block.factors.solve(b);
                for row in 0..n {
                    let sensitivity = &by_unknown[row * self.unknowns + block.first..][..size];
                    let change: f64 = sensitivity.iter().zip(&*b).map(|(s, x)| s * x).sum();
                    jacobian[row * n + column] += change;
                }
            }
            by_state = &by_state[size * n..];
        }
    }

    /// The sum of magnitudes behind each entry of `∂F/∂y = ∂F/∂y|z − ∂F/∂z (∂R/∂z)⁻¹ ∂R/∂y`, row-major. The
    /// error of `x`, the last two factors, is `|∂R/∂z|⁻¹` times the sum of magnitudes in `∂R/∂z x + ∂R/∂y`
    /// and in the computation of `x`. `matrices`: the `∂R/∂z` of the blocks, whose factors are at hand.
    pub(crate) fn terms(&self, inputs: &[Bounded], blocks: &mut [CompiledBlock], matrices: &[Vec<f64>]) -> Vec<f64> {
        let n = self.states;
        let mut program = Evaluator::<Bounded>::new(self.program.tape().clone());
        let values = program.evaluate(inputs);
        let (direct, rest) = values.split_at(n * n);
        let (by_unknown, mut by_state) = rest.split_at(n * self.unknowns);
        let mut terms: Vec<f64> = direct.iter().map(|x| x.magnitude).collect();
        for (block, matrix) in blocks.iter_mut().zip(matrices) {
            let size = block.size;
            let inverse = block.inverse();
            for column in 0..n {
                let slope = |i: usize| by_state[i * n + column];
                if (0..size).all(|i| slope(i).magnitude == 0.0) {
                    continue;
                }
                let product = |by: &dyn Fn(usize) -> f64, i: usize| (0..size).map(|k| inverse[k][i] * by(k)).sum();
                let x: Vec<f64> = (0..size).map(|i| product(&|k| slope(k).value, i)).collect();
                let eliminated = block.factors.eliminated(&x);
                let of_row = |k: usize| -> f64 {
                    let row = matrix[k * size..][..size].iter().zip(&x);
                    slope(k).magnitude + eliminated[k] + row.map(|(m, x)| m * x.abs()).sum::<f64>()
                };
                let sums: Vec<f64> = (0..size).map(of_row).collect();
                for row in 0..n {
                    for (i, s) in by_unknown[row * self.unknowns + block.first..][..size].iter().enumerate() {
                        let own: f64 = (0..size).map(|k| inverse[k][i].abs() * sums[k]).sum();
                        terms[row * n + column] += s.magnitude * x[i].abs() + s.value.abs() * own;
                    }
                }
            }
            by_state = &by_state[size * n..];
        }
        terms
    }
}
