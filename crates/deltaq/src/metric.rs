//! The kinetic metric: how far two configurations are apart.

use mechanics::System;
use nalgebra::DMatrix;
use symbolic::{CompileError, Evaluator, Symbol};

/// The length `sqrt(Δqᵀ M Δq)` with `M = ∂²L/∂v²`, and the constraint residuals, at a point of a motion.
#[derive(Clone)]
pub struct Metric {
    program: Evaluator<f64>,
    dimension: usize,
    inputs: Vec<f64>,
}

impl Metric {
    /// Compiles `M(t, q, v)` and `f(t, q, v)` of `system`.
    ///
    /// # Errors
    /// [`CompileError`] where `L` or `f` contain a symbol that is not defined.
    pub fn new(system: &System) -> Result<Self, CompileError> {
        Metric::varying(system, &[])
    }

    /// The same, with parameters whose values are set by [`Metric::set_parameters`].
    pub(crate) fn varying(system: &System, parameters: &[Symbol]) -> Result<Self, CompileError> {
        let system = system.clone(); // the Hessian is built in a graph of its own
        let mut outputs = system.velocity_hessian().entries().to_vec();
        outputs.extend(&system.constraints);
        let mut inputs = vec![system.time];
        inputs.extend(system.positions());
        inputs.extend(system.velocities());
        inputs.extend(parameters);
        let mut values = system.parameter_values();
        values.retain(|symbol, _| !parameters.contains(symbol));
        let program = Evaluator::new(system.graph.compile(&inputs, &outputs, &values)?);
        Ok(Metric { program, dimension: system.dimension(), inputs: vec![0.0; inputs.len()] })
    }

    /// Values of the parameters that vary.
    pub(crate) fn set_parameters(&mut self, values: &[f64]) {
        self.inputs[1 + 2 * self.dimension..].copy_from_slice(values);
    }

    /// Number of the parameters that vary.
    pub(crate) fn parameters(&self) -> usize {
        self.inputs.len() - 1 - 2 * self.dimension
    }

    /// `M`, row-major, and `f`.
    fn at(&mut self, t: f64, q: &[f64], v: &[f64]) -> (&[f64], &[f64]) {
        let n = self.dimension;
        self.inputs[0] = t;
        self.inputs[1..=n].copy_from_slice(q);
        self.inputs[1 + n..=2 * n].copy_from_slice(v);
        self.program.evaluate(&self.inputs).split_at(n * n)
    }

    /// `sqrt(|Δqᵀ M Δq|)` with `M` at `(t, q, v)`.
    pub fn length(&mut self, t: f64, q: &[f64], v: &[f64], difference: &[f64]) -> f64 {
        let n = self.dimension;
        let rows = self.at(t, q, v).0.chunks_exact(n);
        let square: f64 =
            rows.zip(difference).map(|(row, d)| d * row.iter().zip(difference).map(|(m, e)| m * e).sum::<f64>()).sum();
        square.abs().sqrt()
    }

    /// [`Metric::length`] of `q − other`.
    pub fn distance(&mut self, t: f64, q: &[f64], v: &[f64], other: &[f64]) -> f64 {
        self.length(t, q, v, &subtract(q, other))
    }

    /// Upper triangular `R` with `RᵀR = M` at `(t, q, v)`, so that the length of `Δq` is that of `R Δq`;
    /// where `M` is not positive definite, the square roots of its diagonal instead.
    pub(crate) fn factor(&mut self, t: f64, q: &[f64], v: &[f64]) -> DMatrix<f64> {
        let n = self.dimension;
        let mass = DMatrix::from_row_slice(n, n, self.at(t, q, v).0);
        let diagonal = DMatrix::from_diagonal(&mass.diagonal().map(|m| m.abs().sqrt()));
        mass.cholesky().map_or(diagonal, |c| c.l().transpose())
    }

    /// `max |fᵢ(t, q, v)|`, 0 where there is no constraint.
    pub fn constraint_residual(&mut self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.at(t, q, v).1.iter().fold(0.0, |a, f| a.max(f.abs()))
    }
}

pub(crate) fn subtract(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}
