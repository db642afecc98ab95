//! Many motions of one system at once.

use std::collections::BTreeMap;

use deltaq::{
    Choice, EnsembleOptions, EnsembleStart, MemberMotion, Settings, SolveError, constants_of, over_threads, setting,
};
use equations::Outputs;
use integrate::Interrupt;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::{Scene, SceneError, SceneErrorKind};

use crate::arrays::{FloatList, array, finite};
use crate::errors;

/// What varies over the members of an ensemble: names, each with as many values as there are members.
pub(crate) struct Varied {
    values: BTreeMap<String, Vec<f64>>,
    count: usize,
}

impl Varied {
    pub(crate) fn read(given: &Bound<'_, PyDict>) -> PyResult<Varied> {
        let mut values = BTreeMap::new();
        for (name, array) in given {
            let name: String = name.extract()?;
            if name == "time" || name == "duration" {
                return Err(PyValueError::new_err(format!("{name} is the same for all members")));
            }
            let array: FloatList = array.extract()?;
            values.insert(name.clone(), finite(&name, array.as_array().iter().copied().collect())?);
        }
        let mut all = values.iter();
        let Some((first, count)) = all.next().map(|(name, values)| (name, values.len())) else {
            return Err(PyValueError::new_err("vary is empty; it needs an array for something that varies"));
        };
        match all.find(|(_, values)| values.len() != count) {
            Some((name, other)) => {
                let other = other.len();
                Err(PyValueError::new_err(format!("vary: {first} has {count} values, {name} has {other}")))
            }
            None if count == 0 => Err(PyValueError::new_err(format!("vary: {first} has no values"))),
            None => Ok(Varied { values, count }),
        }
    }

    fn row(&self, member: usize) -> impl Iterator<Item = (String, f64)> {
        self.values.iter().map(move |(name, values)| (name.clone(), values[member]))
    }
}

/// What is to be integrated.
pub(crate) struct Task<'a> {
    pub(crate) varied: Varied,
    pub(crate) scene: Scene,
    /// The scene with overrides in the place of some of its numbers.
    pub(crate) with: &'a (dyn Fn(Vec<(String, f64)>) -> Result<Scene, SceneError> + Sync),
    pub(crate) choice: Choice,
    /// The constants of `choice` are those of all members, whatever their multipliers are.
    pub(crate) given: bool,
    pub(crate) times: Vec<f64>,
    pub(crate) end: f64,
    pub(crate) settings: Settings,
    pub(crate) threads: usize,
}

/// Why there is no ensemble.
pub(crate) enum Refused {
    Scene(Box<SceneError>),
    Solve(SolveError),
}

/// Everything that is computed without Python's lock.
pub(crate) struct Integrated {
    varied: Varied,
    times: Vec<f64>,
    motions: Vec<Result<MemberMotion, String>>,
    coordinates: usize,
    multipliers: Vec<String>,
    invariants: Vec<String>,
    choice: Choice,
}

/// The times at which a run is read off, ascending, from the start on, by default the end; and the end.
pub(crate) fn times(given: Option<FloatList<'_>>, scene: &Scene) -> PyResult<(Vec<f64>, f64)> {
    let end = setting(scene).end;
    let Some(given) = given else { return Ok((vec![end], end)) };
    let times = finite("times", given.as_array().iter().copied().collect())?;
    let start = scene.start.t;
    if let Some(early) = times.iter().find(|&&t| t < start) {
        return Err(PyValueError::new_err(format!("times contains {early}, before the start {start}")));
    }
    match times.windows(2).find(|pair| pair[1] < pair[0]) {
        Some(pair) => {
            Err(PyValueError::new_err(format!("times: {} comes after {}; ascending order is needed", pair[1], pair[0])))
        }
        None => {
            let end = times.last().copied().filter(|&t| t > start).unwrap_or(end);
            Ok((times, end))
        }
    }
}

impl Task<'_> {
    pub(crate) fn run(self) -> Result<Integrated, Refused> {
        let Task { varied, scene, with, choice, given, times, end, settings, threads } = self;
        let graph = &scene.system.graph;
        let names: Vec<String> = scene.system.parameters.iter().map(|p| graph.name(p.symbol)).collect();
        let parameters: Vec<&str> =
            varied.values.keys().map(String::as_str).filter(|n| names.iter().any(|p| p == n)).collect();
        let interrupted = || settings.interrupt.as_ref().is_some_and(Interrupt::is_raised);
        let starts = over_threads(threads, varied.count, |i| {
            if interrupted() {
                return Ok(Err(integrate::StopCause::Interrupted.to_string()));
            }
            match with(varied.row(i).collect()) {
                Ok(scene) => {
                    let constants = if given { choice.constants.clone() } else { constants_of(&choice, &scene) };
                    Ok(Ok(EnsembleStart { end, ..EnsembleStart::of(&scene, &parameters, constants) }))
                }
                Err(error) if error.line == 0 && matches!(*error.kind, SceneErrorKind::UnknownName { .. }) => {
                    Err(Refused::Scene(Box::new(error)))
                }
                Err(error) => Ok(Err(error.kind.to_string())),
            }
        });
        let starts = starts.into_iter().collect::<Result<Vec<_>, Refused>>()?;
        let ensemble = deltaq::Ensemble::new(&scene, &choice, &parameters, &settings).map_err(Refused::Solve)?;
        let motions = ensemble.answers(&starts, &times, &EnsembleOptions { threads, estimate: true });
        let equations = ensemble.equations();
        let named = |list: &[equations::Named]| list.iter().map(|n| n.name.clone()).collect();
        Ok(Integrated {
            coordinates: scene.system.dimension(),
            multipliers: named(&equations.multipliers),
            invariants: named(&equations.invariants),
            varied,
            times,
            motions,
            choice,
        })
    }
}

/// Motions of m members of one system: different starts or parameters, one formulation.
///
/// `times` are those asked for; all arrays belong to members and times. What a member did not reach is NaN:
/// `reached` counts the times that it did, `status` and `cause` say why.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Ensemble {
    /// Name of the formulation.
    formulation: &'static str,
    /// Name of the removal, None where the formulation needs none.
    removal: Option<String>,
    /// Times, shape (k,), in the unit of time of the system.
    times: Py<PyArrayDyn<f64>>,
    /// What varies, by name, each of shape (m,).
    varied: Py<PyDict>,
    /// Coordinates q, shape (m, k, n), in the units of the system.
    coordinates: Py<PyArrayDyn<f64>>,
    /// Velocities q', shape (m, k, n), in units of the coordinates per unit of time.
    velocities: Py<PyArrayDyn<f64>>,
    /// Multipliers and costates by name, each of shape (m, k).
    multipliers: Py<PyDict>,
    /// Quantities that should stay constant by name, each of shape (m, k).
    invariants: Py<PyDict>,
    /// Largest difference of the two runs of each member at these times, in the kinetic metric, shape (m,).
    error_estimate: Py<PyArrayDyn<f64>>,
    /// The error estimate over the largest distance from the start at these times, shape (m,).
    relative_error_estimate: Py<PyArrayDyn<f64>>,
    /// Per member "completed", "untrusted" (too large an error estimate), "stopped" or "refused" (no motion).
    status: Vec<&'static str>,
    /// Of each member why it is not completed, else None.
    cause: Vec<Option<String>>,
    /// Of each member how many of the times it reached.
    reached: Vec<usize>,
    /// Of each member why it was integrated alone and not in company, else None: slower, and no worse.
    alone: Vec<Option<String>>,
}

impl Ensemble {
    pub(crate) fn new(py: Python<'_>, integrated: Integrated) -> PyResult<Ensemble> {
        let Integrated { varied, times, motions, coordinates, multipliers, invariants, choice } = integrated;
        let (m, k) = (motions.len(), times.len());
        let cube = |width: usize, pick: fn(&Outputs) -> &[f64]| -> Vec<f64> {
            let mut values = vec![f64::NAN; m * k * width];
            for (member, motion) in motions.iter().enumerate() {
                for (instant, outputs) in motion.iter().flat_map(|motion| &motion.outputs).enumerate() {
                    let first = (member * k + instant) * width;
                    values[first..first + width].copy_from_slice(pick(outputs));
                }
            }
            values
        };
        let columns = |names: &[String], pick: fn(&Outputs) -> &[f64]| -> PyResult<Py<PyDict>> {
            let (dict, values) = (PyDict::new(py), cube(names.len(), pick));
            for (i, name) in names.iter().enumerate() {
                let column = values.iter().skip(i).step_by(names.len()).copied().collect();
                dict.set_item(name, array(py, column, Some(m), &[k])?)?;
            }
            Ok(dict.unbind())
        };
        let estimates = |pick: fn(&deltaq::ErrorEstimate) -> f64| {
            let of = |motion: &Result<MemberMotion, String>| {
                motion.as_ref().ok().and_then(|motion| motion.estimate.as_ref().map(pick)).unwrap_or(f64::NAN)
            };
            array(py, motions.iter().map(of).collect(), Some(m), &[]).map(Bound::unbind)
        };
        let outcome = |motion: &Result<MemberMotion, String>| match motion {
            Ok(motion) => motion.status(),
            Err(cause) => ("refused", Some(cause.clone())),
        };
        let (status, cause) = motions.iter().map(outcome).unzip();
        let dict = PyDict::new(py);
        for (name, values) in varied.values {
            dict.set_item(name, array(py, values, Some(m), &[])?)?;
        }
        Ok(Ensemble {
            formulation: choice.formulation,
            removal: choice.removal.as_ref().map(|removal| removal.name.clone()),
            varied: dict.unbind(),
            coordinates: array(py, cube(coordinates, |o| &o.coordinates), Some(m), &[k, coordinates])?.unbind(),
            velocities: array(py, cube(coordinates, |o| &o.velocities), Some(m), &[k, coordinates])?.unbind(),
            multipliers: columns(&multipliers, |o| &o.multipliers)?,
            invariants: columns(&invariants, |o| &o.invariants)?,
            error_estimate: estimates(|estimate| estimate.absolute)?,
            relative_error_estimate: estimates(|estimate| estimate.relative)?,
            status,
            cause,
            reached: motions.iter().map(|motion| motion.as_ref().map_or(0, |m| m.outputs.len())).collect(),
            alone: motions.iter().map(|motion| motion.as_ref().ok().and_then(|m| m.run.alone.clone())).collect(),
            times: array(py, times, Some(k), &[])?.unbind(),
        })
    }
}

#[pymethods]
impl Ensemble {
    fn __len__(&self) -> usize {
        self.status.len()
    }

    fn __repr__(&self) -> String {
        let completed = self.status.iter().filter(|status| **status == "completed").count();
        format!("<deltaq.Ensemble {}, {completed} of {} members completed>", self.formulation, self.status.len())
    }
}

/// An exception for what refuses all members.
pub(crate) fn refused(py: Python<'_>, refused: Refused) -> PyErr {
    match refused {
        Refused::Scene(error) => errors::scene(py, &error),
        Refused::Solve(error) => errors::solve(error),
    }
}
