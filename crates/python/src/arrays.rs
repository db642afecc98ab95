//! Arrays of Python as slices, and results as arrays.

use equations::EvaluationFailure;
use mechanics::System;
use numpy::ndarray::Dimension;
use numpy::{AllowTypeChange, Element, PyArray, PyArray1, PyArrayDyn, PyArrayLikeDyn, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use symbolic::{CompileError, Evaluator, Expr};

use crate::errors;

/// Anything that numpy reads as numbers, of any shape.
pub(crate) type Floats<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

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

    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Row `i`; a single row stands for all.
    pub(crate) fn row(&self, i: usize) -> &[f64] {
        let first = if self.count.is_some() { i * self.width } else { 0 };
        &self.values[first..first + self.width]
    }
}

/// Times: a number, or an array of shape `(k,)`, named `name`.
pub(crate) fn times(name: &str, array: &Floats) -> PyResult<Rows> {
    let view = array.as_array();
    let count = match *view.shape() {
        [] => None,
        [k] => Some(k),
        ref other => {
            return Err(PyValueError::new_err(format!("{name} has shape {other:?}; a number or (k,) is needed")));
        }
    };
    Ok(Rows { values: finite(name, view.iter().copied().collect())?, width: 1, count })
}

/// The finite numbers of a list, named `name`, of shape `(k,)`.
pub(crate) fn list(name: &str, array: &Floats) -> PyResult<Vec<f64>> {
    let view = array.as_array();
    let refused = |found: String| Err(PyValueError::new_err(format!("{name} {found}; a list or an array is needed")));
    match view.shape() {
        [_] => finite(name, view.iter().copied().collect()),
        [] => refused("is a number".into()),
        other => refused(format!("has shape {other:?}")),
    }
}

/// `t` where it lies between `start` and `end`; at both the last digit of `t` does not count.
pub(crate) fn within(t: f64, start: f64, end: f64) -> Option<f64> {
    let room = f64::EPSILON * start.abs().max(t.abs()).max(1e-300);
    (start - room <= t && t <= end + room).then(|| t.clamp(start, end))
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

/// [`array`] of a result, which nobody is to change.
pub(crate) fn fixed<'py>(py: Python<'py>, values: Vec<f64>, count: Option<usize>, tail: &[usize]) -> Array<'py> {
    array(py, values, count, tail).map(read_only)
}

/// A result of shape `(k,)`, which nobody is to change.
pub(crate) fn vector(py: Python<'_>, values: Vec<f64>) -> PyResult<Py<PyArrayDyn<f64>>> {
    let count = Some(values.len());
    fixed(py, values, count, &[]).map(Bound::unbind)
}

/// The array, which cannot be written to any more.
pub(crate) fn read_only<T: Element, D: Dimension>(array: Bound<'_, PyArray<T, D>>) -> Bound<'_, PyArray<T, D>> {
    array.readwrite().make_nonwriteable();
    array
}

/// Columns by name: element `i` of each row, as an array of shape `(count,)` that ends in NaN where rows are
/// missing, or a number for a single row.
pub(crate) fn columns<'py, 'a>(
    py: Python<'py>,
    names: &[String],
    rows: impl Iterator<Item = &'a [f64]> + Clone,
    count: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (i, name) in names.iter().enumerate() {
        let mut column: Vec<f64> = rows.clone().map(|row| row[i]).collect();
        column.resize(count.unwrap_or(1), f64::NAN);
        match count {
            Some(_) => dict.set_item(name, read_only(PyArray1::from_vec(py, column)))?,
            None => dict.set_item(name, column[0])?,
        }
    }
    Ok(dict)
}

/// Points at which expressions of t, q and v are asked for.
pub(crate) struct Points {
    rows: [Rows; 3],
    pub(crate) count: Option<usize>,
}

impl Points {
    /// Reads t, q and v of a system of that dimension.
    pub(crate) fn read([t, q, v]: [Floats<'_>; 3], dimension: usize) -> PyResult<Points> {
        let (t, q, v) = (times("t", &t)?, Rows::read("q", &q, dimension)?, Rows::read("v", &v, dimension)?);
        let count = common(&[("q", &q), ("v", &v), ("t", &t)])?;
        Ok(Points { rows: [t, q, v], count })
    }

    /// Expressions of a system, to be evaluated at points.
    pub(crate) fn program(system: &System, expressions: &[Expr]) -> Result<Evaluator<f64>, CompileError> {
        let inputs = [&[system.time][..], &system.positions(), &system.velocities()].concat();
        system.evaluator(&inputs, expressions)
    }

    /// Their values at each point, row after row.
    pub(crate) fn values(&self, mut program: Evaluator<f64>) -> Vec<f64> {
        let mut values = Vec::new();
        for i in 0..self.count.unwrap_or(1) {
            values.extend_from_slice(program.evaluate(&self.rows.each_ref().map(|rows| rows.row(i)).concat()));
        }
        values
    }
}

/// Times and states at which something is asked for.
pub(crate) struct States {
    t: Rows,
    y: Rows,
    pub(crate) count: Option<usize>,
}

impl States {
    pub(crate) fn read(t: &Floats<'_>, y: &Floats<'_>, width: usize) -> PyResult<States> {
        let (t, y) = (times("t", t)?, Rows::read("y", y, width)?);
        let count = common(&[("y", &y), ("t", &t)])?;
        if t.count().is_some() && y.count().is_none() {
            return Err(PyValueError::new_err("t has several entries, y has a single row"));
        }
        Ok(States { t, y, count })
    }

    /// Calls `body` with each time and state.
    pub(crate) fn each(&self, mut body: impl FnMut(f64, &[f64]) -> Result<(), EvaluationFailure>) -> PyResult<()> {
        for i in 0..self.count.unwrap_or(1) {
            let time = self.t.row(i)[0];
            body(time, self.y.row(i)).map_err(|error| errors::evaluation(&error, time))?;
        }
        Ok(())
    }
}
