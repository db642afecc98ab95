//! What is handed back, as something that can be pickled and copied: by its fields, as Python has them.

use numpy::PyUntypedArray;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What `__reduce__` gives: a function and its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyDict>,));

/// A result by its fields, as Python reads them.
pub(crate) fn reduced<'py>(of: &Bound<'py, PyAny>, fields: &[&str]) -> PyResult<Reduced<'py>> {
    let state = PyDict::new(of.py());
    fields.iter().try_for_each(|field| state.set_item(field, of.getattr(*field)?))?;
    Ok((of.get_type().getattr("_again")?, (state,)))
}

/// `call(*arguments, **options)` without the arguments.
pub(crate) fn partial<'py>(call: Bound<'py, PyAny>, options: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    call.py().import("functools")?.getattr("partial")?.call((call,), Some(options))
}

/// The field of that name.
pub(crate) fn field<'py, T: FromPyObjectOwned<'py>>(state: &Bound<'py, PyDict>, name: &str) -> PyResult<T> {
    let value = state.as_any().get_item(name)?;
    fix(&value)?;
    value.extract().map_err(Into::into)
}

/// Arrays lose on their way that they cannot be written to.
fn fix(value: &Bound<'_, PyAny>) -> PyResult<()> {
    if let Ok(entries) = value.cast::<PyDict>() {
        return entries.iter().try_for_each(|(_, entry)| fix(&entry));
    }
    if value.cast::<PyUntypedArray>().is_ok() {
        value.getattr("flags")?.setattr("writeable", false)?;
    }
    Ok(())
}
