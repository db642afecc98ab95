//! Equations of motion as functions of arrays.

use equations::{Compiled, EvaluationFailure, Formulation, Role};
use integrate::Method;
use mechanics::{ConstantsRule, Observables};
use motion::{
    EquationStyle, Language, Prepared, SolveError, code, constant_names, derive_at, equations_text, prepare, setting,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::Scene;
use stubs::stubbed;

use crate::arguments::Numbers;
use crate::arrays::{Array, Floats, States, array, list};
use crate::at_run_time::AtRunTime;
use crate::background::apart;
use crate::outputs::{Names, Outputs, observed};
use crate::pickled::partial;
use crate::shared::Shared;
use crate::system::System;
use crate::{arguments, background, errors};

#[stubbed]
pub(crate) struct Equations {
    ready: Shared<Prepared>,
    /// Those that no thread works with: each call takes one, and brings it back.
    spare: Shared<Vec<Box<Prepared>>>,
    /// Scene and choice; equations for other numbers.
    pub(crate) at_run_time: AtRunTime,
    dimension: usize,
    system: Py<System>,
    #[pyo3(get)]
    formulation: &'static str,
    #[pyo3(get)]
    removal: Option<String>,
    #[pyo3(get)]
    pub(crate) states: Vec<String>,
    #[pyo3(get)]
    constants: Vec<String>,
}

impl Equations {
    /// Derives and compiles those of a scene; constants that are natural at a horizon are zero by default.
    pub(crate) fn derived(
        system: &Bound<'_, System>,
        (formulation, removal): (&'static Formulation, Option<&str>),
        given: Option<ConstantsRule>,
    ) -> PyResult<Equations> {
        let (py, scene) = (system.py(), system.get().scene()?);
        let (settings, interrupt) = arguments::settings("auto", 1e-11, true, 1_000_000, None, None)?;
        let is_given = given.is_some();
        let (scene, mut choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        if !is_given && matches!(choice.constants, ConstantsRule::Natural { .. }) {
            choice.constants = ConstantsRule::Zero;
        }
        let work = move || {
            let equations = derive_at(&scene.system, &scene.start, &choice)?;
            let made = prepare(setting(&scene), equations, &choice.constants, &settings)?;
            Ok((made, scene, choice))
        };
        let made = background::run(py, &interrupt, work)?;
        let (made, scene, choice) = made.map_err(|error: SolveError| errors::solve(error))?;
        let equations = &made.equations;
        let states: Vec<String> = equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect();
        Ok(Equations {
            system: system.clone().unbind(),
            spare: Shared::default(),
            dimension: scene.system.dimension(),
            at_run_time: AtRunTime::new(scene, choice, states.clone(), made.constants.clone()),
            formulation: equations.formulation,
            removal: equations.removal.as_ref().map(|r| r.name.clone()),
            states,
            constants: constant_names(equations),
            ready: Shared::new(made),
        })
    }

    fn scene(&self) -> PyResult<Scene> {
        Ok(self.at_run_time.scene_and_choice()?.0)
    }

    /// Calls `body` with equations that no other thread has, from the same guess in each call.
    pub(crate) fn with<T>(&self, body: impl FnOnce(&mut Prepared) -> T) -> PyResult<T> {
        let mut ready = self.spare.with(Vec::pop)?.map_or_else(|| self.ready.copy().map(Box::new), Ok)?;
        if !ready.guess.is_empty() {
            ready.compiled.set_guess(&ready.guess);
        }
        let result = body(&mut ready);
        self.spare.with(|spare| spare.push(ready))?;
        Ok(result)
    }

    /// What `read` writes, equally many values at each point, where the equations are compiled as `method`
    /// needs them.
    fn rows(
        &self,
        py: Python<'_>,
        (at, parameters): (&States, Option<Numbers>),
        (width, method): (usize, Method),
        mut read: impl FnMut(&mut Compiled, f64, &[f64], &mut [f64]) -> Result<(), EvaluationFailure> + Send,
    ) -> PyResult<Vec<f64>> {
        let work = |ready: &mut Prepared| {
            ready.complete(method).map_err(errors::solve)?;
            let mut values = vec![0.0; width * at.count.unwrap_or(1)];
            let mut rows = values.chunks_exact_mut(width.max(1));
            at.each(|t, y| rows.next().map_or(Ok(()), |row| read(&mut ready.compiled, t, y, row)))?;
            Ok(values)
        };
        apart(py, || match parameters {
            None => self.with(work)?,
            Some(Numbers(numbers)) => self.at_run_time.with_numbers(numbers, work)?,
        })?
    }

    fn at(&self, t: &Floats<'_>, y: &Floats<'_>) -> PyResult<States> {
        States::read(t, y, self.states.len())
    }

    fn code(&self, py: Python<'_>, language: Language) -> PyResult<String> {
        let (scene, ready) = (self.scene()?, self.ready.copy()?);
        apart(py, move || code(&scene, &ready, language))?.map_err(errors::solve)
    }

    /// The state with these coordinates, velocities and multipliers, and the places of the velocities in it.
    fn state(&self, q: &[f64], v: &[f64], mu: &[f64]) -> PyResult<(Vec<f64>, Vec<usize>)> {
        let found = self.ready.with(|ready| state(&ready.equations, q, v, mu))?;
        found.ok_or_else(|| {
            PyValueError::new_err(format!(
                "the states of the {} formulation ({}) are not coordinates, velocities and the given mu; use rates",
                self.formulation,
                self.states.join(", ")
            ))
        })
    }
}

/// The state with these coordinates, velocities and multipliers, and the places of the velocities in it.
fn state(equations: &equations::Equations, q: &[f64], v: &[f64], mu: &[f64]) -> Option<(Vec<f64>, Vec<usize>)> {
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
    places.filter(|_| y.len() == equations.states.len()).map(|places| (y, places))
}

#[stubbed]
impl Equations {
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.system.get().parameters(py)
    }

    #[getter]
    fn text(&self) -> PyResult<String> {
        self.ready.with(|ready| equations_text(&ready.equations, EquationStyle::Plain))
    }

    #[getter]
    fn latex(&self) -> PyResult<String> {
        self.ready.with(|Prepared { equations, .. }| {
            let latex = |e| equations.graph.latex(e);
            let lines: Vec<String> =
                equations.statements.iter().map(|s| format!("{} &= {}", latex(s.left), latex(s.right))).collect();
            format!("\\begin{{aligned}}\n{}\n\\end{{aligned}}", lines.join(" \\\\\n"))
        })
    }

    fn to_c(&self, py: Python<'_>) -> PyResult<String> {
        self.code(py, Language::C)
    }

    fn to_numpy(&self, py: Python<'_>) -> PyResult<String> {
        self.code(py, Language::Numpy)
    }

    fn to_jax(&self, py: Python<'_>) -> PyResult<String> {
        self.code(py, Language::Jax)
    }

    fn to_numba(&self, py: Python<'_>) -> PyResult<String> {
        self.code(py, Language::Numba)
    }

    fn to_sympy(&self, py: Python<'_>) -> PyResult<String> {
        self.code(py, Language::Sympy)
    }

    fn initial_state<'py>(&self, py: Python<'py>, constants: Option<Bound<'_, PyAny>>) -> Array<'py> {
        let rule = arguments::constants(constants.as_ref(), None)?;
        let Prepared { equations, start, .. } = self.ready.copy()?;
        let start = match rule {
            None => start,
            Some(rule) => {
                let (settings, interrupt) = arguments::settings("auto", 1e-11, true, 1_000_000, None, None)?;
                let scene = self.scene()?;
                let work = move || prepare(setting(&scene), equations, &rule, &settings);
                background::run(py, &interrupt, work)?.map_err(errors::solve)?.start
            }
        };
        let width = start.len();
        array(py, start, None, &[width])
    }

    fn rates<'py>(&self, py: Python<'py>, t: Floats<'_>, y: Floats<'_>, parameters: Option<Numbers>) -> Array<'py> {
        let (width, at) = (self.states.len(), self.at(&t, &y)?);
        let rows = self.rows(py, (&at, parameters), (width, Method::Dop853), Compiled::rates)?;
        array(py, rows, at.count, &[width])
    }

    fn jacobian<'py>(&self, py: Python<'py>, t: Floats<'_>, y: Floats<'_>, parameters: Option<Numbers>) -> Array<'py> {
        let (width, at) = (self.states.len(), self.at(&t, &y)?);
        let rows = self.rows(py, (&at, parameters), (width * width, Method::Radau5), Compiled::jacobian)?;
        array(py, rows, at.count, &[width, width])
    }

    fn outputs(&self, py: Python<'_>, t: Floats<'_>, y: Floats<'_>) -> PyResult<Outputs> {
        let at = self.at(&t, &y)?;
        let work = |ready: &mut Prepared| -> PyResult<_> {
            let mut observables = Observables::of(&self.scene()?.system).map_err(errors::solve)?;
            let mut rows = Vec::new();
            at.each(|t, y| {
                rows.push(observed(&mut observables, t, ready.compiled.outputs(t, y)?));
                Ok(())
            })?;
            Ok((rows, Names::of(&ready.equations, &observables)))
        };
        let (rows, names) = apart(py, || self.with(work))???;
        Outputs::new(py, &rows, self.dimension, &names, at.count)
    }

    fn acceleration<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        q: Floats<'_>,
        v: Floats<'_>,
        mu: Option<Floats<'_>>,
    ) -> Array<'py> {
        let mu = mu.map_or(Ok(Vec::new()), |mu| list("mu", &mu))?;
        let (q, v) = (list("q", &q)?, list("v", &v)?);
        for (name, list) in [("q", &q), ("v", &v)] {
            if list.len() != self.dimension {
                let (found, needed) = (list.len(), self.dimension);
                return Err(PyValueError::new_err(format!("{name} has {found} entries; {needed} are needed")));
            }
        }
        let (y, places) = self.state(&q, &v, &mu)?;
        let mut rates = vec![0.0; y.len()];
        let work = |ready: &mut Prepared| ready.compiled.rates(t, &y, &mut rates);
        apart(py, || self.with(work))??.map_err(|error| errors::evaluation(&error, t))?;
        array(py, places.into_iter().map(|i| rates[i]).collect(), None, &[self.dimension])
    }

    /// They are derived again.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, ())> {
        let (py, Equations { system, formulation, removal, .. }) = (slf.py(), slf.get());
        let given = slf.get().at_run_time.scene_and_choice()?.1.constants;
        let options = PyDict::new(py);
        options.set_item("formulation", formulation)?;
        options.set_item("removal", removal)?;
        options.set_item("constants", arguments::rule_value(py, &given)?)?;
        Ok((partial(system.bind(py).getattr("equations")?, &options)?, ()))
    }

    fn _repr_latex_(&self) -> PyResult<String> {
        Ok(format!("$\\displaystyle {}$", self.latex()?))
    }

    fn __str__(&self) -> PyResult<String> {
        self.text()
    }

    fn __repr__(&self) -> String {
        format!("<deltaq.Equations {}, states ({})>", self.formulation, self.states.join(", "))
    }
}
