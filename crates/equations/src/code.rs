//! Expressions of equations as code in other languages. The files are written in crates that know systems.

use std::collections::HashMap;

use symbolic::{Code, CompileError, Expr, Language, Matrix, Symbol};

use crate::definitions::needed;
use crate::equations::{Block, Equations};

impl Equations {
    /// `∂R/∂z` of a block, and where that is free of `z`, what is left of `R` at `z = 0`.
    pub fn linear_system(&self, block: &Block) -> (Matrix, Option<Vec<Expr>>) {
        let g = &self.graph;
        let matrix = g.jacobian(&block.residuals, &block.unknowns);
        let free = |&e: &Expr| g.symbols_of(e).iter().all(|s| !block.unknowns.contains(s));
        let at_zero: HashMap<Symbol, Expr> = block.unknowns.iter().map(|&z| (z, g.zero())).collect();
        let rest = || block.residuals.iter().map(|&r| g.substitute(r, &at_zero)).collect();
        let linear = matrix.entries().iter().all(free);
        (matrix, linear.then(rest))
    }

    /// `outputs` as lines of code, by way of those definitions that they need; inputs under the names given.
    ///
    /// # Errors
    /// [`CompileError`] where a symbol is neither input nor definition; parameters are inputs here.
    pub fn code(
        &self,
        language: Language,
        inputs: &[(Symbol, String)],
        outputs: &[Expr],
    ) -> Result<Code, CompileError> {
        let symbols: Vec<Symbol> = inputs.iter().map(|(symbol, _)| *symbol).collect();
        let definitions = needed(&self.graph, &self.definitions, &symbols, outputs);
        self.graph.code(language, inputs, &definitions, outputs)
    }
}
