//! A tape with the memory for repeated evaluation in one thread.

use std::sync::Arc;

use crate::{Scalar, Tape, Workspace};

/// A [`Tape`] with its registers and its outputs, in numbers of one kind. Clone it for another thread.
///
/// ```
/// use std::collections::HashMap;
/// use symbolic::{Evaluator, Graph};
/// let g = Graph::new();
/// let x = g.symbol("x");
/// let mut square = Evaluator::new(g.compile(&[x], &[g.powi(g.variable(x), 2)], &HashMap::new())?);
/// assert_eq!(square.evaluate(&[3.0]), [9.0]);
/// assert_eq!(square.values(), [9.0]);
/// # Ok::<(), symbolic::CompileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Evaluator<T> {
    tape: Arc<Tape>,
    registers: Workspace<T>,
    values: Vec<T>,
}

impl<T: Scalar> Evaluator<T> {
    /// Evaluates `tape`; until it is first evaluated the outputs are zero.
    pub fn new(tape: impl Into<Arc<Tape>>) -> Self {
        let tape = tape.into();
        Evaluator { registers: tape.workspace(), values: vec![T::from_f64(0.0); tape.outputs()], tape }
    }

    /// The outputs at `inputs`; allocates nothing.
    ///
    /// # Panics
    /// If there are not as many `inputs` as the tape has.
    pub fn evaluate(&mut self, inputs: &[T]) -> &[T] {
        self.tape.evaluate(inputs, &mut self.registers, &mut self.values);
        &self.values
    }

    /// The outputs of the last evaluation.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The same, to be worked on in place until the next evaluation.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// What is evaluated.
    pub fn tape(&self) -> &Arc<Tape> {
        &self.tape
    }
}
