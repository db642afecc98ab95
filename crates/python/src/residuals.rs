//! Residuals between a motion and data, as a function of numbers that never raises.

use equations::Outputs;
use mechanics::ConstantsRule;
use motion::{Choice, Model, Reading, Settings};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use scene::Scene;
use stubs::stubbed;

use crate::arguments::{Numbers, Table, unknown};
use crate::arrays::{Array, Floats, array, finite, list};
use crate::background::whole;
use crate::pickled::partial;
use crate::shared::Shared;
use crate::system::System;
use crate::{arguments, errors};

#[stubbed]
pub(crate) struct Residuals {
    model: Shared<Model>,
    #[pyo3(get)]
    names: Vec<String>,
    #[pyo3(get)]
    columns: Vec<String>,
    #[pyo3(get)]
    penalty: f64,
    places: Vec<Place>,
    /// By column: data, and what residuals are over.
    data: Vec<(Vec<f64>, f64)>,
    ended: Shared<Option<String>>,
    /// How it was asked for.
    call: (Py<PyAny>, Py<PyTuple>),
}

/// Where a column stands.
#[derive(Clone, Copy)]
enum Place {
    Coordinate(usize),
    Velocity(usize),
    Multiplier(usize),
}

impl Place {
    fn of(self, outputs: &Outputs) -> f64 {
        match self {
            Place::Coordinate(i) => outputs.coordinates[i],
            Place::Velocity(i) => outputs.velocities[i],
            Place::Multiplier(i) => outputs.multipliers[i],
        }
    }
}

impl Residuals {
    /// For a scene and a choice; `call` makes the same again.
    fn new(
        (scene, choice): (&Scene, &Choice),
        (names, times, data): (Vec<String>, &[f64], Table<'_>),
        sigma: Option<Numbers>,
        penalty: f64,
        settings: &Settings,
        call: (Py<PyAny>, Py<PyTuple>),
    ) -> PyResult<Residuals> {
        if !(penalty > 0.0 && penalty.is_finite()) {
            return Err(PyValueError::new_err(format!("penalty is {penalty}; it must be above 0 and finite")));
        }
        let asked: Vec<&str> = names.iter().map(String::as_str).collect();
        let model = whole(|| Model::new(scene, choice, &asked, times, settings))?.map_err(errors::solve)?;
        let coordinates: Vec<&str> = scene.system.coordinates.iter().map(|c| c.name.as_str()).collect();
        let multipliers = model.multipliers();
        let known = || {
            let velocities = coordinates.iter().map(|name| format!("{name}'"));
            coordinates.iter().map(|name| name.to_string()).chain(velocities).chain(multipliers.clone())
        };
        let sigmas = sigma.map_or(Vec::new(), |Numbers(sigma)| sigma);
        let (mut columns, mut places, mut rows) = (Vec::new(), Vec::new(), Vec::new());
        for (name, values) in data.0.iter() {
            let name: String = name.extract()?;
            let n = coordinates.len();
            let place = match known().position(|known| known == name) {
                Some(i) if i < n => Place::Coordinate(i),
                Some(i) if i < 2 * n => Place::Velocity(i - n),
                Some(i) => Place::Multiplier(i - 2 * n),
                None => {
                    let all: Vec<String> = known().collect();
                    return Err(unknown("column", &name, all.iter().map(String::as_str)));
                }
            };
            let values = finite(&name, list(&name, &values.extract()?)?)?;
            if values.len() != times.len() {
                let (found, needed) = (values.len(), times.len());
                return Err(PyValueError::new_err(format!("{name} has {found} entries; {needed} are needed")));
            }
            let sigma = sigmas.iter().find(|(own, _)| *own == name).map_or(1.0, |(_, sigma)| *sigma);
            if !(sigma > 0.0 && sigma.is_finite()) {
                return Err(PyValueError::new_err(format!(
                    "sigma of {name} is {sigma}; it must be above 0 and finite"
                )));
            }
            columns.push(name);
            places.push(place);
            rows.push((values, sigma));
        }
        if columns.is_empty() {
            return Err(PyValueError::new_err("data has no column"));
        }
        if let Some((name, _)) = sigmas.iter().find(|(name, _)| !columns.contains(name)) {
            return Err(unknown("column", name, columns.iter().map(String::as_str)));
        }
        let (model, ended) = (Shared::new(model), Shared::default());
        Ok(Residuals { model, names, columns, penalty, places, data: rows, ended, call })
    }

    /// What `read` gives for these numbers, and how it ended.
    fn read(
        &self,
        py: Python<'_>,
        p: &Floats<'_>,
        read: impl Fn(&mut Model, &[f64]) -> Reading + Send + Sync,
    ) -> PyResult<Reading> {
        let p: Vec<f64> = p.as_array().iter().copied().collect();
        if p.len() != self.names.len() {
            let (found, needed) = (p.len(), self.names.len());
            return Err(PyValueError::new_err(format!("p has {found} entries; {needed} are needed")));
        }
        let reading = py.detach(|| self.model.with(|model| read(model, &p)))?;
        self.ended.with(|ended| ended.clone_from(&reading.ended))?;
        Ok(reading)
    }

    fn count(&self) -> usize {
        self.data.iter().map(|(values, _)| values.len()).sum()
    }
}

#[stubbed]
impl Residuals {
    /// The residuals for numbers p of shape (P,): shape (columns times k,), finite whatever p is.
    fn __call__<'py>(&self, py: Python<'py>, p: Floats<'py>) -> Array<'py> {
        let reading = self.read(py, &p, |model, p| model.outputs(p))?;
        let mut values = Vec::with_capacity(self.count());
        for (place, (data, sigma)) in self.places.iter().zip(&self.data) {
            for (i, data) in data.iter().enumerate() {
                let value = reading.outputs.get(i).map(|outputs| (place.of(outputs) - data) / sigma);
                values.push(value.filter(|r| r.is_finite()).unwrap_or(self.penalty));
            }
        }
        let count = values.len();
        array(py, values, None, &[count])
    }

    fn jac<'py>(&self, py: Python<'py>, p: Floats<'py>) -> Array<'py> {
        let reading = self.read(py, &p, |model, p| model.derivatives(p))?;
        let mut values = Vec::with_capacity(self.count() * self.names.len());
        for (place, (data, sigma)) in self.places.iter().zip(&self.data) {
            for i in 0..data.len() {
                for j in 0..self.names.len() {
                    let value = reading.derivatives.get(i).map(|by| place.of(&by[j]) / sigma);
                    values.push(value.filter(|r| r.is_finite()).unwrap_or(0.0));
                }
            }
        }
        let (count, width) = (self.count(), self.names.len());
        array(py, values, None, &[count, width])
    }

    #[getter]
    fn ended(&self) -> PyResult<Option<String>> {
        self.ended.copy()
    }

    fn __len__(&self) -> usize {
        self.count()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, Bound<'py, PyTuple>) {
        let (call, arguments) = &slf.get().call;
        (call.bind(slf.py()).clone(), arguments.bind(slf.py()).clone())
    }

    fn __repr__(&self) -> String {
        format!("<deltaq.Residuals of {} by {}>", self.columns.join(", "), self.names.join(", "))
    }
}

#[stubbed]
impl System {
    /// `residuals` of columns by name.
    fn _residuals(
        slf: &Bound<'_, Self>,
        names: Vec<String>,
        times: Floats<'_>,
        data: Table<'_>,
        formulation: &str,
        sigma: Option<Table<'_>>,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
        method: &str,
        tolerance: f64,
        max_steps: usize,
        penalty: f64,
    ) -> PyResult<Residuals> {
        let py = slf.py();
        let options = PyDict::new(py);
        options.set_item("formulation", formulation)?;
        options.set_item("sigma", sigma.as_ref().map(|sigma| &sigma.0))?;
        options.set_item("removal", removal)?;
        let given = arguments::constants(constants.as_ref(), mu0)?;
        options.set_item("constants", given.as_ref().map(|rule| arguments::rule_value(py, rule)).transpose()?)?;
        options.set_item("method", method)?;
        options.set_item("tolerance", tolerance)?;
        options.set_item("max_steps", max_steps)?;
        options.set_item("penalty", penalty)?;
        let times = list("times", &times)?;
        let positional = (names.clone(), times.clone(), &data.0).into_pyobject(py)?;
        let call = partial(slf.getattr("_residuals")?, &options)?.unbind();
        let is_given = given.is_some();
        let scene = slf.get().scene()?;
        let formulation = arguments::formulation(formulation)?;
        let (settings, interrupt) = arguments::settings(method, tolerance, true, max_steps, None, None)?;
        let (scene, mut choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        if !is_given && matches!(choice.constants, ConstantsRule::Natural { .. }) {
            choice.constants = ConstantsRule::Zero;
        }
        let sigma = sigma.map(|sigma| sigma.0.extract()).transpose()?;
        let asked = (names, &times[..], data);
        Residuals::new((&scene, &choice), asked, sigma, penalty, &settings, (call, positional.unbind()))
    }
}
