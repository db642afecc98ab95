//! Systems, and what can be asked of them.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use deltaq::{EnsembleOptions, Settings, integrability, removals, setting, solve_choice};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scene::Scene;

use crate::arrays::{Array, FloatList, Floats, array, at_points};
use crate::comparison::{Comparison, compare};
use crate::ensemble::{self, Ensemble, Varied};
use crate::equations::Equations;
use crate::linearization::Linearization;
use crate::motion::{Motion, Sampled, State};
use crate::scene_text::{Arguments, Formula, Formulas, write};
use crate::{arguments, background, errors, motion};

/// A mechanical system with velocity constraints, its start and everything else that a scene file says.
///
/// Expressions: numbers, or strings as in scene files: coordinates, velocities (`x'`), parameters, time `t`;
/// or SymPy's: coordinates are dynamicsymbols or names, velocities their derivatives, parameters symbols.
///
/// coordinates: names of the n coordinates. lagrangian: L(q, v, t). constraints: f(q, v, t), h of them, each
/// to be zero. parameters: name to number. definitions: name to expression, usable in all others. units:
/// coordinate to text. forces: coordinate to expression, generalized forces Q. start: every coordinate to its
/// start. velocities: some ("x'") to their start; constraints supply the others. guess: velocities near which
/// the others are sought. project: move given velocities onto the constraints. removals: name to
/// {"parameters": [...], "rates": {...}, ...}, as in [removal.NAME] of scene files. multipliers: mu0, shape
/// (h,), zero by default. time: t0. duration: length of the run.
///
/// SceneError names the line of the scene file that the arguments amount to.
#[pyclass(frozen, module = "deltaq")]
pub(crate) struct System {
    scene: Mutex<Scene>,
}

/// Name to number.
pub(crate) type Overrides = Vec<(String, f64)>;

impl System {
    /// The system of a scene.
    pub(crate) fn of(scene: Scene) -> System {
        System { scene: Mutex::new(scene) }
    }

    /// A system from the text of a scene.
    pub(crate) fn parse(py: Python<'_>, name: &str, text: &str, overrides: &Overrides) -> PyResult<System> {
        let scene = py.detach(|| Scene::parse_with(name, text, overrides));
        Ok(System::of(scene.map_err(|error| errors::scene(py, &error))?))
    }

    /// The scene. No lock of Python is waited for while it is held.
    fn scene(&self) -> MutexGuard<'_, Scene> {
        self.scene.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl System {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (
        coordinates, lagrangian, constraints=Formulas(Vec::new()), *, start, parameters=None, definitions=None, units=None,
        forces=None, velocities=None, guess=None, project=false, removals=None, multipliers=None, time=0.0, duration=1.0,
        name="system", title=None
    ))]
    fn new(
        py: Python<'_>,
        coordinates: Formulas,
        lagrangian: Formula,
        constraints: Formulas,
        start: Bound<'_, PyDict>,
        parameters: Option<Bound<'_, PyDict>>,
        definitions: Option<Bound<'_, PyDict>>,
        units: Option<Bound<'_, PyDict>>,
        forces: Option<Bound<'_, PyDict>>,
        velocities: Option<Bound<'_, PyDict>>,
        guess: Option<Bound<'_, PyDict>>,
        project: bool,
        removals: Option<Bound<'_, PyDict>>,
        multipliers: Option<Bound<'_, PyAny>>,
        time: f64,
        duration: f64,
        name: &str,
        title: Option<String>,
    ) -> PyResult<System> {
        let text = write(&Arguments {
            title: title.unwrap_or_else(|| name.into()),
            coordinates: coordinates.0,
            units,
            start,
            tables: vec![
                ("parameters", parameters),
                ("definitions", definitions),
                ("system.forces", forces),
                ("start.velocities", velocities),
                ("start.guess", guess),
                ("removal", removals),
            ],
            lagrangian: lagrangian.0,
            constraints: constraints.0,
            time,
            project,
            multipliers,
            duration,
        })?;
        System::parse(py, name, &text, &Overrides::new())
    }

    /// Name: that of the file without its ending.
    #[getter]
    fn name(&self) -> String {
        self.scene().name.clone()
    }

    /// Title, one line.
    #[getter]
    fn title(&self) -> String {
        self.scene().title.clone()
    }

    /// Where the example is from, empty where that is not said.
    #[getter]
    fn source(&self) -> String {
        self.scene().source.clone()
    }

    /// Names of the coordinates, length n.
    #[getter]
    fn coordinates(&self) -> Vec<String> {
        self.scene().system.coordinates.iter().map(|c| c.name.clone()).collect()
    }

    /// Units of the coordinates, by name.
    #[getter]
    fn units(&self) -> HashMap<String, String> {
        self.scene().system.coordinates.iter().map(|c| (c.name.clone(), c.unit.clone())).collect()
    }

    /// Number of coordinates, n.
    #[getter]
    fn dimension(&self) -> usize {
        self.scene().system.dimension()
    }

    /// Values of the parameters, by name.
    #[getter]
    fn parameters(&self) -> HashMap<String, f64> {
        let scene = self.scene();
        scene.system.parameters.iter().map(|p| (scene.system.graph.name(p.symbol), p.value)).collect()
    }

    /// The Lagrangian, as text.
    #[getter]
    fn lagrangian(&self) -> String {
        let scene = self.scene();
        scene.system.graph.plain(scene.system.lagrangian)
    }

    /// The constraints, as text, length h.
    #[getter]
    fn constraints(&self) -> Vec<String> {
        let scene = self.scene();
        scene.system.constraints.iter().map(|&f| scene.system.graph.plain(f)).collect()
    }

    /// The generalized forces other than zero, as text, by coordinate.
    #[getter]
    fn forces(&self) -> HashMap<String, String> {
        let scene = self.scene();
        let g = &scene.system.graph;
        let pairs = scene.system.coordinates.iter().zip(&scene.system.forces);
        pairs.filter(|(_, force)| !g.is_zero(**force)).map(|(c, &force)| (c.name.clone(), g.plain(force))).collect()
    }

    /// The start: t0, q0 and v0 with f(q0, v0, t0) = 0.
    #[getter]
    fn start(&self, py: Python<'_>) -> PyResult<State> {
        let mechanics::State { t, q, v } = self.scene().start.clone();
        let n = q.len();
        Ok(State { t, q: array(py, q, None, &[n])?.unbind(), v: array(py, v, None, &[n])?.unbind() })
    }

    /// Multipliers mu0 at the start of vakonomic motions, length h.
    #[getter]
    fn multipliers(&self) -> Vec<f64> {
        self.scene().multipliers.clone()
    }

    /// Length of the run, in the unit of time.
    #[getter]
    fn duration(&self) -> f64 {
        self.scene().duration
    }

    /// Names of removals for the removed-constraint formulation: those written by hand, then automatic ones.
    ///
    /// RemovalError where there is none.
    #[getter]
    fn removals(&self) -> PyResult<Vec<String>> {
        let known = removals(&self.scene()).map_err(errors::solve)?;
        Ok(known.into_iter().map(|r| r.name).collect())
    }

    /// Frobenius' verdict on the constraints, in words; RemovalError where they are dependent at the start.
    #[getter]
    fn integrability(&self) -> PyResult<String> {
        let scene = self.scene();
        Ok(integrability(&scene.system, &scene.start).map_err(errors::solve)?.to_string())
    }

    /// The system as a scene file's text, every start value a number; `parse` of it gives the same system.
    #[pyo3(signature = ())]
    fn to_toml(&self) -> String {
        self.scene().to_toml()
    }

    /// Constraint residuals f(q, v, t), shape (h,) or (k, h); q, v: (n,) or (k, n); t: a number or (k,).
    #[pyo3(signature = (t, q, v))]
    fn constraint<'py>(&self, py: Python<'py>, t: Floats<'_>, q: Floats<'_>, v: Floats<'_>) -> Array<'py> {
        let (values, count) = at_points(&self.scene().system, [t, q, v], |system| system.constraints.clone())?;
        array(py, values, count, &[self.scene().system.constraints.len()])
    }

    /// Mass matrix M(q, v, t) = d²L/dv², shape (n, n) or (k, n, n); arguments as in `constraint`.
    ///
    /// Distances of configurations are measured by it everywhere: sqrt(dq' M dq).
    #[pyo3(signature = (t, q, v))]
    fn mass<'py>(&self, py: Python<'py>, t: Floats<'_>, q: Floats<'_>, v: Floats<'_>) -> Array<'py> {
        let (values, count) =
            at_points(&self.scene().system, [t, q, v], |system| system.velocity_hessian().entries().to_vec())?;
        let n = self.scene().system.dimension();
        array(py, values, count, &[n, n])
    }

    /// The equations of motion under a formulation, one of FORMULATIONS.
    ///
    /// removal: a name in `removals`, "coordinates" or "quasi-velocities"; by default the first.
    /// constants: those of `Equations.initial_state`, as in `solve`; by default zero if natural at a horizon.
    #[pyo3(signature = (formulation="chetaev", removal=None, *, mu0=None, constants=None))]
    fn equations(
        &self,
        py: Python<'_>,
        formulation: &str,
        removal: Option<&str>,
        mu0: Option<FloatList<'_>>,
        constants: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Equations> {
        let given = arguments::constants(constants.as_ref(), mu0)?;
        Equations::derived(py, self.scene().clone(), (formulation, removal), given)
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
        mu0: Option<FloatList<'_>>,
        constants: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Linearization> {
        let given = arguments::constants(constants.as_ref(), mu0)?;
        let scene = self.scene().clone();
        let choice = arguments::choice(&scene, formulation, removal, given)?;
        Linearization::about(py, scene, choice, free.unwrap_or_default(), (at, find))
    }

    /// Derives and integrates the motion under a formulation, one of FORMULATIONS.
    ///
    /// times: where it is read off, shape (k,), from the start to the last. By default 101 over `duration`.
    /// removal: a name in `removals`, "coordinates" or "quasi-velocities"; by default the first.
    /// mu0: start multipliers of the vakonomic formulations, shape (h,). By default those of the system.
    /// constants: free constants, "zero", {"horizon": T} (natural at T) or an array. By default those of the
    /// removal or of the system.
    /// form: of the equations, "multipliers", "costates", "quasi-velocities" or auto, which suits the system.
    /// method: one of METHODS, or auto, which suits the motion. tolerance: of the looser run; the one that is
    /// kept has a hundredth of it.
    /// project: move velocities onto the constraint after every step. max_steps, time_limit: limits on the
    /// steps of a run and on its seconds, after which it stops. max_step: no step is longer.
    ///
    /// Other threads go on; Ctrl-C ends it. SolveError without a motion; `status` says if it stops early.
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (
        formulation="chetaev", times=None, *, removal=None, mu0=None, constants=None, form="auto", method="auto",
        tolerance=1e-11, project=true, max_steps=1_000_000, max_step=None, time_limit=None
    ))]
    fn solve(
        &self,
        py: Python<'_>,
        formulation: &str,
        times: Option<FloatList<'_>>,
        removal: Option<&str>,
        mu0: Option<FloatList<'_>>,
        constants: Option<Bound<'_, PyAny>>,
        form: &str,
        method: &str,
        tolerance: f64,
        project: bool,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
    ) -> PyResult<Motion> {
        let given = arguments::constants(constants.as_ref(), mu0)?;
        let (settings, interrupt) = arguments::settings(method, tolerance, project, max_steps, max_step, time_limit)?;
        let mut scene = self.scene().clone();
        let (formulation, form) = arguments::in_form(form, formulation)?;
        let settings = Settings { form, ..settings };
        let choice = arguments::choice(&scene, formulation, removal, given)?;
        let times = motion::times_of_run(times, &mut scene)?;
        let work = move || {
            let motion = solve_choice(&scene, &choice, &settings)?;
            Sampled::new(motion, setting(&scene), times)
        };
        Motion::new(py, background::run(py, &interrupt, work)?.map_err(errors::solve)?)
    }

    /// Integrates many motions at once, by Taylor series, under a formulation: starts or parameters differ.
    ///
    /// vary: name to array, shape (m,): parameters, start values ("x", "x'"), multipliers ("mu1", ...).
    /// times: where they are read off, shape (k,), ascending, to the last. By default the end of `duration`.
    /// threads: 0 for one a processor; results do not depend on it. estimate: whether each member is run
    /// twice, as in `solve`, or once and without an error estimate. Else as in `solve`, constants for all,
    /// and time_limit for one run of 4096 members.
    ///
    /// A member that cannot start or that stops is in the answer with its cause. Ctrl-C as in `solve`.
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (
        formulation="chetaev", times=None, *, vary, removal=None, mu0=None, constants=None, tolerance=1e-11, project=true,
        max_steps=1_000_000, max_step=None, time_limit=None, threads=0, estimate=true
    ))]
    fn ensemble(
        &self,
        py: Python<'_>,
        formulation: &str,
        times: Option<FloatList<'_>>,
        vary: &Bound<'_, PyDict>,
        removal: Option<&str>,
        mu0: Option<FloatList<'_>>,
        constants: Option<Bound<'_, PyAny>>,
        tolerance: f64,
        project: bool,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
        threads: usize,
        estimate: bool,
    ) -> PyResult<Ensemble> {
        let constants = arguments::constants(constants.as_ref(), mu0)?;
        let (settings, interrupt) = arguments::settings("taylor", tolerance, project, max_steps, max_step, time_limit)?;
        let (scene, given) = (self.scene().clone(), constants.is_some());
        let choice = arguments::choice(&scene, formulation, removal, constants)?;
        let (times, end) = ensemble::times(times, &scene)?;
        let varied = Varied::read(vary)?;
        let options = EnsembleOptions { threads, estimate };
        if let (true, Some(name)) = (given, varied.multiplier()) {
            return Err(PyValueError::new_err(format!("{name} varies, and mu0 or constants fix it")));
        }
        let task = ensemble::Task { varied, scene, choice, times, end, settings, options };
        let integrated = background::run(py, &interrupt, move || task.run())?;
        Ensemble::new(py, integrated.map_err(errors::solve)?)
    }

    /// Compares the motions of all formulations pair by pair; tolerance, max_steps, max_step and time_limit
    /// as in `solve`.
    #[pyo3(signature = (*, tolerance=1e-11, max_steps=1_000_000, max_step=None, time_limit=None))]
    fn compare(
        &self,
        py: Python<'_>,
        tolerance: f64,
        max_steps: usize,
        max_step: Option<f64>,
        time_limit: Option<f64>,
    ) -> PyResult<Comparison> {
        let (settings, interrupt) = arguments::settings("auto", tolerance, true, max_steps, max_step, time_limit)?;
        let scene = self.scene().clone();
        let compared = background::run(py, &interrupt, move || compare(scene, &settings))?;
        Comparison::new(py, compared.map_err(errors::solve)?)
    }

    fn __repr__(&self) -> String {
        let scene = self.scene();
        let names: Vec<&str> = scene.system.coordinates.iter().map(|c| c.name.as_str()).collect();
        format!("<deltaq.System {:?}, coordinates ({})>", scene.title, names.join(", "))
    }
}
