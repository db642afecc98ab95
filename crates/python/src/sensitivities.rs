//! Derivatives of a motion, as arrays.

use motion::Sensitivities;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::outputs::{Names, Outputs};

/// Derivatives and their error estimates, each by the name of the number; empty without any.
pub(crate) fn tables(
    py: Python<'_>,
    derived: Option<Sensitivities>,
    dimension: usize,
    count: Option<usize>,
) -> PyResult<[Py<PyDict>; 2]> {
    let (derivatives, errors) = (PyDict::new(py), PyDict::new(py));
    if let Some(derived) = derived {
        let Sensitivities { names: by, multipliers, invariants, .. } = derived;
        let names = Names { multipliers, invariants, observables: Vec::new() };
        for (into, rows) in [(&derivatives, &derived.derivatives), (&errors, &derived.errors)] {
            for (k, name) in by.iter().enumerate() {
                let rows: Vec<_> = rows.iter().map(|row| (row[k].clone(), Vec::new())).collect();
                into.set_item(name, Outputs::new(py, &rows, dimension, &names, count)?)?;
            }
        }
    }
    Ok([derivatives.unbind(), errors.unbind()])
}
