//! What is asked of a system: motions, ensembles, comparisons, points of sweeps.

use std::convert::Infallible;

use comparison::{Sweep, SweepPoint};
use integrate::Interrupt;
use motion::{EnsembleOptions, Settings, SolveError, number_of_threads, over_threads, setting, solve_choice};
use picture::Style;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scenery::{Drawn, moving};

use crate::arguments::Table;
use crate::arrays::{Floats, Rows, list};
use crate::background::whole;
use crate::comparison::{Comparison, compare};
use crate::ensemble::{self, Ensemble, Varied};
use crate::equations::Equations;
use crate::linearization::{Linearization, LinearizationSweep};
use crate::motion::{Asked, Motion, Sampled};
use crate::system::System;
use crate::{arguments, background, errors};

#[pymethods]
impl System {
    /// The equations of motion under a formulation, one of FORMULATIONS.
    ///
    /// removal: a name in `removals`, "coordinates" or "quasi-velocities"; by default the first.
    /// constants: those of `Equations.initial_state`, as in `solve`; by default zero if natural at a horizon.
    ///
    /// >>> equations = sledge.equations("chetaev")
    /// >>> equations.states
    /// ['x', 'y', 'phi', "x'", "y'", "phi'"]
    /// >>> equations.rates(0.0, equations.initial_state())[:3]
    /// array([0., 0., 1.])
    #[pyo3(signature = (formulation="chetaev", removal=None, *, mu0=None, constants=None))]
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

    /// The equations of motion to first order about the start, which has to be a steady motion.
    ///
    /// free: coordinates whose eigenvalues are asked for, with those of all that is coupled with them both
    /// ways; by default all. at: a time; about the motion there, steady or not. find: about a steady motion
    /// of Chetaev's equations near the start. Else as in `equations`. SolveError with what moves.
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (formulation="chetaev", *, free=None, at=None, find=false, removal=None, mu0=None, constants=None))]
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

    /// `linearize` over the values of one number, and where stability changes between them: `deltaq
    /// linearize --sweep`.
    ///
    /// over: one name to its values, shape (k,): a parameter, a start value ("x", "x'"), a multiplier
    /// ("mu0_1"). Between neighbours of different stability the value where it changes is found by
    /// bisection.
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (over, formulation="chetaev", *, free=None, find=false, removal=None, mu0=None, constants=None))]
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

    /// Derives and integrates the motion under a formulation, one of FORMULATIONS.
    ///
    /// times: where it is read off, shape (k,), ascending, to the last. By default 101 over `duration`.
    /// removal: a name in `removals`, "coordinates" or "quasi-velocities"; by default the first.
    /// mu0: start multipliers of the vakonomic formulations, shape (h,). By default those of the system.
    /// constants: free constants, "zero", {"horizon": T} (natural at T) or an array. By default those of the
    /// removal or of the system.
    /// form: of the equations, "multipliers", "costates", "quasi-velocities" or auto, which suits the system.
    /// method: one of METHODS, or auto, which suits the motion. tolerance: of the looser run; the one that is
    /// kept has a hundredth of it.
    /// project: move velocities onto the constraint after every step. max_steps, time_limit: limits on the
    /// steps of a run and on its seconds, after which it stops. max_step: no step is longer.
    /// sensitivities: names of parameters, start values ("x", "x'"), multipliers ("mu0_1", ...) or costates
    /// ("P0_w") by which all is derived: `Motion.sensitivities`.
    ///
    /// Other threads go on; Ctrl-C ends it. SolveError without a motion; `status` says if it stops early.
    ///
    /// >>> motion = sledge.solve("chetaev", [0.0, 0.5, 1.0])
    /// >>> motion.coordinates[:, 2].round(9)
    /// array([0. , 0.5, 1. ])
    /// >>> motion.status, motion.error_estimate < 1e-9
    /// ('completed', True)
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (
        formulation="chetaev", times=None, *, removal=None, mu0=None, constants=None, form="auto", method="auto",
        tolerance=1e-11, project=true, max_steps=1_000_000, max_step=None, time_limit=None, sensitivities=None
    ))]
    fn solve(
        slf: &Bound<'_, Self>,
        formulation: &str,
        times: Option<Floats<'_>>,
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
        let scene = slf.get().scene()?;
        let (mut scene, choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        let times = match times {
            None => None,
            Some(times) => {
                let (times, end) = ensemble::times(&times, &scene)?;
                scene.duration = end - scene.start.t;
                Some(times)
            }
        };
        let (limits, instants) = (settings.clone(), times.clone());
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

    /// Integrates many motions at once, by Taylor series, under a formulation: starts or parameters differ.
    ///
    /// vary: name to array, shape (m,): parameters, start values ("x", "x'"), multipliers ("mu0_1", ...).
    /// times: where they are read off, shape (k,), ascending, to the last. By default the end of `duration`.
    /// threads: 0 for one per processor; results do not depend on it. estimate: whether each member is run
    /// twice, as in `solve`, or once and without an error estimate. Else as in `solve`, constants for all,
    /// and time_limit for one run of 4096 members.
    ///
    /// A member that cannot start or that stops is in the answer with its cause. Ctrl-C as in `solve`.
    ///
    /// >>> sledge.ensemble("chetaev", [1.0], vary={"phi'": [0.5, 1.0]}).coordinates[:, 0, 2].round(9)
    /// array([0.5, 1. ])
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (
        formulation="chetaev", times=None, *, vary, removal=None, mu0=None, constants=None, tolerance=1e-11, project=true,
        max_steps=1_000_000, max_step=None, time_limit=None, threads=0, estimate=true
    ))]
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
        let (times, end) = times.map_or_else(
            || Ok((vec![setting(&scene).end], setting(&scene).end)),
            |times| ensemble::times(&times, &scene),
        )?;
        let varied = Varied::read(&vary.0)?;
        let options = EnsembleOptions { threads, estimate };
        if let (true, Some(name)) = (given, varied.multiplier(&scene)) {
            return Err(PyValueError::new_err(format!("{name} varies, and mu0 or constants fix it")));
        }
        let task = ensemble::Task { varied, scene, choice, times, end, settings, options };
        let integrated = background::run(py, &interrupt, move || task.run())?;
        Ensemble::new(slf, integrated.map_err(errors::solve)?)
    }

    /// Compares the motions of all formulations pair by pair; tolerance, max_steps, max_step and time_limit
    /// as in `solve`. fits: free constants are fitted where nothing is decided ("undecided"), always ("all"),
    /// which takes most of the time, or never ("none").
    ///
    /// >>> comparison = sledge.compare()
    /// >>> comparison.verdict("chetaev", "vakonomic")
    /// 'different'
    /// >>> comparison.decided[0].answer, comparison.decided[0].proved
    /// ('none', True)
    #[pyo3(signature = (*, tolerance=1e-11, max_steps=1_000_000, max_step=None, time_limit=None, fits="undecided"))]
    fn compare(
        slf: &Bound<'_, Self>,
        tolerance: f64,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
        fits: &str,
    ) -> PyResult<Comparison> {
        let (py, fits) = (slf.py(), arguments::fits(fits)?);
        let (settings, interrupt) = arguments::settings("auto", tolerance, true, max_steps, max_step, time_limit)?;
        let scene = slf.get().scene()?;
        let compared = background::run(py, &interrupt, move || compare(scene, fits, &settings))?;
        Comparison::new(slf, compared.map_err(errors::solve)?)
    }

    /// What `deltaq.sweep` finds at some points: columns by name.
    #[expect(clippy::too_many_arguments, reason = "named in Python")]
    #[pyo3(signature = (names, values, formulations, tolerance, max_steps, max_step, time_limit, threads))]
    fn _sweep_points<'py>(
        &self,
        py: Python<'py>,
        names: Vec<String>,
        values: Floats<'_>,
        formulations: Option<[String; 2]>,
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
    #[pyo3(signature = (curves))]
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
