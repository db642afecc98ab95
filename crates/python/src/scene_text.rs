//! A scene from the arguments of `System(...)`: they are written as the text of a scene file and read as one,
//! so that there is one way to read a system and every fault has a place.

use std::fmt::Write;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyMapping, PySequence, PyString};

/// The arguments of `System(...)`.
pub(crate) struct Arguments<'py> {
    pub(crate) title: String,
    pub(crate) coordinates: Vec<String>,
    pub(crate) units: Option<Bound<'py, PyDict>>,
    pub(crate) start: Option<Bound<'py, PyDict>>,
    /// Sections whose entries are handed on as they are: name and entries.
    pub(crate) tables: Vec<(&'static str, Option<Bound<'py, PyDict>>)>,
    pub(crate) lagrangian: String,
    pub(crate) constraints: Vec<String>,
    pub(crate) time: f64,
    pub(crate) project: bool,
    pub(crate) multipliers: Option<Bound<'py, PyAny>>,
    pub(crate) duration: f64,
}

/// The text of the scene.
pub(crate) fn write(arguments: &Arguments<'_>) -> PyResult<String> {
    let Arguments { coordinates, units, start, .. } = arguments;
    let mut text = format!("title = {}\n[coordinates]\n", quoted(&arguments.title));
    for (name, table) in [("units", units), ("start", start)] {
        let keys = table.iter().flat_map(|t| t.keys().iter().collect::<Vec<_>>());
        for key in keys.map(|key| key.extract::<String>()).collect::<PyResult<Vec<_>>>()? {
            if !coordinates.contains(&key) {
                let known = coordinates.join(", ");
                return Err(PyValueError::new_err(format!("`{key}` in {name} is no coordinate; known: {known}")));
            }
        }
    }
    for name in coordinates {
        let mut entries = Vec::new();
        for (key, table) in [("unit", units), ("start", start)] {
            if let Some(entry) = table.as_ref().map(|t| t.get_item(name)).transpose()?.flatten() {
                entries.push(format!("{key} = {}", value(&entry)?));
            }
        }
        let _ = writeln!(text, "{} = {{ {} }}", quoted(name), entries.join(", "));
    }
    let _ = writeln!(text, "[system]\nlagrangian = {}\nconstraints = [", quoted(&arguments.lagrangian));
    for constraint in &arguments.constraints {
        let _ = writeln!(text, "  {},", quoted(constraint));
    }
    let _ = writeln!(text, "]\n[start]\ntime = {:?}\nproject = {}", arguments.time, arguments.project);
    for (section, table) in &arguments.tables {
        let Some(table) = table else { continue };
        let _ = writeln!(text, "[{section}]");
        for (key, entry) in table.iter() {
            let _ = writeln!(text, "{} = {}", quoted(&key.extract::<String>()?), value(&entry)?);
        }
    }
    if let Some(multipliers) = &arguments.multipliers {
        let _ = writeln!(text, "[vakonomic]\nmultipliers = {}", value(multipliers)?);
    }
    let _ = writeln!(text, "[run]\nduration = {:?}", arguments.duration);
    Ok(text)
}

/// A value as TOML, on one line.
fn value(object: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(quoted(&text.to_cow()?));
    }
    if let Ok(truth) = object.cast::<PyBool>() {
        return Ok(truth.is_true().to_string());
    }
    if let Ok(table) = object.cast::<PyMapping>() {
        let mut entries = Vec::new();
        for pair in table.items()?.iter() {
            let (key, entry): (String, Bound<'_, PyAny>) = pair.extract()?;
            entries.push(format!("{} = {}", quoted(&key), value(&entry)?));
        }
        return Ok(format!("{{ {} }}", entries.join(", ")));
    }
    // An array of numpy is no sequence, but has a length; one with a single element also passes for a number.
    let is_list = object.cast::<PySequence>().is_ok() || object.len().is_ok();
    if is_list {
        let entries: PyResult<Vec<String>> = object.try_iter()?.map(|entry| value(&entry?)).collect();
        return Ok(format!("[{}]", entries?.join(", ")));
    }
    match object.extract::<f64>() {
        // TOML's `inf` is Rust's, too; its `nan` is not
        Ok(number) => Ok(format!("{number:?}").to_lowercase()),
        Err(_) => Err(PyTypeError::new_err(format!(
            "{} where a number, a string, a list or a dict is expected",
            object.get_type()
        ))),
    }
}

/// A basic string. Line breaks and tabs mean nothing in formulas; places are easier without escapes.
fn quoted(text: &str) -> String {
    scene::quoted(&text.replace(['\n', '\r', '\t'], " "))
}
