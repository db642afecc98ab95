//! What is read off at instants, as arrays.

use mechanics::Observables;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use stubs::{answer, stubbed};

use crate::arrays::{columns, fixed};

#[answer]
pub(crate) struct Outputs;

#[stubbed]
impl Outputs {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let names = |table: &Py<PyDict>| table.bind(py).keys().iter().map(|name| name.to_string()).collect::<Vec<_>>();
        let all = [names(&self.multipliers), names(&self.invariants), names(&self.observables)].concat();
        let shape = self.coordinates.bind(py).getattr("shape")?;
        Ok(format!("<deltaq.Outputs, coordinates of shape {shape}; {}>", all.join(", ")))
    }
}

/// A row of outputs, and the observables there.
pub(crate) type Row = (equations::Outputs, Vec<f64>);

/// `row` with the observables at that time.
pub(crate) fn observed(observables: &mut Observables, t: f64, row: equations::Outputs) -> Row {
    let values = observables.at(t, &row.coordinates, &row.velocities).to_vec();
    (row, values)
}

/// Names of multipliers, invariants and observables.
#[derive(Clone)]
pub(crate) struct Names {
    pub(crate) multipliers: Vec<String>,
    pub(crate) invariants: Vec<String>,
    pub(crate) observables: Vec<String>,
}

impl Names {
    pub(crate) fn of(equations: &equations::Equations, observables: &Observables) -> Names {
        let observables = observables.names().to_vec();
        let names = |list: &[equations::Named]| list.iter().map(|n| n.name.clone()).collect();
        Names { multipliers: names(&equations.multipliers), invariants: names(&equations.invariants), observables }
    }
}

impl Outputs {
    /// From `rows`, one an instant, of `count`: those that are missing become NaN. `count` is `None` where
    /// there is one instant, given as a number.
    pub(crate) fn new(
        py: Python<'_>,
        rows: &[Row],
        dimension: usize,
        names: &Names,
        count: Option<usize>,
    ) -> PyResult<Outputs> {
        let flat = |pick: fn(&equations::Outputs) -> &[f64]| rows.iter().flat_map(|(r, _)| pick(r).to_vec()).collect();
        let missing = count.unwrap_or(1) - rows.len();
        let matrix = |pick| {
            let mut values: Vec<f64> = flat(pick);
            values.resize(values.len() + missing * dimension, f64::NAN);
            fixed(py, values, count, &[dimension]).map(Bound::unbind)
        };
        Ok(Outputs {
            coordinates: matrix(|r| &r.coordinates)?,
            velocities: matrix(|r| &r.velocities)?,
            multipliers: columns(py, &names.multipliers, rows.iter().map(|(r, _)| &r.multipliers[..]), count)?.unbind(),
            invariants: columns(py, &names.invariants, rows.iter().map(|(r, _)| &r.invariants[..]), count)?.unbind(),
            observables: columns(py, &names.observables, rows.iter().map(|(_, o)| &o[..]), count)?.unbind(),
        })
    }
}
