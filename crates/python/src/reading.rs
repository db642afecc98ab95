//! Systems from files and texts.

use std::collections::HashMap;
use std::fs::File;
use std::path::PathBuf;

use pyo3::prelude::*;
use scene::Scene;

use crate::arguments::spelt;
use crate::errors;
use crate::system::{Overrides, System};

/// A system from a scene file of at most 1 MiB.
///
/// overrides: name to number: parameter, start value ("x", "x'"), "time", "duration", multiplier ("mu0_1").
/// FileNotFoundError where there is no file; UnknownNameError for a name that the scene has not.
#[pyfunction]
#[pyo3(signature = (path, overrides=None))]
pub(crate) fn load(py: Python<'_>, path: PathBuf, overrides: Option<HashMap<String, f64>>) -> PyResult<System> {
    let overrides = spelt(overrides.unwrap_or_default())?.into_iter().collect();
    // what the operating system refuses is its own error: FileNotFoundError, PermissionError, ...
    drop(py.detach(|| File::open(&path)).map_err(|error| errors::file(&path, &error))?);
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
    let overrides = spelt(overrides.unwrap_or_default())?.into_iter().collect();
    System::read(py, (name, None), text.into(), overrides)
}

/// What a pickled system is read from.
#[pyfunction]
pub(crate) fn _read_again(py: Python<'_>, name: &str, text: String, overrides: Overrides) -> PyResult<System> {
    System::read(py, (name, None), text, overrides)
}
