//! Equations of motion to first order, and their eigenvalues.

use std::collections::HashMap;

use deltaq::{Choice, Settings, setting};
use linear::{LinearError, Part, find_steady, linearize, linearize_at};
use numpy::{Complex64, PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use scene::Scene;

use crate::arrays::array;
use crate::{arguments, background, errors};

/// The equations of motion to first order about a steady motion, or about an instant of any other.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Linearization {
    /// The form of the formulation whose states these are.
    form: &'static str,
    /// Time.
    t: f64,
    /// Whether the motion is steady; at an instant of any other the eigenvalues are frozen.
    is_steady: bool,
    /// Names of the states y, length N: coordinates, and velocities or what stands for them.
    states: Vec<String>,
    /// Their values, shape (N,).
    values: Py<PyArrayDyn<f64>>,
    /// Coordinates on which no rate depends, with their rates: no states here, their eigenvalues are zero.
    carried: HashMap<String, f64>,
    /// J = dF/dy, shape (N, N).
    matrix: Py<PyArrayDyn<f64>>,
    /// Names of the states whose eigenvalues these are.
    of: Vec<String>,
    /// Eigenvalues other than zero, complex, shape (k,), by falling real part, in 1 over the unit of time.
    eigenvalues: Py<PyArray1<Complex64>>,
    /// How far they move where J moves by its error, shape (k,).
    errors: Py<PyArrayDyn<f64>>,
    /// How many more eigenvalues there are, all zero.
    zeros: usize,
    /// Independent eigenvectors of all zeros of J: fewer than these where deviations grow as powers of time.
    zero_vectors: usize,
    /// How far these may be from zero.
    zero_error: f64,
    /// How many eigenvalues have a real part above their error.
    unstable: usize,
    /// The same in words: "like t" where an eigenvalue on the imaginary axis has too few eigenvectors,
    /// "undecided" where errors leave it open or all eigenvalues are zero.
    growing: String,
}

fn linearized(
    mut scene: Scene,
    choice: &Choice,
    free: &[String],
    (at, find): (Option<f64>, bool),
    settings: &Settings,
) -> Result<(linear::Linearization, Part), LinearError> {
    if find {
        scene.start = find_steady(setting(&scene))?;
    }
    let found = match at {
        None => linearize(setting(&scene), choice)?,
        Some(t) => linearize_at(setting(&scene), choice, t, settings)?,
    };
    let free: Vec<&str> = free.iter().map(String::as_str).collect();
    let part = found.part(&free)?;
    Ok((found, part))
}

impl Linearization {
    /// Linearizes about the start, a steady motion near it, or the motion at a time.
    pub(crate) fn about(
        py: Python<'_>,
        scene: Scene,
        choice: Choice,
        free: Vec<String>,
        how: (Option<f64>, bool),
    ) -> PyResult<Linearization> {
        let (settings, interrupt) = arguments::settings("auto", 1e-11, true, 1_000_000, None, None)?;
        let work = move || linearized(scene, &choice, &free, how, &settings);
        let (found, part) = background::run(py, &interrupt, work)?.map_err(|error| match error {
            LinearError::Solve(error) => errors::solve(error),
            other => errors::SolveError::new_err(other.to_string()),
        })?;
        let n = found.states.len();
        let eigenvalues = part.eigenvalues.iter().map(|e| Complex64::new(e.value.re, e.value.im)).collect();
        let moved: Vec<f64> = part.eigenvalues.iter().map(|e| e.error).collect();
        let count = moved.len();
        Ok(Linearization {
            form: found.form,
            t: found.t,
            is_steady: found.is_steady,
            of: part.states.iter().map(|&i| found.states[i].clone()).collect(),
            values: array(py, found.values, None, &[n])?.unbind(),
            carried: found.carried.into_iter().map(|c| (c.name, c.rate)).collect(),
            matrix: array(py, found.matrix.transpose().as_slice().to_vec(), None, &[n, n])?.unbind(),
            states: found.states,
            eigenvalues: PyArray1::from_vec(py, eigenvalues).unbind(),
            errors: array(py, moved, None, &[count])?.unbind(),
            zeros: part.zeros,
            zero_vectors: found.spectrum.zero_vectors,
            zero_error: part.zero_error,
            unstable: part.unstable(),
            growing: part.growth().to_string(),
        })
    }
}

#[pymethods]
impl Linearization {
    fn __repr__(&self) -> String {
        let Linearization { form, t, of, zeros, growing, .. } = self;
        format!("<deltaq.Linearization {form}, t = {t}, of {}: {zeros} zeros, growing: {growing}>", of.join(", "))
    }
}
