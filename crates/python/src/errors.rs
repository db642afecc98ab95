//! Exceptions: one class for each error of the library that a caller can meet.

use std::path::Path;

use equations::EvaluationFailure;
use motion::Broken;
use pyo3::exceptions::{PyException, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyType};
use scene::SceneErrorKind;

stubs::exceptions!();

/// `UnknownNameError`: one class for all names, which two classes have been caught by.
pub(crate) fn unknown_name(py: Python<'_>) -> PyResult<&Bound<'_, PyType>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = CLASS.get_or_try_init(py, || {
        let bases = (py.get_type::<DeltaqError>(), py.get_type::<PyValueError>());
        let text = "A name that means nothing where it stands: of a formulation, a removal, a number, a run.";
        let said = [("__module__", "deltaq"), ("__doc__", text)].into_py_dict(py)?;
        let class = py.get_type::<PyType>().call1(("UnknownNameError", bases, said))?;
        PyResult::Ok(class.cast_into::<PyType>()?.unbind())
    })?;
    Ok(class.bind(py))
}

/// The name means nothing, as the text says.
pub(crate) fn unknown(text: String) -> PyErr {
    Python::attach(|py| unknown_name(py).map_or_else(|error| error, |class| PyErr::from_type(class.clone(), text)))
}

/// What the operating system says of a file, of the class that Python has for that.
pub(crate) fn file(path: &Path, error: &std::io::Error) -> PyErr {
    let text = error.to_string();
    let words = text.split(" (os error").next().unwrap_or(&text).to_owned();
    PyOSError::new_err((error.raw_os_error(), words, path.as_os_str().to_owned()))
}

/// What is raised where deltaq itself is at fault.
pub(crate) fn broken(broken: &Broken) -> PyErr {
    FaultError::new_err(broken.to_string())
}

pub(crate) fn scene(py: Python<'_>, error: &scene::SceneError) -> PyErr {
    if let (0, SceneErrorKind::UnknownName { .. }) = (error.line, &*error.kind) {
        return unknown(error.to_string());
    }
    let raised = SceneError::new_err(error.to_string());
    let value = raised.value(py);
    let set = value
        .setattr("file", &error.file)
        .and_then(|()| value.setattr("line", error.line))
        .and_then(|()| value.setattr("column", error.column));
    set.err().unwrap_or(raised)
}

pub(crate) fn solve(error: impl Into<motion::SolveError>) -> PyErr {
    use motion::SolveError as Error;
    let error = error.into();
    let text = error.to_string();
    match error {
        Error::Derivation(_) => DerivationError::new_err(text),
        Error::Removal(_) => RemovalError::new_err(text),
        Error::Scene(error) => Python::attach(|py| scene(py, &error)),
        Error::Start(_) => StartError::new_err(text),
        Error::Compile(_) => CompileError::new_err(text),
        Error::AtStart(_) | Error::OutsideDomain { .. } | Error::Reading { .. } | Error::Dense(_) => {
            EvaluationError::new_err(text)
        }
        Error::Boundary { .. }
        | Error::Search { .. }
        | Error::Ended { .. }
        | Error::TwoPoint { .. }
        | Error::Interrupted { .. } => BoundaryError::new_err(text),
        Error::Broken(error) => broken(&error),
        Error::Call(_) | Error::Tolerance { .. } => CallError::new_err(text),
        // constants, steps and members that make no sense, and what a later version refuses
        _ => SolveError::new_err(text),
    }
}

pub(crate) fn evaluation(error: &EvaluationFailure, t: f64) -> PyErr {
    EvaluationError::new_err(format!("at t = {t}: {error}"))
}
