//! A scene from the arguments of `System(...)`: they are written as the text of a scene file and read as one,
//! so that there is one way to read a system and every fault has a place.

use std::fmt::Write;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyMapping, PySequence, PyString};

use crate::arguments::Table;

/// A name or a formula: text, or an expression of SymPy.
pub(crate) struct Formula(pub(crate) String);

/// Any iterable of formulas.
pub(crate) struct Formulas(pub(crate) Vec<String>);

impl<'py> FromPyObject<'_, 'py> for Formula {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match text_of(&object)? {
            Some(text) => Ok(Formula(text)),
            None => Err(unexpected(&object, "a string or an expression of SymPy")),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for Formulas {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if text_of(&object)?.is_some() {
            return Err(unexpected(&object, "a list of strings or of expressions of SymPy"));
        }
        object.try_iter()?.map(|entry| Ok(entry?.extract::<Formula>()?.0)).collect::<PyResult<_>>().map(Formulas)
    }
}

/// The text of a string or of an expression of SymPy.
fn text_of(object: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(Some(text.to_cow()?.into_owned()));
    }
    object.py().import("deltaq._sympy")?.call_method1("text", (object,))?.extract()
}

fn unexpected(object: &Bound<'_, PyAny>, expected: &str) -> PyErr {
    PyTypeError::new_err(format!("{} where {expected} is expected", object.get_type()))
}

/// Names with what is said of them.
fn entries<'py>(table: Option<&Table<'py>>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let pairs = table.into_iter().flat_map(|table| table.0.iter());
    pairs.map(|(key, entry)| Ok((key.extract::<Formula>()?.0, entry))).collect()
}

/// The arguments of `System(...)`.
pub(crate) struct Arguments<'py> {
    pub(crate) title: String,
    pub(crate) coordinates: Vec<String>,
    pub(crate) units: Option<Table<'py>>,
    pub(crate) start: Table<'py>,
    /// Sections whose entries are handed on as they are: name and entries.
    pub(crate) tables: Vec<(&'static str, Option<Table<'py>>)>,
    pub(crate) lagrangian: String,
    pub(crate) constraints: Vec<String>,
    pub(crate) virtual_conditions: Vec<String>,
    pub(crate) start_equations: Vec<String>,
    pub(crate) time: f64,
    pub(crate) project: bool,
    pub(crate) multipliers: Option<Bound<'py, PyAny>>,
    pub(crate) duration: f64,
    pub(crate) breakpoints: Vec<f64>,
    pub(crate) notes: &'py str,
}

/// The text of the scene.
pub(crate) fn write(arguments: &Arguments<'_>) -> PyResult<String> {
    let coordinates = &arguments.coordinates;
    let (units, start) = (entries(arguments.units.as_ref())?, entries(Some(&arguments.start))?);
    let mut text = format!("title = {}\n", quoted(&arguments.title));
    if !arguments.notes.is_empty() {
        let _ = writeln!(text, "notes = {}", scene::quoted(arguments.notes));
    }
    text += "[coordinates]\n";
    for (name, table) in [("units", &units), ("start", &start)] {
        if let Some((key, _)) = table.iter().find(|(key, _)| !coordinates.contains(key)) {
            let known = coordinates.join(", ");
            return Err(PyValueError::new_err(format!("`{key}` in {name} is not a coordinate; known: {known}")));
        }
    }
    for name in coordinates {
        let mut said = Vec::new();
        for (key, table) in [("unit", &units), ("start", &start)] {
            if let Some((_, entry)) = table.iter().find(|(of, _)| of == name) {
                said.push(format!("{key} = {}", value(entry)?));
            }
        }
        let _ = writeln!(text, "{} = {{ {} }}", quoted(name), said.join(", "));
    }
    let list = |key: &str, written: &[String]| {
        let lines: Vec<String> = written.iter().map(|e| format!("  {},\n", quoted(e))).collect();
        if lines.is_empty() { String::new() } else { format!("{key} = [\n{}]\n", lines.concat()) }
    };
    let _ = writeln!(text, "[system]\nlagrangian = {}", quoted(&arguments.lagrangian));
    text += &list("constraints", &arguments.constraints);
    text += &list("virtual", &arguments.virtual_conditions);
    let _ = writeln!(text, "[start]\ntime = {:?}\nproject = {}", arguments.time, arguments.project);
    text += &list("equations", &arguments.start_equations);
    for (section, table) in &arguments.tables {
        let Some(table) = table else { continue };
        let _ = writeln!(text, "[{section}]");
        for (key, entry) in entries(Some(table))? {
            let _ = writeln!(text, "{} = {}", quoted(&key), value(&entry)?);
        }
    }
    if let Some(multipliers) = &arguments.multipliers {
        let _ = writeln!(text, "[vakonomic]\nmultipliers = {}", value(multipliers)?);
    }
    let _ = writeln!(text, "[run]\nduration = {:?}", arguments.duration);
    if !arguments.breakpoints.is_empty() {
        let _ = writeln!(text, "breakpoints = {:?}", arguments.breakpoints);
    }
    Ok(text)
}

/// A value as TOML, on one line.
fn value(object: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Some(text) = text_of(object)? {
        return Ok(quoted(&text));
    }
    if let Ok(truth) = object.cast::<PyBool>() {
        return Ok(truth.is_true().to_string());
    }
    if let Ok(table) = object.cast::<PyMapping>() {
        let mut entries = Vec::new();
        for pair in table.items()?.iter() {
            let (key, entry): (Formula, Bound<'_, PyAny>) = pair.extract()?;
            entries.push(format!("{} = {}", quoted(&key.0), value(&entry)?));
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
        Err(_) => Err(unexpected(object, "a number, a string, an expression of SymPy, a list or a dict")),
    }
}

/// A basic string. Line breaks and tabs mean nothing in formulas; places are easier without escapes.
fn quoted(text: &str) -> String {
    scene::quoted(&text.replace(['\n', '\r', '\t'], " "))
}
