//! Systems from files and texts.

use std::fs::File;
use std::path::PathBuf;

use pyo3::prelude::*;
use scene::Scene;
use stubs::stubbed;

use crate::arguments::{Numbers, unknown};
use crate::errors;
use crate::system::{Overrides, System};

#[stubbed]
pub(crate) fn load(py: Python<'_>, path: PathBuf, overrides: Option<Numbers>) -> PyResult<System> {
    let overrides = overrides.map_or(Overrides::new(), |numbers| numbers.0);
    // what the operating system refuses is its own error: FileNotFoundError, PermissionError, ...
    drop(py.detach(|| File::open(&path)).map_err(|error| errors::file(&path, &error))?);
    let text = py.detach(|| Scene::read(&path)).map_err(|error| errors::scene(py, &error))?;
    System::read(py, ("", Some(&path)), text, overrides)
}

#[stubbed]
pub(crate) fn parse(py: Python<'_>, text: &str, overrides: Option<Numbers>, name: &str) -> PyResult<System> {
    let overrides = overrides.map_or(Overrides::new(), |numbers| numbers.0);
    System::read(py, (name, None), text.into(), overrides)
}

#[stubbed]
pub(crate) fn built_in(py: Python<'_>, name: &str, overrides: Option<Numbers>) -> PyResult<System> {
    let Some(text) = scene::catalogue::text_of(name) else {
        let known = scene::catalogue::built_in().map(|(known, _)| *known).chain(["n-trailer-N"]);
        return Err(unknown("built-in scene", name, known));
    };
    System::read(py, (name, None), text, overrides.map_or(Overrides::new(), |numbers| numbers.0))
}

/// What a pickled system is read from.
#[stubbed]
pub(crate) fn _read_again(py: Python<'_>, name: &str, text: String, overrides: Overrides) -> PyResult<System> {
    System::read(py, (name, None), text, overrides)
}
