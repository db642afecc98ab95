//! The blocks of one instant: `R(z; t, y) = 0`, solved for `z`.

use symbolic::limits::{CONTRACTION, HALF_THE_DIGITS, ITERATIONS, LAST_DIGITS};
use symbolic::{Bounded, CompileError, Evaluator, Scalar, SeriesScalar, Symbol};

use crate::equations::{Block, Equations};
use mechanics::linear::{Entry, Factors, PIVOT_LIMIT, Singular};

/// A number type of some precision, in which instants are solved and expanded.
pub trait Real: SeriesScalar + Entry {}

impl<T: SeriesScalar + Entry> Real for T {}

/// Equations that cannot be evaluated at a point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EvaluationFailure {
    /// The equations of the instant are singular.
    #[error(
        "equations of the instant are singular (relative pivot {reciprocal:.1e}, limit {limit:.0e}); needed: {regular}"
    )]
    Singular {
        /// Smallest pivot of the scaled matrix.
        reciprocal: f64,
        /// Smallest pivot that is accepted.
        limit: f64,
        /// What would have to be regular.
        regular: &'static str,
    },
    /// Newton's method for equations that are not linear in the unknowns did not converge.
    #[error(
        "equations of the instant not solved after {iterations} Newton steps (last step {step:.1e}, limit {limit:.0e})"
    )]
    NotConverged {
        /// Steps taken.
        iterations: usize,
        /// Relative length of the last step.
        step: f64,
        /// Length at which the iteration ends.
        limit: f64,
    },
    /// The return of a state onto its constraint did not converge.
    #[error("no return onto the constraint after {iterations} Newton steps (last step {step:.1e}, limit {limit:.0e})")]
    NotProjected {
        /// Steps taken.
        iterations: usize,
        /// Relative length of the last step.
        step: f64,
        /// Length that counts as convergence.
        limit: f64,
    },
}

/// Where the numbers of one block are, and how it is solved.
#[derive(Clone)]
pub(crate) struct CompiledBlock<T = f64> {
    /// Place of the first unknown in `z`, and their number.
    pub(crate) first: usize,
    pub(crate) size: usize,
    /// Outputs: the matrix `∂R/∂z` row-major, then `R`; linear blocks at `z = 0`, others at the current `z`.
    pub(crate) program: Evaluator<T>,
    pub(crate) linear: bool,
    pub(crate) factors: Factors<T>,
    regular: &'static str,
}

impl CompiledBlock {
    /// The columns of `(∂R/∂z)⁻¹`, by factors at hand.
    pub(crate) fn inverse(&mut self) -> Vec<Vec<f64>> {
        let unit = |k: usize| (0..self.size).map(|i| f64::from(u8::from(i == k))).collect();
        let mut columns: Vec<Vec<f64>> = (0..self.size).map(unit).collect();
        columns.iter_mut().for_each(|column| self.factors.solve(column));
        columns
    }
}

impl<T: Real> CompiledBlock<T> {
    /// Relative step at which Newton's method ends.
    const NEWTON_LIMIT: f64 = LAST_DIGITS * (T::EPSILON / f64::EPSILON);

    /// Evaluates, factorizes, and leaves `−(∂R/∂z)⁻¹ R` instead of `R`.
    pub(crate) fn step(&mut self, inputs: &[T]) -> Result<(), EvaluationFailure> {
        self.program.evaluate(inputs);
        let (matrix, residual) = self.program.values_mut().split_at_mut(self.size * self.size);
        let regular = self.regular;
        self.factors.factorize(matrix).map_err(|Singular { reciprocal }| EvaluationFailure::Singular {
            reciprocal,
            limit: PIVOT_LIMIT,
            regular,
        })?;
        for x in residual.iter_mut() {
            *x = -*x;
        }
        self.factors.solve(residual);
        Ok(())
    }

    pub(crate) fn solution(&self) -> &[T] {
        &self.program.values()[self.size * self.size..]
    }

    /// Newton's method from the current `z`; ends when the step no longer shrinks at round-off.
    ///
    /// The equations may have several roots. The one that belongs to the motion is near; so a start from
    /// which the iteration does not contract at once is refused, and whoever steps time comes nearer.
    pub(crate) fn newton(&mut self, inputs: &mut [T], known: usize) -> Result<(), EvaluationFailure> {
        let mut previous = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            self.step(inputs)?;
            let (mut length, mut size) = (0.0_f64, 0.0_f64);
            let first = known + self.first;
            for (x, &dx) in inputs[first..first + self.size].iter_mut().zip(self.solution()) {
                *x = *x + dx;
                length = length.max(dx.size());
                size = size.max(x.size());
            }
            let relative = length / size.max(f64::MIN_POSITIVE);
            if relative <= Self::NEWTON_LIMIT || (relative < 1e-10 && relative >= previous) {
                return Ok(());
            }
            let stalls = iteration > 0 && relative > CONTRACTION * previous;
            if stalls && self.is_round_off(inputs) {
                return Ok(());
            }
            let astray = iteration == 1 && relative > HALF_THE_DIGITS && stalls;
            if !relative.is_finite() || astray {
                return Err(EvaluationFailure::NotConverged {
                    iterations: iteration + 1,
                    step: relative,
                    limit: Self::NEWTON_LIMIT,
                });
            }
            previous = relative;
        }
        Err(EvaluationFailure::NotConverged { iterations: ITERATIONS, step: previous, limit: Self::NEWTON_LIMIT })
    }

    /// Whether what is left of the equations is round-off of their terms. Where `z` vanishes it keeps no
    /// digits.
    fn is_round_off(&self, inputs: &[T]) -> bool {
        let (tape, first) = (self.program.tape(), self.size * self.size);
        let bounded: Vec<Bounded> = inputs.iter().map(|x| Bounded::from_f64(x.to_f64())).collect();
        let mut terms = vec![Bounded::from_f64(0.0); first + self.size];
        tape.evaluate(&bounded, &mut tape.workspace(), &mut terms);
        let mut values = vec![T::from_f64(0.0); first + self.size];
        tape.evaluate(inputs, &mut tape.workspace(), &mut values);
        let pairs = values[first..].iter().zip(&terms[first..]);
        pairs.into_iter().all(|(r, terms)| r.size() <= Self::NEWTON_LIMIT * terms.magnitude)
    }

    /// Compiles a block whose first unknown has place `first` in `z`.
    pub(crate) fn new(
        equations: &Equations,
        block: &Block,
        first: usize,
        known: &[Symbol],
        all: &[Symbol],
    ) -> Result<Self, CompileError> {
        let (matrix, rest) = equations.linear_system(block);
        let linear = rest.is_some();
        let mut outputs = matrix.entries().to_vec();
        outputs.extend(rest.unwrap_or_else(|| block.residuals.clone()));
        let size = block.unknowns.len();
        Ok(CompiledBlock {
            first,
            size,
            program: equations.evaluator(if linear { known } else { all }, &outputs)?,
            linear,
            factors: Factors::new(size),
            regular: block.regular,
        })
    }
}
