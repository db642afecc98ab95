//! `∂F/∂y` of compiled equations.

use symbolic::{CompileError, Evaluator, Expr};

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
}
