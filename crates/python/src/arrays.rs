//! Arrays of Python as slices, and results as arrays.

use mechanics::System;
use numpy::{AllowTypeChange, PyArray1, PyArrayDyn, PyArrayLike1, PyArrayLikeDyn, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use symbolic::Expr;

use crate::errors;

/// Anything that numpy reads as numbers, of any shape.
pub(crate) type Floats<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;
/// Anything that numpy reads as a list of numbers.
pub(crate) type FloatList<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;

/// An array that is handed back.
pub(crate) type Array<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;

/// Rows of numbers: one, from an array of shape `(width,)`, or several, from one of shape `(k, width)`.
pub(crate) struct Rows {
    values: Vec<f64>,
    width: usize,
    /// `None` for a single row.
    count: Option<usize>,
}

impl Rows {
    /// Reads `array`, named `name`, whose last axis must have length `width`.
    pub(crate) fn read(name: &str, array: &Floats, width: usize) -> PyResult<Rows> {
        let view = array.as_array();
        let count = match *view.shape() {
            [n] if n == width => None,
            [k, n] if n == width => Some(k),
            ref other => {
                return Err(PyValueError::new_err(format!(
                    "{name} has shape {other:?}; ({width},) or (k, {width}) is needed"
                )));
            }
        };
        Ok(Rows { values: finite(name, view.iter().copied().collect())?, width, count })
    }

    pub(crate) fn count(&self) -> Option<usize> {
        self.count
    }

    /// Row `i`; a single row stands for all.
    pub(crate) fn row(&self, i: usize) -> &[f64] {
        let first = if self.count.is_some() { i * self.width } else { 0 };
        &self.values[first..first + self.width]
    }
}

/// Times: a number, or an array of shape `(k,)`.
pub(crate) fn times(array: &Floats) -> PyResult<Rows> {
    let view = array.as_array();
    let count = match *view.shape() {
        [] => None,
        [k] => Some(k),
        ref other => {
            return Err(PyValueError::new_err(format!("t has shape {other:?}; a number or (k,) is needed")));
        }
    };
    Ok(Rows { values: finite("t", view.iter().copied().collect())?, width: 1, count })
}

/// The common number of rows: `None` where all are single.
pub(crate) fn common(rows: &[(&str, &Rows)]) -> PyResult<Option<usize>> {
    let mut common: Option<(&str, usize)> = None;
    for (name, rows) in rows {
        match (common, rows.count()) {
            (Some((first, k)), Some(other)) if k != other => {
                return Err(PyValueError::new_err(format!("{first} has {k} rows, {name} has {other}")));
            }
            (None, Some(k)) => common = Some((name, k)),
            _ => {}
        }
    }
    Ok(common.map(|c| c.1))
}

/// The values, if all are finite.
pub(crate) fn finite(name: &str, values: Vec<f64>) -> PyResult<Vec<f64>> {
    match values.iter().find(|x| !x.is_finite()) {
        None => Ok(values),
        Some(x) => Err(PyValueError::new_err(format!("{name} contains {x}; it must be finite"))),
    }
}

/// An array of the given values without a copy: shape `tail`, or `(count, *tail)`.
pub(crate) fn array<'py>(py: Python<'py>, values: Vec<f64>, count: Option<usize>, tail: &[usize]) -> Array<'py> {
    let shape: Vec<usize> = count.into_iter().chain(tail.iter().copied()).collect();
    PyArray1::from_vec(py, values).reshape(shape)
}

/// Columns by name: element `i` of each row, as an array of shape `(count,)`, or a number for a single row.
pub(crate) fn columns<'py, 'a>(
    py: Python<'py>,
    names: &[String],
    rows: impl Iterator<Item = &'a [f64]> + Clone,
    count: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (i, name) in names.iter().enumerate() {
        let column: Vec<f64> = rows.clone().map(|row| row[i]).collect();
        match count {
            Some(_) => dict.set_item(name, PyArray1::from_vec(py, column))?,
            None => dict.set_item(name, column[0])?,
        }
    }
    Ok(dict)
}

/// Expressions of t, q and v of a system at the given points, row after row, and how many points there are.
pub(crate) fn at_points(
    system: &System,
    [t, q, v]: [Floats<'_>; 3],
    expressions: impl Fn(&System) -> Vec<Expr>,
) -> PyResult<(Vec<f64>, Option<usize>)> {
    let n = system.dimension();
    let (t, q, v) = (times(&t)?, Rows::read("q", &q, n)?, Rows::read("v", &v, n)?);
    let count = common(&[("q", &q), ("v", &v), ("t", &t)])?;
    let inputs = [&[system.time][..], &system.positions(), &system.velocities()].concat();
    let mut program = system.evaluator(&inputs, &expressions(system)).map_err(errors::solve)?;
    let mut values = Vec::new();
    for i in 0..count.unwrap_or(1) {
        values.extend_from_slice(program.evaluate(&[t.row(i), q.row(i), v.row(i)].concat()));
    }
    Ok((values, count))
}
