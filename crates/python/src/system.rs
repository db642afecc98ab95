//! Systems, and what can be asked of them.

use std::path::Path;

use comparison::integrability;
use integrate::Interrupt;
use motion::removals;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use scene::Scene;
use symbolic::{work_on, worked_on};

use crate::arguments::{Numbers, Table};
use crate::arrays::{Array, Floats, Points, array, fixed};
use crate::background::apart;
use crate::kept::kept;
use crate::scene_text::{Arguments, Formula, Formulas, write};
use crate::shared::Shared;
use crate::{background, errors};

/// A point of a motion: time, coordinates, velocities.
#[pyclass(frozen, get_all, module = "deltaq")]
pub(crate) struct State {
    /// Time.
    pub(crate) t: f64,
    /// Coordinates, shape (n,), in the units of the system.
    pub(crate) q: Py<PyArrayDyn<f64>>,
    /// Velocities, shape (n,), in units of the coordinates per unit of time.
    pub(crate) v: Py<PyArrayDyn<f64>>,
}

kept!(State: t q v);

#[pymethods]
impl State {
    fn __repr__(&self) -> String {
        format!("<deltaq.State t={}, q={}, v={}>", self.t, self.q, self.v)
    }
}

/// A mechanical system with velocity constraints, its start and everything else that a scene file says.
///
/// Expressions: numbers, or strings as in scene files: coordinates, velocities (`x'`), parameters, time `t`;
/// or SymPy's: coordinates are dynamicsymbols or names, velocities their derivatives, parameters symbols.
///
/// coordinates: names of the n coordinates. lagrangian: L(q, v, t). constraints: f(q, v, t), h of them, each
/// to be zero. parameters: name to number. definitions: name to expression, usable in all others. units:
/// coordinate to text. forces: coordinate to expression, generalized forces Q. virtual: what rates of virtual
/// displacements satisfy, h of them, for the formulation prescribed. observables: name to
/// expression, what motions list besides; invariants: likewise, what should stay constant. view: name of a
/// body to {"shape": ..., "size": [...], "at": ..., "rotation": ...}, as in [view.NAME]. start: every
/// coordinate to its start. velocities: some ("x'") to their start; constraints supply the others, and
/// start_equations, as in ["dot(W, n) = 5"] or what is zero. guess: velocities near which these are sought.
/// project: move given velocities onto the constraints.
/// removals: name to {"parameters": [...], "rates": {...}, ...}, as in [removal.NAME] of scene files.
/// multipliers: mu0, shape (h,), zero by default. time: t0. duration: length of the run. breakpoints: times
/// at which a step ends, where something is switched. notes: remarks.
///
/// >>> sledge = deltaq.System(
/// ...     coordinates=["x", "y", "phi"],
/// ...     lagrangian="(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*sin(alpha)*x",
/// ...     constraints=["y'*cos(phi) - x'*sin(phi)"],
/// ...     parameters={"g": 9.81, "alpha": 0.4, "k": 0.7},
/// ...     start={"x": 0, "y": 0, "phi": 0},
/// ...     velocities={"phi'": 1, "x'": 0},
/// ... )
/// >>> sledge.constraint(0.0, sledge.start.q, sledge.start.v)
/// array([0.])
///
/// SceneError names the line of the scene file that the arguments amount to.
#[pyclass(frozen, module = "deltaq")]
pub(crate) struct System {
    scene: Shared<Scene>,
    /// What its faults are about.
    about: String,
    /// What the scene was read from.
    pub(crate) text: String,
    pub(crate) overrides: Overrides,
}

/// Name to number.
pub(crate) type Overrides = Vec<(String, f64)>;

impl System {
    /// A system from the text of a scene. Of one with a `path`, faults name that, and the file its name.
    pub(crate) fn read(
        py: Python<'_>,
        (name, path): (&str, Option<&Path>),
        text: String,
        overrides: Overrides,
    ) -> PyResult<System> {
        let scene = apart(py, || match path {
            Some(path) => Scene::parse_file(path, &text, &overrides),
            None => Scene::parse_with(name, &text, &overrides),
        })?;
        let scene = Shared::new(scene.map_err(|error| errors::scene(py, &error))?);
        Ok(System { scene, about: worked_on(), text, overrides })
    }

    /// A copy of the scene, on which this thread works from now on.
    pub(crate) fn scene(&self) -> PyResult<Scene> {
        work_on(self.about.clone());
        self.scene.copy()
    }
}

#[pymethods]
impl System {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "named in Python, and most of them left out")]
    #[pyo3(signature = (
        coordinates, lagrangian, constraints=None, *, start, parameters=None, definitions=None, units=None,
        r#virtual=None, forces=None, observables=None, invariants=None, view=None, velocities=None, start_equations=None, guess=None, project=false, removals=None, multipliers=None, time=0.0, duration=1.0,
        breakpoints=None, name="system", title=None, notes=""
    ))]
    fn new(
        py: Python<'_>,
        coordinates: Formulas,
        lagrangian: Formula,
        constraints: Option<Formulas>,
        start: Table<'_>,
        parameters: Option<Table<'_>>,
        definitions: Option<Table<'_>>,
        units: Option<Table<'_>>,
        r#virtual: Option<Formulas>,
        forces: Option<Table<'_>>,
        observables: Option<Table<'_>>,
        invariants: Option<Table<'_>>,
        view: Option<Table<'_>>,
        velocities: Option<Table<'_>>,
        start_equations: Option<Formulas>,
        guess: Option<Table<'_>>,
        project: bool,
        removals: Option<Table<'_>>,
        multipliers: Option<Bound<'_, PyAny>>,
        time: f64,
        duration: f64,
        breakpoints: Option<Vec<f64>>,
        name: &str,
        title: Option<String>,
        notes: &str,
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
                ("observables", observables),
                ("invariants", invariants),
                ("view", view),
                ("start.velocities", velocities),
                ("start.guess", guess),
                ("removal", removals),
            ],
            lagrangian: lagrangian.0,
            constraints: constraints.map_or(Vec::new(), |constraints| constraints.0),
            virtual_conditions: r#virtual.map_or(Vec::new(), |conditions| conditions.0),
            start_equations: start_equations.map_or(Vec::new(), |equations| equations.0),
            time,
            project,
            multipliers,
            duration,
            breakpoints: breakpoints.unwrap_or_default(),
            notes,
        })?;
        System::read(py, (name, None), text, Overrides::new())
    }

    /// Name: that of the file without its ending.
    #[getter]
    pub(crate) fn name(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.name.clone())
    }

    /// Title, one line.
    #[getter]
    fn title(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.title.clone())
    }

    /// Where the example is from, empty where that is not said.
    #[getter]
    fn source(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.source.clone())
    }

    /// Remarks, empty where there are none.
    #[getter]
    fn notes(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.notes.clone())
    }

    /// Names of the coordinates, length n.
    #[getter]
    fn coordinates(&self) -> PyResult<Vec<String>> {
        self.scene.with(|scene| scene.system.coordinates.iter().map(|c| c.name.clone()).collect())
    }

    /// Units of the coordinates, by name.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.scene()?.system.coordinates.iter().map(|c| (&c.name, &c.unit)).into_py_dict(py)
    }

    /// Number of coordinates, n.
    #[getter]
    fn dimension(&self) -> PyResult<usize> {
        self.scene.with(|scene| scene.system.dimension())
    }

    /// Values of the parameters, by name.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let scene = self.scene()?;
        scene.system.parameters.iter().map(|p| (scene.system.graph.name(p.symbol), p.value)).into_py_dict(py)
    }

    /// The Lagrangian, as text.
    #[getter]
    fn lagrangian(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.system.graph.plain(scene.system.lagrangian))
    }

    /// The constraints, as text, length h.
    #[getter]
    fn constraints(&self) -> PyResult<Vec<String>> {
        self.scene.with(|Scene { system, .. }| system.constraints.iter().map(|&f| system.graph.plain(f)).collect())
    }

    /// What rates of virtual displacements satisfy, as text, length h; empty where that is not prescribed.
    #[getter]
    fn r#virtual(&self) -> PyResult<Vec<String>> {
        self.scene
            .with(|Scene { system, .. }| system.virtual_conditions.iter().map(|&w| system.graph.plain(w)).collect())
    }

    /// The generalized forces other than zero, as text, by coordinate.
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let texts = |Scene { system, .. }: &mut Scene| -> Vec<(String, String)> {
            let g = &system.graph;
            let pairs = system.coordinates.iter().zip(&system.forces).filter(|(_, force)| !g.is_zero(**force));
            pairs.map(|(c, &force)| (c.name.clone(), g.plain(force))).collect()
        };
        self.scene.with(texts)?.into_py_dict(py)
    }

    /// The Lagrangian and the constraints in LaTeX: one `aligned` environment.
    #[getter]
    fn latex(&self) -> PyResult<String> {
        self.scene.with(|scene| {
            let mechanics::System { graph: g, lagrangian, constraints, .. } = &scene.system;
            let constraints = constraints.iter().map(|&f| format!(" \\\\\n0 &= {}", g.latex(f)));
            let lines = format!("L &= {}", g.latex(*lagrangian)) + &constraints.collect::<String>();
            format!("\\begin{{aligned}}\n{lines}\n\\end{{aligned}}")
        })
    }

    fn _repr_latex_(&self) -> PyResult<String> {
        Ok(format!("$\\displaystyle {}$", self.latex()?))
    }

    /// The start: t0, q0 and v0 with f(q0, v0, t0) = 0.
    #[getter]
    fn start(&self, py: Python<'_>) -> PyResult<State> {
        let mechanics::State { t, q, v } = self.scene.with(|scene| scene.start.clone())?;
        let n = q.len();
        Ok(State { t, q: fixed(py, q, None, &[n])?.unbind(), v: fixed(py, v, None, &[n])?.unbind() })
    }

    /// Multipliers mu0 at the start of vakonomic motions, length h.
    #[getter]
    fn multipliers(&self) -> PyResult<Vec<f64>> {
        self.scene.with(|scene| scene.multipliers.clone())
    }

    /// Length of the run, in the unit of time.
    #[getter]
    fn duration(&self) -> PyResult<f64> {
        self.scene.with(|scene| scene.duration)
    }

    /// Times at which a step ends, where something is switched.
    #[getter]
    fn breakpoints(&self) -> PyResult<Vec<f64>> {
        self.scene.with(|scene| scene.system.breakpoints.clone())
    }

    /// Names of removals for the removed-constraint formulation: those written by hand, then automatic ones.
    ///
    /// RemovalError where there is none.
    #[getter]
    fn removals(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let scene = self.scene()?;
        let known = background::run(py, &Interrupt::default(), move || removals(&scene))?;
        Ok(known.map_err(errors::solve)?.into_iter().map(|r| r.name).collect())
    }

    /// Frobenius' verdict on the constraints, in words; RemovalError where they are dependent at the start.
    #[getter]
    fn integrability(&self, py: Python<'_>) -> PyResult<String> {
        let scene = self.scene()?;
        let found = background::run(py, &Interrupt::default(), move || integrability(&scene))?;
        Ok(found.map_err(errors::solve)?.to_string())
    }

    /// The same system with other numbers in some places; overrides as in `load`, over those of before.
    ///
    /// >>> sledge.replace({"g": 1.6}).parameters["g"]
    /// 1.6
    #[pyo3(signature = (overrides))]
    fn replace(&self, py: Python<'_>, overrides: Numbers) -> PyResult<System> {
        let Numbers(overrides) = overrides;
        let is_new = |name: &String| overrides.iter().any(|(new, _)| new == name);
        let kept = self.overrides.iter().filter(|(name, _)| !is_new(name)).cloned();
        let all = kept.chain(overrides.iter().cloned()).collect();
        System::read(py, (&self.name()?, None), self.text.clone(), all)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String, Overrides))> {
        let system = slf.get();
        let arguments = (system.name()?, system.text.clone(), system.overrides.clone());
        Ok((slf.py().import("deltaq")?.getattr("_read_again")?, arguments))
    }

    /// The system as a scene file's text, every start value a number; `parse` of it gives the same system.
    #[pyo3(signature = ())]
    fn to_toml(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.to_toml())
    }

    /// Constraint residuals f(q, v, t), shape (h,) or (k, h); q, v: (n,) or (k, n); t: a number or (k,).
    #[pyo3(signature = (t, q, v))]
    fn constraint<'py>(&self, py: Python<'py>, t: Floats<'_>, q: Floats<'_>, v: Floats<'_>) -> Array<'py> {
        let points = Points::read([t, q, v], self.dimension()?)?;
        let compile =
            |Scene { system, .. }: &mut Scene| (Points::program(system, &system.constraints), system.constraints.len());
        let (program, width) = self.scene.with(compile)?;
        let program = program.map_err(errors::solve)?;
        array(py, apart(py, || points.values(program))?, points.count, &[width])
    }

    /// Mass matrix M(q, v, t) = d²L/dv², shape (n, n) or (k, n, n); arguments as in `constraint`.
    ///
    /// Distances of configurations are measured by it everywhere: sqrt(dq' M dq).
    #[pyo3(signature = (t, q, v))]
    fn mass<'py>(&self, py: Python<'py>, t: Floats<'_>, q: Floats<'_>, v: Floats<'_>) -> Array<'py> {
        let n = self.dimension()?;
        let points = Points::read([t, q, v], n)?;
        let compile = |Scene { system, .. }: &mut Scene| Points::program(system, system.velocity_hessian().entries());
        let program = self.scene.with(compile)?.map_err(errors::solve)?;
        array(py, apart(py, || points.values(program))?, points.count, &[n, n])
    }

    fn __repr__(&self) -> PyResult<String> {
        Ok(format!("<deltaq.System {:?}, coordinates ({})>", self.title()?, self.coordinates()?.join(", ")))
    }
}
