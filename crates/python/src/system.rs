//! Systems, and what can be asked of them.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use comparison::integrability;
use integrate::Interrupt;
use motion::removals;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use scene::Scene;
use stubs::stubbed;
use symbolic::{work_on, worked_on};

use crate::arguments::{Numbers, Table, unknown};
use crate::arrays::{Array, Floats, Points, array, vector};
use crate::background::apart;
use crate::scene_text::{Arguments, Formula, Formulas, write};
use crate::shared::Shared;
use crate::state::State;
use crate::{background, errors};

#[stubbed]
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

    /// The same system with these numbers over those that were set.
    fn with(&self, py: Python<'_>, numbers: Overrides) -> PyResult<System> {
        let is_new = |name: &String| numbers.iter().any(|(new, _)| new == name);
        let kept = self.overrides.iter().filter(|(name, _)| !is_new(name)).cloned();
        let all = kept.chain(numbers.iter().cloned()).collect();
        System::read(py, (&self.name()?, None), self.text.clone(), all)
    }

    /// What is watched along motions, as text, by name.
    fn watched<'py>(&self, py: Python<'py>, is_constant: bool) -> PyResult<Bound<'py, PyDict>> {
        let texts = |Scene { system, .. }: &mut Scene| -> Vec<(String, String)> {
            let own = system.watched.iter().filter(|watched| watched.is_constant() == is_constant);
            own.map(|watched| (watched.name.clone(), system.graph.plain(watched.expression))).collect()
        };
        self.scene.with(texts)?.into_py_dict(py)
    }

    /// The system for one call: with these parameters, and these coordinates and velocities at its start.
    pub(crate) fn for_call<'py>(
        slf: &Bound<'py, Self>,
        parameters: Option<Numbers>,
        start: Option<Numbers>,
    ) -> PyResult<Bound<'py, Self>> {
        if parameters.is_none() && start.is_none() {
            return Ok(slf.clone());
        }
        let scene = slf.get().scene()?;
        let coordinates = || scene.system.coordinates.iter().map(|c| c.name.clone());
        let starts: Vec<String> = coordinates().chain(coordinates().map(|name| name + "'")).collect();
        let own = scene.system.parameters.iter().map(|p| scene.system.graph.name(p.symbol)).collect();
        let mut numbers = Vec::new();
        for (what, given, known) in [("parameter", parameters, own), ("start value", start, starts)] {
            for (name, number) in given.map_or(Vec::new(), |given| given.0) {
                if !known.contains(&name) {
                    return Err(unknown(what, &name, known.iter().map(String::as_str)));
                }
                numbers.push((name, number));
            }
        }
        Bound::new(slf.py(), slf.get().with(slf.py(), numbers)?)
    }

    /// A copy of the scene, on which this thread works from now on.
    pub(crate) fn scene(&self) -> PyResult<Scene> {
        work_on(self.about.clone());
        self.scene.copy()
    }
}

/// What Python reads off the scene.
macro_rules! read_off {
    ($scene:ident: $($name:ident: $kind:ty = $value:expr;)*) => {
        #[stubbed]
        impl System {
            $(
                #[getter]
                pub(crate) fn $name(&self) -> PyResult<$kind> {
                    self.scene.with(|$scene| $value)
                }
            )*
        }
    };
}

read_off! { scene:
    name: String = scene.name.clone();
    title: String = scene.title.clone();
    source: String = scene.source.clone();
    notes: String = scene.notes.clone();
    coordinates: Vec<String> = scene.system.coordinates.iter().map(|c| c.name.clone()).collect();
    dimension: usize = scene.system.dimension();
    lagrangian: String = scene.system.graph.plain(scene.system.lagrangian);
    constraints: Vec<String> = scene.system.constraints.iter().map(|&f| scene.system.graph.plain(f)).collect();
    r#virtual: Vec<String> = scene.system.virtual_conditions.iter().map(|&w| scene.system.graph.plain(w)).collect();
    multipliers: Vec<f64> = scene.multipliers.clone();
    duration: f64 = scene.duration;
    breakpoints: Vec<f64> = scene.system.breakpoints.clone();
}

#[stubbed]
impl System {
    #[new]
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

    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.scene()?.system.coordinates.iter().map(|c| (&c.name, &c.unit)).into_py_dict(py)
    }

    #[getter]
    pub(crate) fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let scene = self.scene()?;
        scene.system.parameters.iter().map(|p| (scene.system.graph.name(p.symbol), p.value)).into_py_dict(py)
    }

    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let texts = |Scene { system, .. }: &mut Scene| -> Vec<(String, String)> {
            let g = &system.graph;
            let pairs = system.coordinates.iter().zip(&system.forces).filter(|(_, force)| !g.is_zero(**force));
            pairs.map(|(c, &force)| (c.name.clone(), g.plain(force))).collect()
        };
        self.scene.with(texts)?.into_py_dict(py)
    }

    #[getter]
    fn observables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.watched(py, false)
    }

    #[getter]
    fn invariants<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.watched(py, true)
    }

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

    #[getter]
    fn start(&self, py: Python<'_>) -> PyResult<State> {
        let mechanics::State { t, q, v } = self.scene.with(|scene| scene.start.clone())?;
        Ok(State { t, q: vector(py, q)?, v: vector(py, v)? })
    }

    #[getter]
    fn removals(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let scene = self.scene()?;
        let known = background::run(py, &Interrupt::default(), move || removals(&scene))?;
        Ok(known.map_err(errors::solve)?.into_iter().map(|r| r.name).collect())
    }

    #[getter]
    fn integrability(&self, py: Python<'_>) -> PyResult<String> {
        let scene = self.scene()?;
        let found = background::run(py, &Interrupt::default(), move || integrability(&scene))?;
        Ok(found.map_err(errors::solve)?.to_string())
    }

    fn replace(
        &self,
        py: Python<'_>,
        overrides: Option<Numbers>,
        numbers: Option<Bound<'_, PyDict>>,
    ) -> PyResult<System> {
        let mut all = overrides.map_or(Overrides::new(), |numbers| numbers.0);
        let more: Option<Numbers> = numbers.map(|numbers| numbers.extract()).transpose()?;
        for (name, number) in more.map_or(Overrides::new(), |more| more.0) {
            if all.iter().any(|(known, _)| *known == name) {
                return Err(PyTypeError::new_err(format!("{name} is given twice")));
            }
            all.push((name, number));
        }
        self.with(py, all)
    }

    /// Whether two systems say the same, with the same numbers.
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> PyResult<bool> {
        let Ok(other) = other.cast::<System>() else { return Ok(false) };
        Ok(self.to_toml()? == other.get().to_toml()?)
    }

    fn __hash__(&self) -> PyResult<u64> {
        let mut hasher = DefaultHasher::new();
        self.to_toml()?.hash(&mut hasher);
        Ok(hasher.finish())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (String, String, Overrides))> {
        let system = slf.get();
        let arguments = (system.name()?, system.text.clone(), system.overrides.clone());
        Ok((slf.py().import("deltaq")?.getattr("_read_again")?, arguments))
    }

    fn to_toml(&self) -> PyResult<String> {
        self.scene.with(|scene| scene.to_toml())
    }

    fn constraint<'py>(&self, py: Python<'py>, t: Floats<'_>, q: Floats<'_>, v: Floats<'_>) -> Array<'py> {
        let points = Points::read([t, q, v], self.dimension()?)?;
        let compile =
            |Scene { system, .. }: &mut Scene| (Points::program(system, &system.constraints), system.constraints.len());
        let (program, width) = self.scene.with(compile)?;
        let program = program.map_err(errors::solve)?;
        array(py, apart(py, || points.values(program))?, points.count, &[width])
    }

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
