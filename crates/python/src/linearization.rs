//! Equations of motion to first order, and their eigenvalues.

use integrate::Interrupt;
use linear::{LinearError, Part, find_steady, linearize, linearize_at};
use motion::{Choice, Settings, setting};
use numpy::{Complex64, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use scene::Scene;
use stubs::{answer, stubbed};

use crate::arrays::{fixed, read_only, vector};
use crate::system::System;
use crate::{arguments, background, errors};

#[answer]
pub(crate) struct Linearization;

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
        Ok(Linearization {
            form: found.form.into(),
            t: found.t,
            is_steady: found.is_steady,
            of: part.states.iter().map(|&i| found.states[i].clone()).collect(),
            values: vector(py, found.values)?,
            carried: found.carried.into_iter().map(|c| (c.name, c.rate)).into_py_dict(py)?.unbind(),
            matrix: fixed(py, found.matrix.transpose().as_slice().to_vec(), None, &[n, n])?.unbind(),
            states: found.states,
            eigenvalues: read_only(PyArray1::from_vec(py, eigenvalues)).to_dyn().clone().unbind(),
            errors: vector(py, part.eigenvalues.iter().map(|e| e.error).collect())?,
            zeros: part.zeros,
            zero_vectors: found.spectrum.zero_vectors,
            zero_error: part.zero_error,
            unstable: part.unstable(),
            growing: part.growth().to_string(),
        })
    }
}

#[stubbed]
impl Linearization {
    fn __repr__(&self) -> String {
        let Linearization { form, t, of, zeros, growing, .. } = self;
        format!("<deltaq.Linearization {form}, t = {t}, of {}: {zeros} zeros, growing: {growing}>", of.join(", "))
    }
}

#[answer]
pub(crate) struct LinearizationSweep;

#[answer("<deltaq.StabilityChange at {value}, unstable: {below} to {above}>")]
pub(crate) struct StabilityChange;

#[stubbed]
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
        let column = |of: fn(&linear::SweepPoint) -> f64| vector(py, swept.points.iter().map(of).collect());
        let changes = swept.changes.iter().map(|change| {
            let linear::Change { value, width, asked, unstable: [below, above], frequency, .. } = *change;
            Py::new(py, StabilityChange { value, width, asked, below, above, frequency })
        });
        Ok(LinearizationSweep {
            system: system.clone().unbind(),
            name: name.into(),
            values: column(|point| point.value)?,
            asked: column(|point| point.asked)?,
            changes: changes.collect::<PyResult<_>>()?,
            points: swept
                .points
                .into_iter()
                .map(|point| Py::new(py, Linearization::new(py, point.linearization, &point.part)?))
                .collect::<PyResult<_>>()?,
        })
    }
}
