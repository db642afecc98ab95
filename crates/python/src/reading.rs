//! Systems from files and texts.

use std::collections::HashMap;
use std::path::PathBuf;

use pyo3::prelude::*;
use scene::Scene;

use crate::errors;
use crate::system::{Overrides, System};

/// A system from a scene file of at most 1 MiB.
///
/// overrides: name to number: parameter, start value ("x", "x'"), "time", "duration", multiplier ("mu1").
#[pyfunction]
#[pyo3(signature = (path, overrides=None))]
pub(crate) fn load(py: Python<'_>, path: PathBuf, overrides: Option<HashMap<String, f64>>) -> PyResult<System> {
    let overrides: Overrides = overrides.into_iter().flatten().collect();
    let text = py.detach(|| Scene::read(&path)).map_err(|error| errors::scene(py, &error))?;
    System::read(py, ("", Some(&path)), text, overrides)
}

/// A system from the text of a scene file. `name` stands for the file in errors; overrides as in `load`.
#[pyfunction]
#[pyo3(signature = (text, overrides=None, *, name="scene"))]
pub(crate) fn parse(
    py: Python<'_>,
    text: &str,
    overrides: Option<HashMap<String, f64>>,
    name: &str,
) -> PyResult<System> {
    System::read(py, (name, None), text.into(), overrides.into_iter().flatten().collect())
}

/// What a pickled system is read from.
#[pyfunction]
pub(crate) fn _read_again(py: Python<'_>, name: &str, text: String, overrides: Overrides) -> PyResult<System> {
    System::read(py, (name, None), text, overrides)
}
