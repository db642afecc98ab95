//! Columns of a film as functions of the motion, with derivatives.

use equations::Outputs;
use mechanics::System;
use symbolic::{Evaluator, Expr, Symbol};

use crate::FitError;

/// The columns of a film, `c(t, q, v, p)`, with their derivatives by `q`, `v` and the parameters that vary.
#[derive(Clone)]
pub struct Observation {
    program: Evaluator<f64>,
    columns: usize,
    dimension: usize,
    parameters: usize,
}

impl Observation {
    /// Compiles columns of these names; `varied` are the parameters that vary, the other ones have their
    /// values.
    ///
    /// # Errors
    /// [`FitError::Expression`].
    pub fn new(system: &System, columns: &[(&str, Expr)], varied: &[Symbol]) -> Result<Self, FitError> {
        let parameters = system.parameters.iter().filter(|p| !varied.contains(&p.symbol)).cloned().collect();
        let system = System { parameters, ..system.clone() };
        let by = [&system.positions()[..], &system.velocities(), varied].concat();
        let inputs = [&[system.time], &by[..]].concat();
        let row =
            |(_, column): &(&str, Expr)| -> Vec<Expr> { [vec![*column], system.graph.gradient(*column, &by)].concat() };
        for column in columns {
            let compiled = system.evaluator::<f64>(&inputs, &row(column));
            compiled.map_err(|error| FitError::Expression { column: column.0.into(), error })?;
        }
        let all: Vec<Expr> = columns.iter().flat_map(row).collect();
        let program = system.evaluator(&inputs, &all);
        let program = program.map_err(|error| FitError::Expression { column: "all".into(), error })?;
        Ok(Observation { program, columns: columns.len(), dimension: system.dimension(), parameters: varied.len() })
    }

    /// The columns at `t`, and for each the derivatives by `q`, `v` and the parameters.
    pub fn at(&mut self, t: f64, outputs: &Outputs, parameters: &[f64]) -> Vec<(f64, &[f64])> {
        let inputs = [&[t], &outputs.coordinates[..], &outputs.velocities, parameters].concat();
        let width = 1 + 2 * self.dimension + self.parameters;
        let values = self.program.evaluate(&inputs);
        (0..self.columns).map(|i| (values[i * width], &values[i * width + 1..(i + 1) * width])).collect()
    }
}
