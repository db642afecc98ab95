//! What is asked of a system: motions, ensembles, comparisons, points of sweeps.

use std::convert::Infallible;

use comparison::{Extent, Fits, Sweep, SweepPoint};
use equations::Formulation;
use integrate::Interrupt;
use motion::{EnsembleOptions, Settings, SolveError, number_of_threads, over_threads, setting, solve_choice};
use picture::Style;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::scenery::{Drawn, moving};
use stubs::stubbed;

use crate::arguments::{Numbers, Table};
use crate::arrays::{Floats, Rows, list};
use crate::background::whole;
use crate::comparison::{Comparison, Wanted, compare};
use crate::ensemble::{Ensemble, Instants, Task, Varied};
use crate::equations::Equations;
use crate::linearization::{Linearization, LinearizationSweep};
use crate::motion::{Asked, Motion, Sampled};
use crate::system::System;
use crate::{arguments, background, errors};

#[stubbed]
impl System {
    fn equations(
        slf: &Bound<'_, Self>,
        formulation: &str,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Equations> {
        let given = arguments::constants(constants.as_ref(), mu0)?;
        Equations::derived(slf, (arguments::formulation(formulation)?, removal), given)
    }

    fn linearize(
        &self,
        py: Python<'_>,
        formulation: &str,
        free: Option<Vec<String>>,
        at: Option<f64>,
        find: bool,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Linearization> {
        let given = arguments::constants(constants.as_ref(), mu0)?;
        let scene = self.scene()?;
        let interrupt = Interrupt::default();
        let formulation = arguments::formulation(formulation)?;
        let (scene, choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        Linearization::about(py, scene, choice, free.unwrap_or_default(), (at, find))
    }

    fn linearize_over(
        slf: &Bound<'_, Self>,
        over: Table<'_>,
        formulation: &str,
        free: Option<Vec<String>>,
        find: bool,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
    ) -> PyResult<LinearizationSweep> {
        let (py, given) = (slf.py(), arguments::constants(constants.as_ref(), mu0)?);
        let [(name, values)] = &over.0.iter().collect::<Vec<_>>()[..] else {
            return Err(PyValueError::new_err(format!("over has {} names; one can vary", over.0.len())));
        };
        let name: String = name.extract()?;
        let values = list(&name, &values.extract()?)?;
        let scene = slf.get().scene()?;
        let formulation = arguments::formulation(formulation)?;
        let (scene, choice) = arguments::choice(py, &Interrupt::default(), scene, (formulation, removal), given)?;
        LinearizationSweep::over(slf, scene, choice, (&name, values), (free.unwrap_or_default(), find))
    }

    fn solve(
        slf: &Bound<'_, Self>,
        formulation: &str,
        times: Option<Floats<'_>>,
        parameters: Option<Numbers>,
        start: Option<Numbers>,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
        form: &str,
        method: &str,
        tolerance: f64,
        project: bool,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
        sensitivities: Option<Vec<String>>,
    ) -> PyResult<Motion> {
        let (py, given) = (slf.py(), arguments::constants(constants.as_ref(), mu0)?);
        let (settings, interrupt) = arguments::settings(method, tolerance, project, max_steps, max_step, time_limit)?;
        let (formulation, in_form) = arguments::in_form(form, formulation)?;
        let settings = Settings { form: in_form, ..settings };
        let slf = &System::for_call(slf, parameters, start)?;
        let scene = slf.get().scene()?;
        let (mut scene, choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        let instants = times.map(|times| Instants::read(&times, scene.start.t, &scene)).transpose()?;
        if let Some(instants) = &instants {
            scene.duration = instants.end - scene.start.t;
        }
        let (limits, times) = (settings.clone(), instants.as_ref().map(|instants| instants.values.clone()));
        let work = move || {
            let motion = solve_choice(&scene, &choice, &limits)?;
            let mut sampled = Sampled::new(motion, setting(&scene), instants)?;
            if let Some(names) = sensitivities.filter(|names| !names.is_empty()) {
                let (names, reached) = (names.iter().map(String::as_str).collect::<Vec<_>>(), sampled.reached());
                sampled.derived = Some(motion::sensitivities(&scene, &choice, &names, reached, &limits)?);
            }
            Ok((sampled, choice))
        };
        let (sampled, choice) =
            background::run(py, &interrupt, work)?.map_err(|error: SolveError| errors::solve(error))?;
        let asked = Asked { choice: &choice, form, times: times.as_deref(), settings: &settings };
        Motion::new(slf, sampled, &asked)
    }

    fn ensemble(
        slf: &Bound<'_, Self>,
        formulation: &str,
        times: Option<Floats<'_>>,
        vary: Table<'_>,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
        tolerance: f64,
        project: bool,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
        threads: usize,
        estimate: bool,
    ) -> PyResult<Ensemble> {
        let (py, constants) = (slf.py(), arguments::constants(constants.as_ref(), mu0)?);
        let (settings, interrupt) = arguments::settings("taylor", tolerance, project, max_steps, max_step, time_limit)?;
        let (scene, given) = (slf.get().scene()?, constants.is_some());
        let formulation = arguments::formulation(formulation)?;
        let (scene, choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), constants)?;
        let read = |times| Instants::read(&times, scene.start.t, &scene);
        let instants = times.map_or_else(|| Ok(Instants::end_of(&scene)), read)?;
        let varied = Varied::read(&vary.0)?;
        let options = EnsembleOptions { threads, estimate };
        if let (true, Some(name)) = (given, varied.multiplier(&scene)) {
            return Err(PyValueError::new_err(format!("{name} varies, and mu0 or constants fix it")));
        }
        let task = Task { varied, scene, choice, instants, settings, options };
        let integrated = background::run(py, &interrupt, move || task.run())?;
        Ensemble::new(slf, integrated.map_err(errors::solve)?)
    }

    fn compare(
        slf: &Bound<'_, Self>,
        formulations: Option<Vec<String>>,
        extent: &str,
        decision: bool,
        fits: &str,
        tolerance: f64,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
    ) -> PyResult<Comparison> {
        let py = slf.py();
        let named = |names: Vec<String>| names.iter().map(|name| arguments::formulation(name)).collect();
        let only: Option<Vec<&Formulation>> = formulations.map(named).transpose()?;
        let extent = arguments::among("extent", extent, &arguments::EXTENTS)?;
        let fits = match arguments::among("fits", fits, &arguments::FITS)? {
            // what is not decided on is not searched for
            Fits::Undecided if !decision || extent == Extent::Gaps => Fits::None,
            fits => fits,
        };
        let (settings, interrupt) = arguments::settings("auto", tolerance, true, max_steps, max_step, time_limit)?;
        let scene = slf.get().scene()?;
        let wanted = Wanted { only, extent, decision, fits };
        let compared = background::run(py, &interrupt, move || compare(scene, &wanted, &settings))?;
        Comparison::new(slf, compared.map_err(errors::solve)?)
    }

    /// What `deltaq.sweep` finds at some points: columns by name.
    fn _sweep_points<'py>(
        &self,
        py: Python<'py>,
        names: Vec<String>,
        values: Floats<'_>,
        formulations: Option<[String; 2]>,
        decision: bool,
        tolerance: f64,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (settings, interrupt) = arguments::settings("auto", tolerance, true, max_steps, max_step, time_limit)?;
        let values: Vec<f64> = values.as_array().iter().copied().collect();
        let read = |[first, second]: [String; 2]| {
            PyResult::Ok([arguments::formulation(&first)?, arguments::formulation(&second)?])
        };
        let formulations = formulations.map(read).transpose()?;
        let (name, width) = (self.name()?, names.len());
        let work = || -> Result<Vec<SweepPoint>, motion::SolveError> {
            let sweep = Sweep::new(&name, &self.text, &self.overrides, &names, formulations, &settings)?;
            let sweep = if decision { sweep } else { sweep.without_decision() };
            let rows: Vec<&[f64]> = values.chunks_exact(width.max(1)).collect();
            Ok(over_threads(number_of_threads(threads), rows.len(), |i| sweep.point(rows[i])))
        };
        let points = background::run(py, &interrupt, work)?.map_err(errors::solve)?;
        let columns = PyDict::new(py);
        macro_rules! column {
            ($($name:ident)*) => { $(
                columns.set_item(stringify!($name), points.iter().map(|p| p.$name.clone()).collect::<Vec<_>>())?;
            )* };
        }
        column!(verdict apart largest limit answer order dimension mismatch cause);
        Ok(columns)
    }

    /// The bodies along curves (label, formulation, times, coordinates of shape (k, n)) as an SVG that moves;
    /// None where nothing is seen to move. Between times a curve is straight.
    fn _moving(&self, curves: Vec<(String, String, Floats<'_>, Floats<'_>)>) -> PyResult<Option<String>> {
        let mut scene = self.scene()?;
        let mut motions = Vec::new();
        let mut end = scene.start.t;
        for (label, formulation, times, coordinates) in curves {
            let times = list("times", &times)?;
            let rows = Rows::read("coordinates", &coordinates, scene.system.dimension())?;
            end = times.iter().fold(end, |end, &t| end.max(t));
            let at = move |t: f64| -> Result<Vec<f64>, Infallible> {
                let next = times.partition_point(|&known| known <= t).clamp(1, times.len().max(2) - 1);
                let (one, two) = (rows.row(next - 1), rows.row(next.min(times.len() - 1)));
                let length = times.get(next).map_or(0.0, |two| two - times[next - 1]);
                let part = if length > 0.0 { ((t - times[next - 1]) / length).clamp(0.0, 1.0) } else { 0.0 };
                Ok(one.iter().zip(two).map(|(one, two)| one + (two - one) * part).collect())
            };
            let style = Style::of_formulation(&formulation).unwrap_or(Style::Member(motions.len() as u8));
            motions.push(Drawn { label, style, at: Box::new(at) });
        }
        scene.duration = end - scene.start.t;
        let drawn = whole(|| moving(&scene, motions).map(|picture| picture.and_then(|picture| picture.to_svg())))?;
        drawn.map_err(|error| PyValueError::new_err(error.to_string()))
    }
}
