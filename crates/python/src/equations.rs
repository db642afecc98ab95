//! Equations of motion as functions of arrays.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use deltaq::{
    EquationStyle, Language, Prepared, SolveError, code, constant_names, derive_at, equations_text, prepare, setting,
};
use equations::{Compiled, EvaluationFailure, Role};
use integrate::{Dense, Method, Options, Status};
use mechanics::{ConstantsRule, Observables};
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::Scene;

use crate::arrays::{Array, FloatList, Floats, Rows, array, common, times};
use crate::motion::{Names, Outputs, observed, work};
use crate::{arguments, background, ensemble, errors};

/// The equations of motion y' = F(t, y) of a system under one formulation.
///
/// `states` names the states y, `constants` what (q0, v0) leaves open. All callables take one state, t a
/// number and y of shape (m,), or k of them at once, y of shape (k, m) with t a number or of shape (k,).
#[pyclass(frozen, module = "deltaq")]
pub(crate) struct Equations {
    ready: Mutex<Prepared>,
    scene: Mutex<Scene>,
    dimension: usize,
    /// Name of the formulation.
    #[pyo3(get)]
    formulation: &'static str,
    /// Name of the removal, None where the formulation needs none.
    #[pyo3(get)]
    removal: Option<String>,
    /// Names of the states y, length m.
    #[pyo3(get)]
    states: Vec<String>,
    /// Names of the free constants.
    #[pyo3(get)]
    constants: Vec<String>,
}

/// One run of the time loop, without a second one: only its tolerance tells anything of its error.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct Trajectory {
    /// The times asked for that were reached, shape (k,).
    times: Py<PyArrayDyn<f64>>,
    /// States y at `times`, shape (k, m); `Equations.outputs` reads coordinates and all else off them.
    states: Py<PyArrayDyn<f64>>,
    /// "completed" or "stopped".
    status: &'static str,
    /// Why the run stopped, None where it is complete.
    cause: Option<String>,
    /// What the run cost, as in `Motion.work`.
    work: Py<PyDict>,
    /// Wall-clock seconds of the run and of reading the states off.
    seconds: f64,
}

#[pymethods]
impl Trajectory {
    fn __repr__(&self) -> String {
        format!("<deltaq.Trajectory {}, {} s>", self.status, self.seconds)
    }
}

/// Calls `body` with each row of `t` and `y`: the row's number, time and state.
fn each(t: &Rows, y: &Rows, mut body: impl FnMut(f64, &[f64]) -> Result<(), EvaluationFailure>) -> PyResult<()> {
    for i in 0..y.count().unwrap_or(1) {
        let time = t.row(i)[0];
        body(time, y.row(i)).map_err(|error| errors::evaluation(&error, time))?;
    }
    Ok(())
}

impl Equations {
    /// Derives and compiles those of a scene; constants that are natural at a horizon are zero by default.
    pub(crate) fn derived(
        py: Python<'_>,
        scene: Scene,
        (formulation, removal): (&str, Option<&str>),
        given: Option<ConstantsRule>,
    ) -> PyResult<Equations> {
        let (settings, interrupt) = arguments::settings("auto", 1e-11, true, 1_000_000, None, None)?;
        let is_given = given.is_some();
        let (scene, mut choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        if !is_given && matches!(choice.constants, ConstantsRule::Natural { .. }) {
            choice.constants = ConstantsRule::Zero;
        }
        let work = move || {
            let equations = derive_at(&scene.system, &scene.start, &choice)?;
            let made = prepare(setting(&scene), equations, &choice.constants, &settings)?;
            Ok((made, scene))
        };
        let made = background::run(py, &interrupt, work)?;
        let (made, scene) = made.map_err(|error: SolveError| errors::solve(error))?;
        Ok(Equations::new(made, scene))
    }

    pub(crate) fn new(ready: Prepared, scene: Scene) -> Equations {
        let equations = &ready.equations;
        Equations {
            dimension: scene.system.dimension(),
            scene: Mutex::new(scene),
            formulation: equations.formulation,
            removal: equations.removal.as_ref().map(|r| r.name.clone()),
            states: equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect(),
            constants: constant_names(equations),
            ready: Mutex::new(ready),
        }
    }

    fn ready(&self) -> MutexGuard<'_, Prepared> {
        self.ready.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn scene(&self) -> Scene {
        self.scene.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Reads `t` and `y`, calls `body` with the compiled equations, from the same guess in each call.
    fn evaluate<T>(
        &self,
        t: &Floats<'_>,
        y: &Floats<'_>,
        body: impl FnOnce(&mut Compiled, &Rows, &Rows) -> PyResult<T>,
    ) -> PyResult<(T, Option<usize>)> {
        let (t, y) = (times(t)?, Rows::read("y", y, self.states.len())?);
        let count = common(&[("y", &y), ("t", &t)])?;
        if t.count().is_some() && y.count().is_none() {
            return Err(PyValueError::new_err("t has several entries, y has a single row"));
        }
        let mut ready = self.ready();
        let Prepared { compiled, guess, .. } = &mut *ready;
        if !guess.is_empty() {
            compiled.set_guess(guess);
        }
        Ok((body(compiled, &t, &y)?, count))
    }

    /// What `read` writes, `width` numbers at each `t` and `y`.
    fn rows(
        &self,
        t: &Floats<'_>,
        y: &Floats<'_>,
        width: usize,
        mut read: impl FnMut(&mut Compiled, f64, &[f64], &mut [f64]) -> Result<(), EvaluationFailure>,
    ) -> PyResult<(Vec<f64>, Option<usize>)> {
        self.evaluate(t, y, |compiled, t, y| {
            let mut values = vec![0.0; width * y.count().unwrap_or(1)];
            let mut rows = values.chunks_exact_mut(width.max(1));
            each(t, y, |t, y| rows.next().map_or(Ok(()), |row| read(compiled, t, y, row)))?;
            Ok(values)
        })
    }

    fn code(&self, language: Language) -> PyResult<String> {
        let scene = self.scene();
        code(&scene, &self.ready(), language).map_err(errors::solve)
    }

    /// The state with these coordinates, velocities and multipliers, and the places of the velocities in it.
    fn state(&self, q: &[f64], v: &[f64], mu: &[f64]) -> PyResult<(Vec<f64>, Vec<usize>)> {
        let ready = self.ready();
        let equations = &ready.equations;
        let place =
            |list: &[symbolic::Expr], symbol| list.iter().position(|&e| equations.graph.as_symbol(e) == Some(symbol));
        let multipliers: Vec<_> = equations.multipliers.iter().map(|m| m.expression).collect();
        let (mut y, mut velocities) = (Vec::new(), vec![None; q.len()]);
        for state in &equations.states {
            let value = match state.role {
                Role::Position => place(&equations.coordinates, state.symbol).map(|i| q[i]),
                Role::Velocity => place(&equations.velocities, state.symbol).map(|i| {
                    velocities[i] = Some(y.len());
                    v[i]
                }),
                Role::Multiplier => place(&multipliers, state.symbol).and_then(|i| mu.get(i).copied()),
                _ => None,
            };
            y.extend(value);
        }
        let places: Option<Vec<usize>> = velocities.into_iter().collect();
        match places.filter(|_| y.len() == equations.states.len()) {
            Some(places) => Ok((y, places)),
            None => Err(PyValueError::new_err(format!(
                "the states of the {} formulation ({}) are not coordinates, velocities and the given mu; use rates",
                self.formulation,
                self.states.join(", ")
            ))),
        }
    }
}

#[pymethods]
impl Equations {
    /// The equations and what was left out of them, in the language of scenes.
    #[getter]
    fn text(&self) -> String {
        equations_text(&self.ready().equations, EquationStyle::Plain)
    }

    /// The equations in LaTeX: one `aligned` environment.
    #[getter]
    fn latex(&self) -> String {
        let equations = &self.ready().equations;
        let latex = |e| equations.graph.latex(e);
        let lines: Vec<String> =
            equations.statements.iter().map(|s| format!("{} &= {}", latex(s.left), latex(s.right))).collect();
        format!("\\begin{{aligned}}\n{}\n\\end{{aligned}}", lines.join(" \\\\\n"))
    }

    /// A file of C99: functions for rates and outputs without allocation, the start, the parameters.
    ///
    /// SolveError where unknowns of the instant are not found by linear equations; so in all three languages.
    #[pyo3(signature = ())]
    fn to_c(&self) -> PyResult<String> {
        self.code(Language::C)
    }

    /// A module of Python: rates(t, y) and outputs(t, y) in NumPy, for one state or many at once.
    #[pyo3(signature = ())]
    fn to_numpy(&self) -> PyResult<String> {
        self.code(Language::Numpy)
    }

    /// A module of Python: RATES, OUTPUTS, MATRIX and RIGHT as matrices of SymPy in STATES and UNKNOWNS.
    #[pyo3(signature = ())]
    fn to_sympy(&self) -> PyResult<String> {
        self.code(Language::Sympy)
    }

    /// The state y(t0) that belongs to the start of the system, shape (m,).
    ///
    /// constants: the free constants, "zero", {"horizon": T} (natural at T) or an array; default: as derived.
    #[pyo3(signature = (constants=None))]
    fn initial_state<'py>(&self, py: Python<'py>, constants: Option<Bound<'_, PyAny>>) -> Array<'py> {
        let rule = arguments::constants(constants.as_ref(), None)?;
        let Prepared { equations, start, .. } = self.ready().clone();
        let start = match rule {
            None => start,
            Some(rule) => {
                let (settings, interrupt) = arguments::settings("auto", 1e-11, true, 1_000_000, None, None)?;
                let scene = self.scene();
                let work = move || prepare(setting(&scene), equations, &rule, &settings);
                background::run(py, &interrupt, work)?.map_err(errors::solve)?.start
            }
        };
        let width = start.len();
        array(py, start, None, &[width])
    }

    /// Rates y' = F(t, y), of the shape of y.
    #[pyo3(signature = (t, y))]
    fn rates<'py>(&self, py: Python<'py>, t: Floats<'_>, y: Floats<'_>) -> Array<'py> {
        let width = self.states.len();
        let (values, count) = self.rows(&t, &y, width, Compiled::rates)?;
        array(py, values, count, &[width])
    }

    /// The exact Jacobian dF/dy, shape (m, m) or (k, m, m): [i, j] is the derivative of rate i by state j.
    #[pyo3(signature = (t, y))]
    fn jacobian<'py>(&self, py: Python<'py>, t: Floats<'_>, y: Floats<'_>) -> Array<'py> {
        let width = self.states.len();
        self.ready().complete(Method::Radau5).map_err(errors::solve)?;
        let (values, count) = self.rows(&t, &y, width * width, Compiled::jacobian)?;
        array(py, values, count, &[width, width])
    }

    /// Coordinates, velocities, multipliers and invariants at (t, y).
    #[pyo3(signature = (t, y))]
    fn outputs(&self, py: Python<'_>, t: Floats<'_>, y: Floats<'_>) -> PyResult<Outputs> {
        let mut observables = Observables::of(&self.scene().system).map_err(errors::solve)?;
        let (rows, count) = self.evaluate(&t, &y, |compiled, t, y| {
            let mut rows = Vec::new();
            each(t, y, |t, y| {
                rows.push(observed(&mut observables, t, compiled.outputs(t, y)?));
                Ok(())
            })?;
            Ok(rows)
        })?;
        let names = Names::of(&self.ready().equations, &observables);
        Outputs::new(py, &rows, self.dimension, &names, count)
    }

    /// Accelerations q'' at one point, shape (n,): t a number, q and v of shape (n,).
    ///
    /// The vakonomic formulation also needs mu, shape (h,). ValueError where the states are others.
    #[pyo3(signature = (t, q, v, mu=None))]
    fn acceleration<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        q: FloatList<'_>,
        v: FloatList<'_>,
        mu: Option<FloatList<'_>>,
    ) -> Array<'py> {
        let values = |array: &FloatList| array.as_array().iter().copied().collect::<Vec<f64>>();
        let (q, v, mu) = (values(&q), values(&v), mu.as_ref().map(values).unwrap_or_default());
        for (name, list) in [("q", &q), ("v", &v)] {
            if list.len() != self.dimension {
                let (found, needed) = (list.len(), self.dimension);
                return Err(PyValueError::new_err(format!("{name} has {found} entries; {needed} are needed")));
            }
        }
        let (y, places) = self.state(&q, &v, &mu)?;
        let mut rates = vec![0.0; y.len()];
        let mut ready = self.ready();
        let Prepared { compiled, guess, .. } = &mut *ready;
        if !guess.is_empty() {
            compiled.set_guess(guess);
        }
        compiled.rates(t, &y, &mut rates).map_err(|error| errors::evaluation(&error, t))?;
        array(py, places.into_iter().map(|i| rates[i]).collect(), None, &[self.dimension])
    }

    /// One run of the time loop from the start of the system to the last of `times`, shape (k,), in ascending
    /// order: half of what `System.solve` does, for those who know the error from elsewhere.
    ///
    /// method: one of METHODS; its first run compiles what it needs. tolerance: relative and absolute.
    /// project, max_steps, max_step, time_limit: as in `System.solve`. For the start and the last time alone
    /// nothing else is kept.
    ///
    /// Other threads go on; Ctrl-C ends it. SolveError without a run; `status` says if it stops early.
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (times, *, method="auto", tolerance=1e-11, project=true, max_steps=1_000_000, max_step=None, time_limit=None))]
    fn integrate(
        &self,
        py: Python<'_>,
        times: FloatList<'_>,
        method: &str,
        tolerance: f64,
        project: bool,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
    ) -> PyResult<Trajectory> {
        let (settings, interrupt) = arguments::settings(method, tolerance, project, max_steps, max_step, time_limit)?;
        let (mut times, end) = ensemble::times(Some(times), &self.scene())?;
        let mut ready = self.ready();
        let is_end = |&t: &f64| t == ready.t || t == end;
        let options = Options {
            method: settings.method.unwrap_or(ready.method.method),
            projection: settings.projection,
            max_steps,
            max_step: settings.max_step,
            dense: if times.iter().all(is_end) { Dense::EndOnly } else { Dense::Everywhere },
            interrupt: Some(time_limit.map_or(interrupt.clone(), |seconds| interrupt.within(seconds))),
            ..Options::with_tolerance(tolerance)
        };
        let ready = &mut *ready;
        let run = || -> Result<_, SolveError> {
            ready.complete(options.method)?;
            let clock = Instant::now();
            let run = ready.integrate(end, &options)?;
            times.retain(|&t| t <= run.end());
            let width = ready.start.len();
            let mut states = vec![0.0; width * times.len()];
            for (&t, row) in times.iter().zip(states.chunks_exact_mut(width)) {
                run.states_at(&mut ready.compiled, t, row);
            }
            Ok((run, states, clock.elapsed().as_secs_f64()))
        };
        let (run, states, seconds) = background::run(py, &interrupt, run)?.map_err(errors::solve)?;
        let (status, cause) = match &run.solution.status {
            Status::Completed => ("completed", None),
            Status::Stopped { t, cause } => ("stopped", Some(format!("stopped at t = {t}: {cause}"))),
        };
        let count = Some(times.len());
        Ok(Trajectory {
            states: array(py, states, count, &[self.states.len()])?.unbind(),
            times: array(py, times, count, &[])?.unbind(),
            status,
            cause,
            work: work(py, &run.solution.work)?,
            seconds,
        })
    }

    fn _repr_latex_(&self) -> String {
        format!("$\\displaystyle {}$", self.latex())
    }

    fn __str__(&self) -> String {
        self.text()
    }

    fn __repr__(&self) -> String {
        format!("<deltaq.Equations {}, states ({})>", self.formulation, self.states.join(", "))
    }
}
