//! Systems from files and texts.

use std::collections::HashMap;
use std::path::PathBuf;

use pyo3::prelude::*;
use scene::{Scene, SceneError};

use crate::errors;
use crate::system::{Overrides, System};

/// A system from a scene file of at most 1 MiB.
///
/// overrides: name to number: parameter, start value ("x", "x'"), "time", "duration", multiplier ("mu1").
#[pyfunction]
#[pyo3(signature = (path, overrides=None))]
pub(crate) fn load(py: Python<'_>, path: PathBuf, overrides: Option<HashMap<String, f64>>) -> PyResult<System> {
    let overrides: Overrides = overrides.into_iter().flatten().collect();
    let read = py.detach(|| {
        let text = Scene::read(&path)?;
        Ok((Scene::parse_file(&path, &text, &overrides)?, text))
    });
    let (scene, text) = read.map_err(|error: SceneError| errors::scene(py, &error))?;
    Ok(System::of(scene, text, overrides))
}

/// A system from the text of a scene file. `name` stands for the file in errors; overrides as in `load`.
#[pyfunction]
#[pyo3(signature = (text, overrides=None, *, name="scene"))]
pub(crate) fn parse(
    py: Python<'_>,
    text: String,
    overrides: Option<HashMap<String, f64>>,
    name: &str,
) -> PyResult<System> {
    System::parse(py, name, text, overrides.into_iter().flatten().collect())
}
