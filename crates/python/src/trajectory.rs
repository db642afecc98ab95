//! One run of the time loop from Python.

use std::time::Instant;

use integrate::{Dense, Options, Status};
use motion::{Prepared, SolveError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stubs::{answer, stubbed};

use crate::arguments::Numbers;
use crate::arrays::{Floats, fixed, list, times, within};
use crate::ensemble::Instants;
use crate::equations::Equations;
use crate::motion::work;
use crate::{arguments, background, errors};

#[answer("<deltaq.Trajectory {status}, {seconds} s>")]
pub(crate) struct Trajectory;

/// The time of y0: `t0` or the first of `instants`, which then must not be all there is.
fn start_of(instants: &Floats<'_>, t0: Option<f64>) -> PyResult<f64> {
    let instants = times("times", instants)?;
    let refused = |text: String| Err(PyValueError::new_err(text));
    let (begin, last) = match (t0, instants.values().first(), instants.values().last()) {
        (_, _, None) => return refused("times is empty".into()),
        (Some(t0), ..) if !t0.is_finite() => return refused(format!("t0 is {t0}; it must be finite")),
        (Some(t0), _, Some(&last)) => (t0, last),
        (None, Some(&first), Some(&last)) if last > first => return Ok(first),
        (None, _, Some(&last)) => {
            return refused(format!("y0 belongs to the first of times, t = {last}, and no later one follows; give t0"));
        }
    };
    if last <= begin {
        return refused(format!("times ends at {last}; after t0 = {begin} is needed"));
    }
    Ok(begin)
}

/// What `run` gives from a time and a state on; the equations keep their own start.
fn started_from<T>(
    ready: &mut Prepared,
    (t, y): (f64, Vec<f64>),
    run: impl FnOnce(&mut Prepared) -> Result<T, SolveError>,
) -> Result<T, SolveError> {
    let own = (std::mem::replace(&mut ready.t, t), std::mem::replace(&mut ready.start, y));
    let result = run(ready);
    (ready.t, ready.start) = own;
    result
}

#[stubbed]
impl Equations {
    fn integrate(
        &self,
        py: Python<'_>,
        times: Floats<'_>,
        y0: Option<Floats<'_>>,
        t0: Option<f64>,
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
        let begin = match &y0 {
            Some(_) => start_of(&times, t0)?,
            None if t0.is_some() => {
                return Err(PyValueError::new_err(format!(
                    "t0 is the time of y0; without y0 a run starts with the system, at t = {}",
                    scene.start.t
                )));
            }
            None => scene.start.t,
        };
        let Instants { values: times, count, end } = Instants::read(&times, begin, &scene)?;
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
        let from = y0.map(|y0| (begin, y0));
        let ran = background::run(py, &interrupt, || match (parameters, rule, from) {
            (None, None, None) => self.with(run)?.map_err(errors::solve),
            (None, None, Some(from)) => self.with(|ready| started_from(ready, from, run))?.map_err(errors::solve),
            (Some(Numbers(numbers)), None, Some(from)) => {
                let run = |ready: &mut Prepared| started_from(ready, from, run);
                self.at_run_time.with_numbers(numbers, run)?.map_err(errors::solve)
            }
            (numbers, rule, from) => {
                let numbers = numbers.map_or(Vec::new(), |numbers| numbers.0);
                self.at_run_time.started(numbers, rule, from, run)
            }
        })?;
        let (run, reached, states, seconds) = ran?;
        let (status, cause) = match &run.solution.status {
            Status::Completed => ("completed", None),
            Status::Stopped { t, cause } => ("stopped", Some(format!("stopped at t = {t}: {cause}"))),
        };
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
