//! A point of a motion.

use numpy::PyArrayDyn;
use pyo3::prelude::*;

use crate::pickled::answer;

answer! {
    State {
        t: f64,
        q: Py<PyArrayDyn<f64>>,
        v: Py<PyArrayDyn<f64>>,
    }
}

#[pymethods]
impl State {
    fn __repr__(&self) -> String {
        format!("<deltaq.State t={}, q={}, v={}>", self.t, self.q, self.v)
    }
}
