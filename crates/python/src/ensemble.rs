//! Many motions of one system at once.

use std::collections::BTreeMap;

use equations::Named;
use motion::band::CHUNK;
use motion::{Choice, EnsembleOptions, MemberMotion, Settings, SolveError, setting};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::Scene;
use stubs::{answer, stubbed};

use crate::arrays::{Floats, fixed, list, times, vector, within};
use crate::system::System;

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
            let array: Floats = array.extract()?;
            values.insert(name.clone(), list(&name, &array)?);
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

    /// A multiplier that varies.
    pub(crate) fn multiplier(&self, scene: &Scene) -> Option<String> {
        scene.multiplier_names().into_iter().find(|name| self.values.contains_key(name))
    }

    fn row(&self, member: usize) -> Vec<f64> {
        self.values.values().map(|values| values[member]).collect()
    }
}

/// What is to be integrated.
pub(crate) struct Task {
    pub(crate) varied: Varied,
    pub(crate) scene: Scene,
    pub(crate) choice: Choice,
    pub(crate) instants: Instants,
    pub(crate) settings: Settings,
    pub(crate) options: EnsembleOptions,
}

/// Everything that is computed without Python's lock.
pub(crate) struct Integrated {
    varied: Varied,
    instants: Instants,
    names: Vec<String>,
    choice: Choice,
    done: Columns,
}

/// What became of the members so far.
#[derive(Default)]
struct Columns {
    coordinates: Cube,
    velocities: Cube,
    multipliers: (Vec<String>, Cube),
    invariants: (Vec<String>, Cube),
    error_estimate: Vec<f64>,
    relative_error_estimate: Vec<f64>,
    status: Vec<String>,
    cause: Vec<Option<String>>,
    reached: Vec<usize>,
    alone: Vec<Option<String>>,
    seconds: f64,
}

/// Numbers of members, times and columns; NaN where there is none.
#[derive(Default)]
struct Cube {
    times: usize,
    width: usize,
    values: Vec<f64>,
}

impl Cube {
    fn new(members: usize, times: usize, width: usize) -> Cube {
        Cube { times, width, values: Vec::with_capacity(members * times * width) }
    }

    /// The next member.
    fn add<'a>(&mut self, rows: impl Iterator<Item = &'a [f64]>) {
        let end = self.values.len() + self.times * self.width;
        rows.for_each(|row| self.values.extend(row));
        self.values.resize(end, f64::NAN);
    }

    /// Columns by name, each of the shape (members, *times).
    fn columns<'py>(self, py: Python<'py>, names: &[String], times: Option<usize>) -> PyResult<Bound<'py, PyDict>> {
        let (dict, members) = (PyDict::new(py), self.values.len() / (self.times * self.width).max(1));
        let tail: Vec<usize> = times.into_iter().collect();
        for (i, name) in names.iter().enumerate() {
            let column = self.values.iter().skip(i).step_by(self.width).copied().collect();
            dict.set_item(name, fixed(py, column, Some(members), &tail)?)?;
        }
        Ok(dict)
    }
}

/// The times at which a run is read off: one, or ascending ones.
#[derive(Clone)]
pub(crate) struct Instants {
    pub(crate) values: Vec<f64>,
    /// How many there are; `None` of one that was given as a number.
    pub(crate) count: Option<usize>,
    /// The end of the run: the last of them or, of a single start, that of the scene.
    pub(crate) end: f64,
}

impl Instants {
    /// The end of a scene.
    pub(crate) fn end_of(scene: &Scene) -> Instants {
        let end = setting(scene).end;
        Instants { values: vec![end], count: Some(1), end }
    }

    /// Those of a run from `start` on, for a scene.
    pub(crate) fn read(given: &Floats<'_>, start: f64, scene: &Scene) -> PyResult<Instants> {
        let given = times("times", given)?;
        let refused = |text: String| Err(PyValueError::new_err(format!("times{text}")));
        if let Some(pair) = given.values().windows(2).find(|pair| pair[1] < pair[0]) {
            return refused(format!(": {} comes after {}; ascending order is needed", pair[1], pair[0]));
        }
        let reached: Option<Vec<f64>> = given.values().iter().map(|&t| within(t, start, f64::INFINITY)).collect();
        let Some(values) = reached else {
            return refused(format!(" contains {}, before the start {start}", given.values()[0]));
        };
        let end = values.last().copied().filter(|&t| t > start).unwrap_or(setting(scene).end);
        Ok(Instants { values, count: given.count(), end })
    }
}

impl Task {
    pub(crate) fn run(self) -> Result<Integrated, SolveError> {
        let Task { varied, scene, choice, instants, settings, options } = self;
        let times = &instants.values;
        let names: Vec<&str> = varied.values.keys().map(String::as_str).collect();
        let ensemble = motion::Ensemble::new(&scene, &choice, &names, &settings)?.until(instants.end);
        let (equations, n) = (ensemble.equations(), scene.system.dimension());
        let cube = |width: usize| Cube::new(varied.count, times.len(), width);
        let named = |list: &[Named]| (list.iter().map(|n| n.name.clone()).collect(), cube(list.len()));
        let mut done = Columns {
            coordinates: cube(n),
            velocities: cube(n),
            multipliers: named(&equations.multipliers),
            invariants: named(&equations.invariants),
            ..Columns::default()
        };
        for first in (0..varied.count).step_by(CHUNK) {
            let rows: Vec<Vec<f64>> = (first..varied.count.min(first + CHUNK)).map(|i| varied.row(i)).collect();
            let members = ensemble.members(&rows, options.threads);
            let (motions, seconds) = ensemble.timed_answers(members, times, &options);
            done.seconds += seconds;
            motions.into_iter().for_each(|motion| done.add(motion));
        }
        let names = scene.system.coordinates.iter().map(|c| c.name.clone()).collect();
        Ok(Integrated { varied, instants, names, choice, done })
    }
}

impl Columns {
    /// The next member.
    fn add(&mut self, motion: Result<MemberMotion, String>) {
        let (motion, refused) = motion.map_or_else(|cause| (None, Some(cause)), |motion| (Some(motion), None));
        let outputs = motion.as_ref().map_or(&[][..], |motion| &motion.outputs);
        self.coordinates.add(outputs.iter().map(|o| &o.coordinates[..]));
        self.velocities.add(outputs.iter().map(|o| &o.velocities[..]));
        self.multipliers.1.add(outputs.iter().map(|o| &o.multipliers[..]));
        self.invariants.1.add(outputs.iter().map(|o| &o.invariants[..]));
        self.reached.push(outputs.len());
        let estimate = motion.as_ref().and_then(|motion| motion.estimate.as_ref());
        self.error_estimate.push(estimate.map_or(f64::NAN, |estimate| estimate.absolute));
        self.relative_error_estimate.push(estimate.map_or(f64::NAN, |estimate| estimate.relative));
        let (status, cause) = motion.as_ref().map_or(("refused", refused), MemberMotion::status);
        self.status.push(status.into());
        self.cause.push(cause);
        self.alone.push(motion.and_then(|motion| motion.run.alone));
    }
}

#[answer]
pub(crate) struct Ensemble;

impl Ensemble {
    pub(crate) fn new(system: &Bound<'_, System>, integrated: Integrated) -> PyResult<Ensemble> {
        let py = system.py();
        let Integrated { varied: Varied { values, count: m }, instants, names, choice, done } = integrated;
        let k = instants.count;
        let tail = |width: usize| k.into_iter().chain([width]).collect::<Vec<_>>();
        let cube = |cube: Cube| fixed(py, cube.values, Some(m), &tail(cube.width)).map(Bound::unbind);
        let varied = PyDict::new(py);
        for (name, values) in values {
            varied.set_item(name, vector(py, values)?)?;
        }
        Ok(Ensemble {
            system: system.clone().unbind(),
            formulation: choice.formulation.name.into(),
            removal: choice.removal.map(|removal| removal.name),
            times: fixed(py, instants.values, k, &[])?.unbind(),
            varied: varied.unbind(),
            coordinate_names: names,
            coordinates: cube(done.coordinates)?,
            velocities: cube(done.velocities)?,
            multipliers: done.multipliers.1.columns(py, &done.multipliers.0, k)?.unbind(),
            invariants: done.invariants.1.columns(py, &done.invariants.0, k)?.unbind(),
            error_estimate: vector(py, done.error_estimate)?,
            relative_error_estimate: vector(py, done.relative_error_estimate)?,
            status: done.status,
            cause: done.cause,
            reached: done.reached,
            alone: done.alone,
            seconds: done.seconds,
        })
    }
}

#[stubbed]
impl Ensemble {
    fn __len__(&self) -> usize {
        self.status.len()
    }

    fn __repr__(&self) -> String {
        let completed = self.status.iter().filter(|status| **status == "completed").count();
        format!("<deltaq.Ensemble {}, {completed} of {} members completed>", self.formulation, self.status.len())
    }
}
