//! Equations of motion to first order, and their eigenvalues.

use integrate::Interrupt;
use linear::{LinearError, Part, find_steady, linearize, linearize_at};
use motion::{Choice, Settings, setting};
use numpy::{Complex64, PyArray1, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use scene::Scene;

use crate::arrays::{fixed, read_only};
use crate::pickled::kept;
use crate::system::System;
use crate::{arguments, background, errors};

/// The equations of motion to first order about a steady motion, or about an instant of any other.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Linearization {
    /// The form of the formulation whose states these are.
    form: String,
    /// Time.
    t: f64,
    /// Whether the motion is steady; at an instant of any other the eigenvalues are frozen.
    is_steady: bool,
    /// Names of the states y, length N: coordinates, and velocities or what stands for them.
    states: Vec<String>,
    /// Their values, shape (N,).
    values: Py<PyArrayDyn<f64>>,
    /// Coordinates on which no rate depends, with their rates: no states here, their eigenvalues are zero.
    carried: Py<PyDict>,
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

kept!(
    Linearization: form t is_steady states values carried matrix of eigenvalues errors zeros zero_vectors zero_error
    unstable growing
);

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

/// The error as Python has it.
fn refused(error: LinearError) -> PyErr {
    match error {
        LinearError::Solve(error) => errors::solve(error),
        LinearError::UnknownFree { .. } => errors::unknown(error.to_string()),
        other => errors::SolveError::new_err(other.to_string()),
    }
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
        let (found, part) = background::run(py, &interrupt, work)?.map_err(refused)?;
        Linearization::new(py, found, &part)
    }

    fn new(py: Python<'_>, found: linear::Linearization, part: &Part) -> PyResult<Linearization> {
        let n = found.states.len();
        let eigenvalues = part.eigenvalues.iter().map(|e| Complex64::new(e.value.re, e.value.im)).collect();
        let moved: Vec<f64> = part.eigenvalues.iter().map(|e| e.error).collect();
        let count = moved.len();
        Ok(Linearization {
            form: found.form.into(),
            t: found.t,
            is_steady: found.is_steady,
            of: part.states.iter().map(|&i| found.states[i].clone()).collect(),
            values: fixed(py, found.values, None, &[n])?.unbind(),
            carried: found.carried.into_iter().map(|c| (c.name, c.rate)).into_py_dict(py)?.unbind(),
            matrix: fixed(py, found.matrix.transpose().as_slice().to_vec(), None, &[n, n])?.unbind(),
            states: found.states,
            eigenvalues: read_only(PyArray1::from_vec(py, eigenvalues)).unbind(),
            errors: fixed(py, moved, None, &[count])?.unbind(),
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

/// Steady motions over one number of a system, and where stability changes.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct LinearizationSweep {
    /// The system.
    system: Py<System>,
    /// What varies.
    name: String,
    /// Its values in the states that are linearized, shape (k,).
    values: Py<PyArrayDyn<f64>>,
    /// Its values in the starts from which these states were found, shape (k,); the same without `find`.
    asked: Py<PyArrayDyn<f64>>,
    /// The equations to first order at each value.
    points: Vec<Py<Linearization>>,
    /// Where the number of eigenvalues with a positive real part changes, by rising value asked for.
    changes: Vec<Py<StabilityChange>>,
}

kept!(LinearizationSweep: system name values asked points changes);

/// A value at which stability changes.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct StabilityChange {
    /// The value, in the steady motion there.
    value: f64,
    /// Width of the interval in which it is: no error leaves another one open.
    width: f64,
    /// The value in the start from which that motion was found; the same without `find`.
    asked: f64,
    /// Eigenvalues with a positive real part below it.
    below: usize,
    /// Eigenvalues with a positive real part above it.
    above: usize,
    /// Imaginary part of the eigenvalue that crosses, not negative: 0 for one that does not oscillate.
    frequency: f64,
}

kept!(StabilityChange: value width asked below above frequency);

#[pymethods]
impl StabilityChange {
    fn __repr__(&self) -> String {
        format!("<deltaq.StabilityChange at {}, unstable: {} to {}>", self.value, self.below, self.above)
    }
}

#[pymethods]
impl LinearizationSweep {
    fn __len__(&self) -> usize {
        self.points.len()
    }

    fn __repr__(&self) -> String {
        let LinearizationSweep { name, points, changes, .. } = self;
        format!("<deltaq.LinearizationSweep over {name}: {} points, {} changes>", points.len(), changes.len())
    }
}

impl LinearizationSweep {
    pub(crate) fn over(
        system: &Bound<'_, System>,
        scene: Scene,
        choice: Choice,
        (name, values): (&str, Vec<f64>),
        (free, find): (Vec<String>, bool),
    ) -> PyResult<LinearizationSweep> {
        let (py, interrupt) = (system.py(), Interrupt::default());
        let work = move || {
            let free: Vec<&str> = free.iter().map(String::as_str).collect();
            linear::sweep(&scene, &choice, &free, (name, &values), find)
        };
        let swept = background::run(py, &interrupt, work)?.map_err(refused)?;
        let count = Some(swept.points.len());
        let column = |of: fn(&linear::SweepPoint) -> f64| fixed(py, swept.points.iter().map(of).collect(), count, &[]);
        let changes = swept.changes.iter().map(|change| {
            let linear::Change { value, width, asked, unstable: [below, above], frequency, .. } = *change;
            Py::new(py, StabilityChange { value, width, asked, below, above, frequency })
        });
        Ok(LinearizationSweep {
            system: system.clone().unbind(),
            name: name.into(),
            values: column(|point| point.value)?.unbind(),
            asked: column(|point| point.asked)?.unbind(),
            changes: changes.collect::<PyResult<_>>()?,
            points: swept
                .points
                .into_iter()
                .map(|point| Py::new(py, Linearization::new(py, point.linearization, &point.part)?))
                .collect::<PyResult<_>>()?,
        })
    }
}
