//! Motions, read off at many times.

use std::sync::{Arc, OnceLock};

use integrate::{Method, Projection, Work};
use mechanics::Observables;
use motion::{
    Choice, ErrorEstimate, Seconds, Sensitivities, Setting, Settings, SolveError, constant_names, error_estimates,
};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use stubs::{answer, stubbed};

use crate::arguments::rule_value;
use crate::arrays::{Floats, columns, fixed, times, within};
use crate::ensemble::Instants;
use crate::outputs::{Names, Outputs, Row, observed};
use crate::shared::Shared;
use crate::system::System;
use crate::{errors, sensitivities};

/// A motion with everything that is computed without Python's lock.
pub(crate) struct Sampled {
    motion: motion::Motion,
    times: Vec<f64>,
    /// How many these are; `None` of one that was given as a number.
    count: Option<usize>,
    /// One at each of the times that were reached.
    rows: Vec<Row>,
    coordinates: Vec<String>,
    observables: Observables,
    so_far: Vec<ErrorEstimate>,
    estimate: ErrorEstimate,
    dimension: usize,
    /// Derivatives, where they were asked for.
    pub(crate) derived: Option<Sensitivities>,
}

/// Instants at which a motion is read off unless told otherwise.
const INSTANTS: usize = 101;

impl Sampled {
    /// Reads `motion` off at those of `times`, in ascending order, that it reached.
    pub(crate) fn new(
        mut motion: motion::Motion,
        setting: Setting,
        instants: Option<Instants>,
    ) -> Result<Sampled, SolveError> {
        let (from, length) = (setting.start.t, setting.end - setting.start.t);
        let instant = |i: usize| from + length * i as f64 / (INSTANTS - 1) as f64;
        let (times, count) = instants.map_or_else(
            || ((0..INSTANTS).map(instant).collect(), Some(INSTANTS)),
            |instants| (instants.values, instants.count),
        );
        let reached = |motion: &motion::Motion| -> Vec<f64> {
            times.iter().map_while(|&t| within(t, motion.start(), motion.end())).collect::<Vec<f64>>()
        };
        let asked = reached(&motion);
        let (mut so_far, estimate) = error_estimates(&mut motion, setting, &asked)?;
        let reached = reached(&motion);
        so_far.truncate(reached.len());
        let mut observables = Observables::of(setting.system)?;
        let row = |&t: &f64| Ok(observed(&mut observables, t, motion.at(t)?));
        let rows = reached.iter().map(row).collect::<Result<_, SolveError>>()?;
        let coordinates = setting.system.coordinates.iter().map(|c| c.name.clone()).collect();
        let dimension = setting.system.dimension();
        Ok(Sampled { motion, times, count, rows, coordinates, observables, so_far, estimate, dimension, derived: None })
    }

    /// The times that were reached.
    pub(crate) fn reached(&self) -> &[f64] {
        &self.times[..self.rows.len()]
    }
}

/// What a motion was asked by: it is asked by it again where one that was pickled is read off.
pub(crate) struct Asked<'a> {
    pub(crate) choice: &'a Choice,
    pub(crate) form: &'a str,
    pub(crate) times: Option<&'a [f64]>,
    pub(crate) settings: &'a Settings,
}

impl Asked<'_> {
    /// As arguments of `System.solve`. Where seconds ended the motion, the same number of them may lead
    /// elsewhere: it is then asked for up to the end that it came to.
    fn arguments<'py>(&self, py: Python<'py>, end: f64, is_complete: bool) -> PyResult<Bound<'py, PyDict>> {
        let Asked { choice, form, times, settings } = self;
        let arguments = PyDict::new(py);
        arguments.set_item("formulation", choice.formulation.name)?;
        arguments.set_item("removal", choice.removal.as_ref().map(|removal| &removal.name))?;
        arguments.set_item("constants", rule_value(py, &choice.constants)?)?;
        arguments.set_item("form", form)?;
        arguments.set_item("method", settings.method.map_or("auto", Method::name))?;
        arguments.set_item("tolerance", settings.tolerance)?;
        arguments.set_item("project", settings.projection == Projection::EveryStep)?;
        arguments.set_item("max_steps", settings.max_steps)?;
        arguments.set_item("max_step", Some(settings.max_step).filter(|step| step.is_finite()))?;
        let last = times.and_then(|times| times.last().copied());
        let last = if settings.time_limit.is_some() && !is_complete { Some(end) } else { last };
        arguments.set_item("times", last.map(|t| vec![t]))?;
        Ok(arguments)
    }
}

#[answer("<deltaq.Motion {formulation}, t = {start} to {end}, {status}, error estimate {error_estimate:.1e}>")]
pub(crate) struct Motion {
    /// None of one that was pickled, until it is read off.
    motion: OnceLock<Arc<Integrated>>,
}

/// A motion, and the program of what is observed in it.
type Integrated = Shared<(motion::Motion, Observables)>;

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
    pub(crate) fn new(system: &Bound<'_, System>, sampled: Sampled, asked: &Asked<'_>) -> PyResult<Motion> {
        let py = system.py();
        let Sampled { motion, times, count, rows, coordinates: coordinate_names, observables: program, .. } = sampled;
        let Sampled { so_far, estimate, dimension, derived, .. } = sampled;
        let names = Names::of(&motion.equations, &program);
        let Outputs { coordinates, velocities, multipliers, invariants, observables } =
            Outputs::new(py, &rows, dimension, &names, count)?;
        let (status, cause) = estimate.status(&motion);
        let [sensitivities, sensitivity_error_estimates] = sensitivities::tables(py, derived, dimension, count)?;
        let table = |of: fn(&ErrorEstimate) -> &[f64]| {
            let mut errors: Vec<f64> = so_far.iter().flat_map(|e| of(e).to_vec()).collect();
            errors.resize(times.len() * dimension, f64::NAN);
            errors
        };
        let [coordinate_errors, velocity_errors] = [table(|e| &e.coordinates), table(|e| &e.velocities)];
        let multiplier_errors = so_far.iter().map(|e| &e.multipliers[..]);
        let constants = constant_names(&motion.equations).into_iter().zip(motion.constants.iter().copied());
        let projection = PyDict::new(py);
        projection.set_item("count", motion.projection.projections)?;
        projection.set_item("largest", motion.projection.largest)?;
        projection.set_item("total", motion.projection.total)?;
        let Seconds { derive, compile, integrate } = motion.seconds;
        let seconds = [("derive", derive), ("compile", compile), ("integrate", integrate)];
        Ok(Motion {
            _asked: asked.arguments(py, motion.end(), motion.is_complete())?.unbind(),
            reached: rows.len(),
            system: system.clone().unbind(),
            coordinate_names,
            formulation: motion.equations.formulation.into(),
            removal: motion.equations.removal.as_ref().map(|r| r.name.clone()),
            times: fixed(py, times, count, &[])?.unbind(),
            coordinates,
            velocities,
            multipliers,
            invariants,
            observables,
            error_estimate: estimate.absolute,
            relative_error_estimate: estimate.relative,
            coordinate_error_estimates: fixed(py, coordinate_errors, count, &[dimension])?.unbind(),
            velocity_error_estimates: fixed(py, velocity_errors, count, &[dimension])?.unbind(),
            multiplier_error_estimates: columns(py, &names.multipliers, multiplier_errors, count)?.unbind(),
            sensitivities,
            sensitivity_error_estimates,
            status: status.into(),
            cause,
            doubt: motion.doubt.as_ref().map(|doubt| doubt.because.clone()),
            start: motion.start(),
            end: motion.end(),
            method: motion.method.as_ref().map(|chosen| (chosen.method.name().into(), chosen.why.clone())),
            form: (motion.form.chosen.name.into(), motion.form.chosen.why.clone()),
            charts: motion.charts.iter().map(|chart| (chart.t, chart.by.into())).collect(),
            constants: constants.into_py_dict(py)?.unbind(),
            work: work(py, &motion.work)?,
            projection: projection.unbind(),
            seconds: seconds.into_py_dict(py)?.unbind(),
            motion: OnceLock::from(Arc::new(Shared::new((motion, program)))),
        })
    }
}

impl Motion {
    /// What is read off; of a motion that was pickled it is integrated anew.
    fn integrated(&self, py: Python<'_>) -> PyResult<&Integrated> {
        if self.motion.get().is_none() {
            let again = self.system.bind(py).call_method("solve", (), Some(self._asked.bind(py)))?;
            let again = again.cast_into::<Motion>()?;
            let Motion { motion, end, .. } = again.get();
            if within(self.end, self.start, *end).is_none() {
                let text = format!("integrated anew, the motion ends at {end} and not at {}", self.end);
                return Err(errors::EvaluationError::new_err(text));
            }
            motion.get().cloned().into_iter().for_each(|motion| drop(self.motion.set(motion)));
        }
        self.motion.get().map(|motion| &**motion).ok_or_else(|| PyRuntimeError::new_err("the motion was not kept"))
    }
}

#[stubbed]
impl Motion {
    fn at(&self, py: Python<'_>, t: Floats<'_>) -> PyResult<Outputs> {
        let (t, start, end) = (times("t", &t)?, self.start, self.end);
        let inside = |i| {
            let t = t.row(i)[0];
            let outside = || PyValueError::new_err(format!("t = {t} is outside of the motion, {start} to {end}"));
            within(t, start, end).ok_or_else(outside)
        };
        let instants: Vec<f64> = (0..t.count().unwrap_or(1)).map(inside).collect::<PyResult<_>>()?;
        let integrated = self.integrated(py)?;
        let read = |(motion, program): &mut (motion::Motion, Observables)| {
            let row = |&t: &f64| Ok(observed(program, t, motion.at(t)?));
            let rows = instants.iter().map(row).collect::<Result<Vec<_>, SolveError>>()?;
            Ok((rows, Names::of(&motion.equations, program)))
        };
        let (rows, names) = py.detach(|| integrated.with(read))?.map_err(|error: SolveError| errors::solve(error))?;
        Outputs::new(py, &rows, self.coordinate_names.len(), &names, t.count())
    }

    /// The motion with these fields, read off as this one is.
    fn _with(&self, state: &Bound<'_, PyDict>) -> PyResult<Motion> {
        Ok(Motion { motion: self.motion.clone(), ..Motion::_again(&state.py().get_type::<Motion>(), state)? })
    }
}
