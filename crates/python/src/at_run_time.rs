//! Equations whose parameters and free constants are numbers of a call.

use std::collections::HashMap;

use mechanics::ConstantsRule;
use motion::{ByName, Choice, Form, Prepared, Settings, SolveError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use scene::Scene;

use crate::errors;
use crate::shared::Shared;

/// A scene and a choice, and its equations with other parameters as inputs.
pub(crate) struct AtRunTime {
    scene: Shared<(Scene, Choice)>,
    /// Names of the states with all parameters folded in.
    states: Vec<String>,
    /// Those that no call works with, by the names of the parameters that are inputs.
    kept: Shared<HashMap<Vec<String>, Vec<Box<Ready>>>>,
}

/// Equations for other numbers, and the free constants that they had first.
#[derive(Clone)]
struct Ready {
    by_name: ByName,
    constants: Vec<f64>,
}

impl AtRunTime {
    pub(crate) fn new(scene: Scene, choice: Choice, states: Vec<String>) -> AtRunTime {
        AtRunTime { scene: Shared::new((scene, choice)), states, kept: Shared::default() }
    }

    pub(crate) fn scene_and_choice(&self) -> PyResult<(Scene, Choice)> {
        self.scene.copy()
    }

    /// Equations with parameters of these names as inputs: kept ones, or those that are derived and compiled
    /// now.
    fn ready_for(&self, names: &[String]) -> PyResult<Box<Ready>> {
        if let Some(ready) = self.kept.with(|kept| kept.get_mut(names).and_then(Vec::pop))? {
            return Ok(ready);
        }
        let (scene, choice) = self.scene_and_choice()?;
        let g = &scene.system.graph;
        let known: Vec<String> = scene.system.parameters.iter().map(|p| g.name(p.symbol)).collect();
        if let Some(name) = names.iter().find(|name| !known.contains(name)) {
            let known = if known.is_empty() { "there are none".into() } else { format!("known: {}", known.join(", ")) };
            return Err(errors::unknown(format!("unknown parameter `{name}`; {known}")));
        }
        let settings = Settings { form: Form::Named, ..Settings::default() };
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let by_name = ByName::new(&scene, &choice, &names, &settings).map_err(errors::solve)?;
        let Prepared { equations, .. } = by_name.varying().prepared();
        let states: Vec<String> = equations.states.iter().map(|y| equations.graph.name(y.symbol)).collect();
        if states != self.states {
            return Err(PyValueError::new_err(format!(
                "with {} as inputs the states are {}, and not {}: some value of theirs simplifies the equations; use \
                 System.replace",
                names.join(", "),
                states.join(", "),
                self.states.join(", ")
            )));
        }
        let constants = by_name.varying().constants().to_vec();
        Ok(Box::new(Ready { by_name, constants }))
    }

    fn keep(&self, names: Vec<String>, ready: Box<Ready>) -> PyResult<()> {
        self.kept.with(|kept| kept.entry(names).or_default().push(ready))
    }

    /// Calls `body` with the equations for these parameters, for states of the caller's own.
    pub(crate) fn with_numbers<T>(
        &self,
        numbers: Vec<(String, f64)>,
        body: impl FnOnce(&mut Prepared) -> T,
    ) -> PyResult<T> {
        let (names, values) = sorted(numbers)?;
        let mut ready = self.ready_for(&names)?;
        let g = &ready.by_name.varying().prepared().equations.graph;
        let place = |symbol| names.iter().position(|name| *name == g.name(symbol));
        let parameters = ready.by_name.parameters().into_iter().filter_map(place).map(|i| values[i]);
        let parameters: Vec<f64> = parameters.collect();
        ready.by_name.varying_mut().set_numbers(&parameters, &ready.constants);
        let prepared = ready.by_name.varying_mut().prepared_mut();
        if !prepared.guess.is_empty() {
            prepared.compiled.set_guess(&prepared.guess);
        }
        let result = body(prepared);
        self.keep(names, ready)?;
        Ok(result)
    }

    /// Calls `body` with the equations for these parameters and free constants, started at `y0` or, by the
    /// formulas and conditions of the scene, with these numbers.
    pub(crate) fn started<T>(
        &self,
        numbers: Vec<(String, f64)>,
        rule: Option<ConstantsRule>,
        y0: Option<Vec<f64>>,
        body: impl FnOnce(&mut Prepared) -> Result<T, SolveError>,
    ) -> PyResult<T> {
        let (names, values) = sorted(numbers)?;
        let mut ready = self.ready_for(&names)?;
        let started = ready.by_name.set(&values, rule.as_ref());
        let result = started.and_then(|()| {
            let prepared = ready.by_name.varying_mut().prepared_mut();
            y0.into_iter().for_each(|y0| prepared.start = y0);
            body(prepared)
        });
        self.keep(names, ready)?;
        result.map_err(errors::solve)
    }
}

/// Names and numbers, finite, in the order of the names.
fn sorted(mut numbers: Vec<(String, f64)>) -> PyResult<(Vec<String>, Vec<f64>)> {
    if let Some((name, x)) = numbers.iter().find(|(_, x)| !x.is_finite()) {
        return Err(PyValueError::new_err(format!("parameters: {name} is {x}; it must be finite")));
    }
    numbers.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(numbers.into_iter().unzip())
}
