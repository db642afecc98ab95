//! Evaluation of expressions in any number type. Parameters are inputs, so that exact numbers give exact
//! values.

use symbolic::{CompileError, Expr, Graph, Scalar, Symbol, Tape, Workspace, go_on};

use std::collections::HashMap;
use std::sync::Arc;

/// A tape whose first inputs are the parameters of a system.
#[derive(Clone, Debug)]
pub struct Program {
    tape: Arc<Tape>,
}

/// A program with registers for numbers of one kind.
#[derive(Clone, Debug)]
pub struct Evaluator<T> {
    tape: Arc<Tape>,
    registers: Workspace<T>,
    values: Vec<T>,
}

impl Program {
    /// A tape for `outputs` from `inputs`, parameters first.
    ///
    /// # Errors
    /// [`CompileError`] for a symbol that is not input.
    pub fn new(graph: &Graph, inputs: &[Symbol], outputs: &[Expr]) -> Result<Self, CompileError> {
        Ok(Program { tape: Arc::new(graph.compile(inputs, outputs, &HashMap::new())?) })
    }

    /// Steps of one evaluation.
    pub fn steps(&self) -> usize {
        self.tape.len()
    }

    /// With registers of its own.
    pub fn evaluator<T: Scalar>(&self) -> Evaluator<T> {
        let values = vec![T::from_f64(0.0); self.tape.outputs()];
        Evaluator { registers: self.tape.workspace(), values, tape: self.tape.clone() }
    }
}

impl<T: Scalar> Evaluator<T> {
    /// The outputs at `inputs`.
    pub fn run(&mut self, inputs: &[T]) -> &mut [T] {
        go_on();
        self.tape.evaluate(inputs, &mut self.registers, &mut self.values);
        &mut self.values
    }
}
