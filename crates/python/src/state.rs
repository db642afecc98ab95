//! A point of a motion.

use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::pickled::kept;

/// A point of a motion: time, coordinates, velocities.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct State {
    /// Time.
    pub(crate) t: f64,
    /// Coordinates, shape (n,), in the units of the system.
    pub(crate) q: Py<PyArrayDyn<f64>>,
    /// Velocities, shape (n,), in units of the coordinates per unit of time.
    pub(crate) v: Py<PyArrayDyn<f64>>,
}

kept!(State: t q v);

#[pymethods]
impl State {
    fn __repr__(&self) -> String {
        format!("<deltaq.State t={}, q={}, v={}>", self.t, self.q, self.v)
    }
}
