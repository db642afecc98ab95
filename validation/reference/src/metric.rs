//! Distances in the kinetic metric, taken in the wide type.

use equations::Real;
use mechanics::System;
use symbolic::{CompileError, Evaluator, Symbol};

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

/// `M = ∂²L/∂v²` and `f` at one point of a motion.
pub(crate) struct Metric<T> {
    program: Evaluator<T>,
    dimension: usize,
    parameters: Vec<f64>,
}

impl<T: Real> Metric<T> {
    pub(crate) fn new(system: &System) -> Result<Self, CompileError> {
        let outputs = [system.velocity_hessian().entries(), &system.constraints].concat();
        let (names, parameters): (Vec<Symbol>, Vec<f64>) =
            system.parameters.iter().map(|p| (p.symbol, p.value)).unzip();
        let symbols = [vec![system.time], system.positions(), system.velocities(), names].concat();
        let tape = system.graph.compile(&symbols, &outputs, &Default::default())?;
        Ok(Metric { program: Evaluator::new(tape), dimension: system.dimension(), parameters })
    }

    pub(crate) fn load(&mut self, t: T, point: &Point<T>) {
        let parameters: Vec<T> = self.parameters.iter().map(|&x| T::from_f64(x)).collect();
        self.program.evaluate(&[&[t], &point.coordinates[..], &point.velocities, &parameters].concat());
    }

    /// `M`, row-major, as `f64`.
    pub(crate) fn mass(&self) -> Vec<f64> {
        self.program.values()[..self.dimension * self.dimension].iter().map(|m| m.to_f64()).collect()
    }

    pub(crate) fn constraint_residual(&self) -> f64 {
        self.program.values()[self.dimension * self.dimension..].iter().fold(0.0, |worst: f64, f| worst.max(f.size()))
    }

    /// `√|Δqᵀ M Δq|` between two points.
    pub(crate) fn distance(&self, a: &Point<T>, b: &Point<T>) -> f64 {
        let pairs = a.coordinates.iter().zip(&b.coordinates);
        let difference: Vec<f64> = pairs.map(|(&a, &b)| (a - b).to_f64()).collect();
        length(&self.mass(), &difference)
    }
}

/// `√|Δᵀ M Δ|` for `M` row-major.
pub(crate) fn length(mass: &[f64], difference: &[f64]) -> f64 {
    let rows = mass.chunks_exact(difference.len().max(1));
    let product = |row: &[f64]| row.iter().zip(difference).map(|(m, d)| m * d).sum::<f64>();
    rows.zip(difference).map(|(row, d)| d * product(row)).sum::<f64>().abs().sqrt()
}
