//! Motions, read off at many times.

use std::sync::{Mutex, PoisonError};

use deltaq::{ErrorEstimate, Seconds, Setting, SolveError, constant_names, error_estimates};
use integrate::Work;
use mechanics::Observables;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use scene::Scene;

use crate::arrays::{FloatList, Floats, array, columns, finite, times};
use crate::errors;
use crate::system::System;

/// Coordinates, velocities, multipliers and invariants at one instant, or at k of them.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Outputs {
    /// Coordinates q, shape (n,) or (k, n), in the units of the system.
    coordinates: Py<PyArrayDyn<f64>>,
    /// Velocities q', shape (n,) or (k, n), in units of the coordinates per unit of time.
    velocities: Py<PyArrayDyn<f64>>,
    /// Multipliers and costates by name, each a float or of shape (k,).
    multipliers: Py<PyDict>,
    /// Quantities that should stay constant by name, each a float or of shape (k,).
    invariants: Py<PyDict>,
    /// Observables of the system by name, each a float or of shape (k,).
    observables: Py<PyDict>,
}

/// A row of outputs, and the observables there.
pub(crate) type Row = (equations::Outputs, Vec<f64>);

/// `row` with the observables at that time.
pub(crate) fn observed(observables: &mut Observables, t: f64, row: equations::Outputs) -> Row {
    let values = observables.at(t, &row.coordinates, &row.velocities).to_vec();
    (row, values)
}

/// The times asked for; the run of the scene then ends at the last of them.
pub(crate) fn times_of_run(times: Option<FloatList<'_>>, scene: &mut Scene) -> PyResult<Option<Vec<f64>>> {
    let times = times.map(|times| finite("times", times.as_array().iter().copied().collect())).transpose()?;
    if let Some(times) = &times {
        let start = scene.start.t;
        if let Some(early) = times.iter().find(|&&t| t < start) {
            return Err(PyValueError::new_err(format!("times contains {early}, before the start {start}")));
        }
        let last = times.iter().fold(start, |a, &b| a.max(b));
        if last > start {
            scene.duration = last - start;
        }
    }
    Ok(times)
}

/// Names of multipliers, invariants and observables.
#[derive(Clone)]
pub(crate) struct Names {
    multipliers: Vec<String>,
    invariants: Vec<String>,
    observables: Vec<String>,
}

impl Names {
    pub(crate) fn of(equations: &equations::Equations, observables: &Observables) -> Names {
        let observables = observables.names().to_vec();
        let names = |list: &[equations::Named]| list.iter().map(|n| n.name.clone()).collect();
        Names { multipliers: names(&equations.multipliers), invariants: names(&equations.invariants), observables }
    }
}

impl Outputs {
    /// From `rows`, one an instant; `count` is `None` where there is one instant, given as a number.
    pub(crate) fn new(
        py: Python<'_>,
        rows: &[Row],
        dimension: usize,
        names: &Names,
        count: Option<usize>,
    ) -> PyResult<Outputs> {
        let flat = |pick: fn(&equations::Outputs) -> &[f64]| rows.iter().flat_map(|(r, _)| pick(r).to_vec()).collect();
        let matrix = |pick| array(py, flat(pick), count, &[dimension]).map(Bound::unbind);
        Ok(Outputs {
            coordinates: matrix(|r| &r.coordinates)?,
            velocities: matrix(|r| &r.velocities)?,
            multipliers: columns(py, &names.multipliers, rows.iter().map(|(r, _)| &r.multipliers[..]), count)?.unbind(),
            invariants: columns(py, &names.invariants, rows.iter().map(|(r, _)| &r.invariants[..]), count)?.unbind(),
            observables: columns(py, &names.observables, rows.iter().map(|(_, o)| &o[..]), count)?.unbind(),
        })
    }
}

/// A motion with everything that is computed without Python's lock.
pub(crate) struct Sampled {
    motion: deltaq::Motion,
    times: Vec<f64>,
    rows: Vec<Row>,
    coordinates: Vec<String>,
    observables: Observables,
    so_far: Vec<ErrorEstimate>,
    estimate: ErrorEstimate,
    dimension: usize,
}

/// Instants at which a motion is read off unless told otherwise.
const INSTANTS: usize = 101;

impl Sampled {
    /// Reads `motion` off at those of `times` that it reached.
    pub(crate) fn new(
        mut motion: deltaq::Motion,
        setting: Setting,
        times: Option<Vec<f64>>,
    ) -> Result<Sampled, SolveError> {
        let mut times = times.unwrap_or_else(|| {
            let end = setting.end - setting.start.t;
            (0..INSTANTS).map(|i| setting.start.t + end * i as f64 / (INSTANTS - 1) as f64).collect()
        });
        times.retain(|&t| t <= motion.end());
        let (so_far, estimate) = error_estimates(&mut motion, setting, &times)?;
        let (times, so_far): (Vec<_>, _) = times.into_iter().zip(so_far).filter(|(t, _)| *t <= motion.end()).unzip();
        let mut observables = Observables::of(setting.system)?;
        let row = |&t: &f64| Ok(observed(&mut observables, t, motion.at(t)?));
        let rows = times.iter().map(row).collect::<Result<_, SolveError>>()?;
        let coordinates = setting.system.coordinates.iter().map(|c| c.name.clone()).collect();
        let dimension = setting.system.dimension();
        Ok(Sampled { motion, times, rows, coordinates, observables, so_far, estimate, dimension })
    }
}

/// One motion: the trajectory of a system under one formulation, with its error estimate.
///
/// `times` are those asked for and reached; all arrays belong to them. `at(t)` gives any other time.
#[pyclass(frozen, module = "deltaq")]
pub(crate) struct Motion {
    motion: Mutex<(deltaq::Motion, Observables)>,
    names: Names,
    dimension: usize,
    /// The system that moves.
    #[pyo3(get)]
    system: Py<System>,
    /// Names of the coordinates, length n.
    #[pyo3(get)]
    coordinate_names: Vec<String>,
    /// Name of the formulation.
    #[pyo3(get)]
    formulation: &'static str,
    /// Name of the removal, None where the formulation needs none.
    #[pyo3(get)]
    removal: Option<String>,
    /// Times, shape (k,), in the unit of time of the system.
    #[pyo3(get)]
    times: Py<PyArrayDyn<f64>>,
    /// Coordinates q at `times`, shape (k, n), in the units of the system.
    #[pyo3(get)]
    coordinates: Py<PyArrayDyn<f64>>,
    /// Velocities q' at `times`, shape (k, n), in units of the coordinates per unit of time.
    #[pyo3(get)]
    velocities: Py<PyArrayDyn<f64>>,
    /// Multipliers and costates by name, each of shape (k,).
    #[pyo3(get)]
    multipliers: Py<PyDict>,
    /// Quantities that should stay constant by name, each of shape (k,).
    #[pyo3(get)]
    invariants: Py<PyDict>,
    /// Observables of the system by name, each of shape (k,).
    #[pyo3(get)]
    observables: Py<PyDict>,
    /// Largest difference of the two runs, in the kinetic metric sqrt(dq' M dq): in practice an error bound.
    #[pyo3(get)]
    error_estimate: f64,
    /// The error estimate over the largest distance from the start.
    #[pyo3(get)]
    relative_error_estimate: f64,
    /// Largest difference of the two runs in each coordinate up to each of `times`, shape (k, n), in the
    /// units of the system: the kinetic metric hides those of little inertia.
    #[pyo3(get)]
    coordinate_error_estimates: Py<PyArrayDyn<f64>>,
    /// The same of multipliers and costates, by name, each of shape (k,).
    #[pyo3(get)]
    multiplier_error_estimates: Py<PyDict>,
    /// "completed", "untrusted" (the estimate is doubted or too large, for all or for one coordinate),
    /// "stopped".
    #[pyo3(get)]
    status: &'static str,
    /// Why the motion is not completed, else None.
    #[pyo3(get)]
    cause: Option<String>,
    /// Why the error estimate is not to be trusted, None where nothing speaks against it.
    #[pyo3(get)]
    doubt: Option<String>,
    /// Time of the start.
    #[pyo3(get)]
    start: f64,
    /// Last time at which the motion can be read off.
    #[pyo3(get)]
    end: f64,
    /// The time-stepping method and why it was taken.
    #[pyo3(get)]
    method: Option<(&'static str, String)>,
    /// Name of the form of the equations that was integrated, and why.
    #[pyo3(get)]
    form: (&'static str, String),
    /// Times from which the motion went on by "multipliers" or by "canonical momenta", because pivots became
    /// small.
    #[pyo3(get)]
    charts: Vec<(f64, &'static str)>,
    /// Values of the free constants, by name.
    #[pyo3(get)]
    constants: Py<PyDict>,
    /// What the kept run cost: steps, rejected, evaluations, jacobians, orders (of Taylor series, summed).
    #[pyo3(get)]
    work: Py<PyDict>,
    /// What the projections moved: count, largest, total (Euclidean lengths of changes of the velocities).
    #[pyo3(get)]
    projection: Py<PyDict>,
    /// Wall-clock seconds: derive, compile, integrate.
    #[pyo3(get)]
    seconds: Py<PyDict>,
}

/// What a run cost, by name.
pub(crate) fn work(py: Python<'_>, work: &Work) -> PyResult<Py<PyDict>> {
    let Work { steps, rejected, evaluations, jacobians, orders, .. } = *work;
    let items = [
        ("steps", steps),
        ("rejected", rejected),
        ("evaluations", evaluations),
        ("jacobians", jacobians),
        ("orders", orders),
    ];
    Ok(items.into_py_dict(py)?.unbind())
}

impl Motion {
    pub(crate) fn new(system: &Bound<'_, System>, sampled: Sampled) -> PyResult<Motion> {
        let py = system.py();
        let Sampled { motion, times, rows, coordinates: coordinate_names, observables: program, .. } = sampled;
        let Sampled { so_far, estimate, dimension, .. } = sampled;
        let names = Names::of(&motion.equations, &program);
        let count = Some(times.len());
        let Outputs { coordinates, velocities, multipliers, invariants, observables } =
            Outputs::new(py, &rows, dimension, &names, count)?;
        let (status, cause) = estimate.status(&motion);
        let coordinate_errors = so_far.iter().flat_map(|e| e.coordinates.clone()).collect();
        let multiplier_errors = so_far.iter().map(|e| &e.multipliers[..]);
        let constants = constant_names(&motion.equations).into_iter().zip(motion.constants.iter().copied());
        let projection = PyDict::new(py);
        projection.set_item("count", motion.projection.projections)?;
        projection.set_item("largest", motion.projection.largest)?;
        projection.set_item("total", motion.projection.total)?;
        let Seconds { derive, compile, integrate } = motion.seconds;
        let seconds = [("derive", derive), ("compile", compile), ("integrate", integrate)];
        Ok(Motion {
            dimension,
            system: system.clone().unbind(),
            coordinate_names,
            formulation: motion.equations.formulation,
            removal: motion.equations.removal.as_ref().map(|r| r.name.clone()),
            times: array(py, times, count, &[])?.unbind(),
            coordinates,
            velocities,
            multipliers,
            invariants,
            observables,
            error_estimate: estimate.absolute,
            relative_error_estimate: estimate.relative,
            coordinate_error_estimates: array(py, coordinate_errors, count, &[dimension])?.unbind(),
            multiplier_error_estimates: columns(py, &names.multipliers, multiplier_errors, count)?.unbind(),
            status,
            cause,
            doubt: motion.doubt.as_ref().map(|doubt| doubt.because.clone()),
            start: motion.start(),
            end: motion.end(),
            method: motion.method.as_ref().map(|chosen| (chosen.method.name(), chosen.why.clone())),
            form: (motion.form.chosen.name, motion.form.chosen.why.clone()),
            charts: motion.charts.iter().map(|chart| (chart.t, chart.by)).collect(),
            constants: constants.into_py_dict(py)?.unbind(),
            work: work(py, &motion.work)?,
            projection: projection.unbind(),
            seconds: seconds.into_py_dict(py)?.unbind(),
            names,
            motion: Mutex::new((motion, program)),
        })
    }
}

#[pymethods]
impl Motion {
    /// Everything at time t, read off the dense output (order 7 for dop853).
    ///
    /// t is a number or of shape (k,), from start to end; ValueError elsewhere.
    #[pyo3(signature = (t))]
    fn at(&self, py: Python<'_>, t: Floats<'_>) -> PyResult<Outputs> {
        let t = times(&t)?;
        let instants: Vec<f64> = (0..t.count().unwrap_or(1)).map(|i| t.row(i)[0]).collect();
        if let Some(outside) = instants.iter().find(|&t| !(self.start..=self.end).contains(t)) {
            let (start, end) = (self.start, self.end);
            return Err(PyValueError::new_err(format!("t = {outside} is outside of the motion, {start} to {end}")));
        }
        let rows = {
            let (motion, program) = &mut *self.motion.lock().unwrap_or_else(PoisonError::into_inner);
            let row = |&t: &f64| Ok(observed(program, t, motion.at(t)?));
            instants.iter().map(row).collect::<Result<Vec<_>, SolveError>>().map_err(errors::solve)?
        };
        Outputs::new(py, &rows, self.dimension, &self.names, t.count())
    }

    fn __repr__(&self) -> String {
        let Motion { formulation, start, end, status, error_estimate, .. } = self;
        format!("<deltaq.Motion {formulation}, t = {start} to {end}, {status}, error estimate {error_estimate:.1e}>")
    }
}
