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
    let read = py.detach(|| Scene::load_with(&path, &overrides));
    Ok(System::of(read.map_err(|error| errors::scene(py, &error))?))
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
    System::parse(py, name, text, &overrides.into_iter().flatten().collect())
}
