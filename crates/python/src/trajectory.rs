//! One run of the time loop from Python.

use std::time::Instant;

use integrate::{Dense, Options, Status};
use motion::{Prepared, SolveError};
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::Numbers;
use crate::arrays::{Floats, fixed, list, within};
use crate::equations::Equations;
use crate::kept::kept;
use crate::motion::work;
use crate::{arguments, background, ensemble, errors};

/// One run of the time loop, without a second one: only its tolerance tells anything of its error.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Trajectory {
    /// The times asked for, shape (k,).
    times: Py<PyArrayDyn<f64>>,
    /// States y at `times`, shape (k, m); `Equations.outputs` reads coordinates and all else off them.
    states: Py<PyArrayDyn<f64>>,
    /// How many of the times it reached: from there on the states are NaN.
    reached: usize,
    /// "completed" or "stopped".
    status: String,
    /// Why the run stopped, None where it is complete.
    cause: Option<String>,
    /// What the run cost, as in `Motion.work`.
    work: Py<PyDict>,
    /// Wall-clock seconds of the run and of reading the states off.
    seconds: f64,
}

kept!(Trajectory: times states reached status cause work seconds);

#[pymethods]
impl Trajectory {
    fn __repr__(&self) -> String {
        format!("<deltaq.Trajectory {}, {} s>", self.status, self.seconds)
    }
}

#[pymethods]
impl Equations {
    /// One run of the time loop from the start of the system to the last of `times`, shape (k,), in ascending
    /// order: half of what `System.solve` does, for those who know the error from elsewhere.
    ///
    /// y0: the state to start from, shape (m,). parameters: name to number, for this run; without y0 the
    /// start follows, as of `System.replace`. constants, mu0: the free constants of this run, as in
    /// `solve`. The first use of parameters of some names compiles equations that have them as inputs; then
    /// a call costs the run. method: one of METHODS; its first run compiles what it needs. tolerance:
    /// relative and absolute. project, max_steps, max_step, time_limit: as in `System.solve`. For the start
    /// and the last time alone nothing else is kept.
    ///
    /// Other threads go on; Ctrl-C ends it. SolveError without a run; `status` says if it stops early.
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (times, *, y0=None, parameters=None, constants=None, mu0=None, method="auto", tolerance=1e-11, project=true, max_steps=1_000_000, max_step=None, time_limit=None))]
    fn integrate(
        &self,
        py: Python<'_>,
        times: Floats<'_>,
        y0: Option<Floats<'_>>,
        parameters: Option<Numbers>,
        constants: Option<Bound<'_, PyAny>>,
        mu0: Option<Floats<'_>>,
        method: &str,
        tolerance: f64,
        project: bool,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
    ) -> PyResult<Trajectory> {
        let (settings, interrupt) = arguments::settings(method, tolerance, project, max_steps, max_step, time_limit)?;
        let rule = arguments::constants(constants.as_ref(), mu0)?;
        let y0 = y0.map(|y0| list("y0", &y0)).transpose()?;
        let width = self.states.len();
        if let Some(found) = y0.as_ref().map(Vec::len).filter(|found| *found != width) {
            return Err(PyValueError::new_err(format!("y0 has {found} entries; {width} are needed")));
        }
        let (scene, _) = self.at_run_time.scene_and_choice()?;
        let (begin, (times, end)) = (scene.start.t, ensemble::times(&times, &scene)?);
        let is_end = |&t: &f64| t == begin || t == end;
        let mut options = Options {
            projection: settings.projection,
            max_steps,
            max_step: settings.max_step,
            dense: if times.iter().all(is_end) { Dense::EndOnly } else { Dense::Everywhere },
            wanted: Some(times.clone().into()),
            interrupt: Some(time_limit.map_or(interrupt.clone(), |seconds| interrupt.within(seconds))),
            ..Options::with_tolerance(tolerance)
        };
        let run = |ready: &mut Prepared| -> Result<_, SolveError> {
            options.method = settings.method.unwrap_or(ready.method.method);
            ready.complete(options.method)?;
            let clock = Instant::now();
            let run = ready.integrate(end, &options)?;
            let reached: Vec<f64> = times.iter().map_while(|&t| within(t, begin, run.end())).collect();
            let mut states = vec![f64::NAN; width * times.len()];
            for (&t, row) in reached.iter().zip(states.chunks_exact_mut(width)) {
                run.states_at(&mut ready.compiled, t, row)?;
            }
            Ok((run, reached.len(), states, clock.elapsed().as_secs_f64()))
        };
        let as_derived = y0.is_none() && parameters.is_none() && rule.is_none();
        let numbers = parameters.map_or(Vec::new(), |numbers| numbers.0);
        let ran = background::run(py, &interrupt, || match as_derived {
            true => self.with(run)?.map_err(errors::solve),
            false => self.at_run_time.started(numbers, rule, y0, run),
        })?;
        let (run, reached, states, seconds) = ran?;
        let (status, cause) = match &run.solution.status {
            Status::Completed => ("completed", None),
            Status::Stopped { t, cause } => ("stopped", Some(format!("stopped at t = {t}: {cause}"))),
        };
        let count = Some(times.len());
        Ok(Trajectory {
            states: fixed(py, states, count, &[width])?.unbind(),
            times: fixed(py, times, count, &[])?.unbind(),
            reached,
            status: status.into(),
            cause,
            work: work(py, &run.solution.work)?,
            seconds,
        })
    }
}
