//! The kinetic metric: how far two configurations are apart.

use mechanics::System;
use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};
use symbolic::limits::NOTHING;
use symbolic::{CompileError, Evaluator, Symbol};

/// The length `sqrt(Δqᵀ |M| Δq)` with `M = ∂²L/∂v²`, and the constraint residuals, at a point of a motion.
///
/// `|M|` has the eigenvalues of `M` without their signs: it is `M` where that is positive semidefinite, and
/// elsewhere what makes a norm of it. Coordinates without inertia have no length.
#[derive(Clone)]
pub struct Metric {
    /// Names of the coordinates.
    pub names: Vec<String>,
    /// Of each coordinate the first one that has its unit.
    units: Vec<usize>,
    program: Evaluator<f64>,
    dimension: usize,
    inputs: Vec<f64>,
    /// `M`, row-major, and `f` at `inputs`; empty where they are not known.
    values: Vec<f64>,
    /// Whether this `M` is positive definite, where that is known.
    is_definite: Option<bool>,
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
    ///
    /// # Errors
    /// As [`Metric::new`].
    pub fn varying(system: &System, parameters: &[Symbol]) -> Result<Self, CompileError> {
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
        let names: Vec<String> = system.coordinates.iter().map(|c| c.name.clone()).collect();
        let unit = |i: usize| &system.coordinates[i].unit;
        let units = (0..names.len()).map(|i| (0..i).find(|&j| unit(j) == unit(i)).unwrap_or(i)).collect();
        let (dimension, inputs) = (system.dimension(), vec![0.0; inputs.len()]);
        Ok(Metric { names, units, program, dimension, inputs, values: Vec::new(), is_definite: None })
    }

    /// Values of the parameters that vary.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn set_parameters(&mut self, values: &[f64]) {
        self.inputs[1 + 2 * self.dimension..].copy_from_slice(values);
        self.values.clear();
        self.is_definite = None;
    }

    /// Number of the parameters that vary.
    pub fn parameters(&self) -> usize {
        self.inputs.len() - 1 - 2 * self.dimension
    }

    /// `M`, row-major, and `f`; at the point of the last question as they were then.
    fn at(&mut self, t: f64, q: &[f64], v: &[f64]) -> (&[f64], &[f64]) {
        let n = self.dimension;
        let is_here = self.inputs[0] == t && self.inputs[1..=n] == *q && self.inputs[1 + n..=2 * n] == *v;
        if self.values.is_empty() || !is_here {
            self.inputs[0] = t;
            self.inputs[1..=n].copy_from_slice(q);
            self.inputs[1 + n..=2 * n].copy_from_slice(v);
            let values = self.program.evaluate(&self.inputs);
            if self.values.get(..n * n) != Some(&values[..n * n]) {
                self.is_definite = None;
            }
            self.values.clear();
            self.values.extend(values);
        }
        self.values.split_at(n * n)
    }

    /// `sqrt(Δqᵀ |M| Δq)` with `M` at `(t, q, v)`.
    pub fn length(&mut self, t: f64, q: &[f64], v: &[f64], difference: &[f64]) -> f64 {
        let n = self.dimension;
        let mass = self.at(t, q, v).0;
        let rows = mass.chunks_exact(n).zip(difference);
        let square: f64 = rows.map(|(row, d)| d * row.iter().zip(difference).map(|(m, e)| m * e).sum::<f64>()).sum();
        let mass = || DMatrix::from_row_slice(n, n, &self.values[..n * n]);
        if *self.is_definite.get_or_insert_with(|| mass().cholesky().is_some()) {
            return square.sqrt();
        }
        (absolute_root(&mass()) * DVector::from_column_slice(difference)).norm()
    }

    /// [`Metric::length`] of `q − other`.
    pub fn distance(&mut self, t: f64, q: &[f64], v: &[f64], other: &[f64]) -> f64 {
        self.length(t, q, v, &subtract(q, other))
    }

    /// `M` at `(t, q, v)`.
    pub fn matrix(&mut self, t: f64, q: &[f64], v: &[f64]) -> DMatrix<f64> {
        let n = self.dimension;
        DMatrix::from_row_slice(n, n, self.at(t, q, v).0)
    }

    /// `R` with `RᵀR = |M|` at `(t, q, v)`, so that the length of `Δq` is that of `R Δq`.
    pub fn factor(&mut self, t: f64, q: &[f64], v: &[f64]) -> DMatrix<f64> {
        let mass = self.matrix(t, q, v);
        let root = || absolute_root(&mass);
        mass.clone().cholesky().map_or_else(root, |c| c.l().transpose())
    }

    /// The length of each coordinate's unit at `(t, q, v)`, and whether `M` has a negative eigenvalue there.
    pub fn inertia(&mut self, t: f64, q: &[f64], v: &[f64]) -> (Vec<f64>, bool) {
        let (n, mass) = (self.dimension, self.matrix(t, q, v));
        let factor = |root: &DMatrix<f64>| root.column_iter().map(|column| column.norm()).collect::<Vec<f64>>();
        match mass.clone().cholesky() {
            Some(c) => (factor(&c.l().transpose()), false),
            None => {
                let units = factor(&absolute_root(&mass));
                let scaled = DMatrix::from_fn(n, n, |i, j| {
                    let product = units[i] * units[j];
                    if product > 0.0 { mass[(i, j)] / product } else { 0.0 }
                });
                let negative = eigen(&scaled).is_some_and(|eigen| eigen.eigenvalues.min() < -NOTHING);
                (units, negative)
            }
        }
    }

    /// What the round-off of each coordinate is a part of: its own size; where that is less, the largest
    /// one in its unit, or the way of that kinetic length in it, whichever is less.
    pub fn round_off_sizes(&self, inertia: &[f64], sizes: &[f64], length: f64) -> Vec<f64> {
        let is_alone = |i: usize| (0..sizes.len()).all(|j| j == i || self.units[j] != self.units[i]);
        let others = |i: usize| if is_alone(i) { vec![0.0; sizes.len()] } else { sizes.to_vec() };
        let size = |i: usize| sizes[i].max(self.likely_size(i, inertia, &others(i), length).unwrap_or(0.0));
        (0..sizes.len()).map(size).collect()
    }

    /// What a coordinate may come to that tells no size itself: the largest of `sizes` in its unit, or the
    /// way of that kinetic length in it, whichever is less.
    pub(crate) fn likely_size(&self, i: usize, inertia: &[f64], sizes: &[f64], length: f64) -> Option<f64> {
        let same_unit = (0..sizes.len()).filter(|&j| self.units[j] == self.units[i]).map(|j| sizes[j]);
        let way = inertia.get(i).map(|unit| length / unit);
        let positive = |size: &f64| *size > 0.0 && size.is_finite();
        let largest = same_unit.filter(positive).reduce(f64::max);
        [largest, way.filter(positive)].into_iter().flatten().reduce(f64::min)
    }

    /// `max |fᵢ(t, q, v)|`, 0 where there is no constraint.
    pub fn constraint_residual(&mut self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.at(t, q, v).1.iter().fold(0.0, |a, f| larger(a, f.abs()))
    }
}

/// `R` with `RᵀR = |M|`; NaN where `M` is not finite.
fn absolute_root(mass: &DMatrix<f64>) -> DMatrix<f64> {
    match eigen(mass) {
        Some(eigen) => {
            DMatrix::from_diagonal(&eigen.eigenvalues.map(|x| x.abs().sqrt())) * eigen.eigenvectors.transpose()
        }
        None => DMatrix::from_element(mass.nrows(), mass.ncols(), f64::NAN),
    }
}

/// `None` for a matrix that is not finite, in which no iteration would end.
fn eigen(mass: &DMatrix<f64>) -> Option<SymmetricEigen<f64, Dyn>> {
    mass.iter().all(|x| x.is_finite()).then(|| mass.clone().symmetric_eigen())
}

/// The larger of the two; NaN stays.
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// `a − b`.
pub fn subtract(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

impl std::fmt::Debug for Metric {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Metric").field("names", &self.names).finish_non_exhaustive()
    }
}
