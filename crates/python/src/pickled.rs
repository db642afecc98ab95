//! What is handed back, as something that can be pickled and copied: by its fields, as Python has them.

use numpy::PyUntypedArray;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A class of fields that Python reads, with the docstrings of the stubs. It is pickled by these fields; what
/// is not a field follows with the value that it has when it is read again.
macro_rules! answer {
    ($class:ident { $($field:ident: $type:ty,)* } $($(#[$about:meta])* $own:ident: $kind:ty = $value:expr,)*) => {
        #[doc = include_str!(concat!(env!("OUT_DIR"), "/", stringify!($class), ".txt"))]
        #[pyo3::pyclass(frozen, module = "deltaq")]
        pub(crate) struct $class {
            $(
                #[doc = include_str!(concat!(env!("OUT_DIR"), "/", stringify!($class), ".", stringify!($field), ".txt"))]
                #[pyo3(get)]
                pub(crate) $field: $type,
            )*
            $( $(#[$about])* pub(crate) $own: $kind, )*
        }

        #[pyo3::pymethods]
        impl $class {
            fn __reduce__<'py>(slf: &pyo3::Bound<'py, Self>) -> pyo3::PyResult<$crate::pickled::Reduced<'py>> {
                use pyo3::types::{PyAnyMethods, PyDictMethods};
                let state = pyo3::types::PyDict::new(slf.py());
                $( state.set_item(stringify!($field), slf.getattr(stringify!($field))?)?; )*
                let again = slf.py().import("deltaq")?.getattr("_again")?;
                Ok((again, (stringify!($class), state)))
            }
        }

        impl $crate::pickled::Pickled for $class {
            fn again(state: &pyo3::Bound<'_, pyo3::types::PyDict>) -> pyo3::PyResult<Self> {
                Ok($class {
                    $($field: $crate::pickled::field(state, stringify!($field))?,)*
                    $($own: $value,)*
                })
            }
        }
    };
}
pub(crate) use answer;

/// What `__reduce__` gives: a function and its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (&'static str, Bound<'py, PyDict>));

/// A class that is read again from its fields.
pub(crate) trait Pickled: Sized {
    fn again(state: &Bound<'_, PyDict>) -> PyResult<Self>;
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
