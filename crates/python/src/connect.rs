//! Motions between two points.

use integrate::Interrupt;
use mechanics::ConstantsRule;
use motion::{Aim, Choice, Connections as Found, Settings, SolveError};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use scene::Scene;
use stubs::{answer, stubbed};

use crate::arguments::Numbers;
use crate::arrays::{Floats, vector};
use crate::system::{Overrides, System};
use crate::{arguments, background, errors};

#[answer]
pub(crate) struct Connections;

#[stubbed]
impl Connections {
    fn __len__(&self) -> usize {
        self.motions.len()
    }

    fn __repr__(&self) -> String {
        format!("<deltaq.Connections: {} motions, {}>", self.motions.len(), self.formulation)
    }
}

#[answer("<deltaq.Connection, action {action}>")]
pub(crate) struct Connection;

#[stubbed]
impl System {
    fn connect(
        &self,
        py: Python<'_>,
        to: Numbers,
        at: Option<f64>,
        formulation: &str,
        removal: Option<&str>,
        mu0: Option<Floats<'_>>,
        constants: Option<Bound<'_, PyAny>>,
        starts: usize,
        tolerance: f64,
        threads: usize,
    ) -> PyResult<Connections> {
        let given = arguments::constants(constants.as_ref(), mu0)?;
        let scene = self.scene()?;
        let (settings, interrupt) = arguments::settings("auto", tolerance, true, 1_000_000, None, None)?;
        let formulation = arguments::formulation(formulation)?;
        let (scene, choice) = arguments::choice(py, &interrupt, scene, (formulation, removal), given)?;
        let t = at.unwrap_or(scene.start.t + scene.duration);
        let aim = Aim { t, to: to.0, starts, threads };
        found(py, (scene, choice), aim, (settings, interrupt))
    }
}

/// What is found, in a thread beside Python's.
fn found(
    py: Python<'_>,
    (scene, choice): (Scene, Choice),
    aim: Aim,
    (settings, interrupt): (Settings, Interrupt),
) -> PyResult<Connections> {
    let formulation = choice.formulation.name.to_string();
    let work = move || {
        let found = motion::connect(&scene, &choice, &aim, &settings)?;
        Ok::<_, SolveError>((found, scene, aim))
    };
    let (found, scene, aim) = background::run(py, &interrupt, work)?.map_err(errors::solve)?;
    let Found { unknowns, found, failures, runs: [runs, with_derivatives], every_constant, none } = found;
    let motions = found.into_iter().map(|motion| Py::new(py, one(py, &scene, &aim, &unknowns, motion)?));
    Ok(Connections {
        formulation,
        motions: motions.collect::<PyResult<_>>()?,
        unknowns,
        starts: aim.starts,
        failures: failures.into_py_dict(py)?.unbind(),
        runs,
        with_derivatives,
        every_constant,
        none,
    })
}

fn one(
    py: Python<'_>,
    scene: &Scene,
    aim: &Aim,
    unknowns: &[String],
    motion: motion::Connection,
) -> PyResult<Connection> {
    let named = |values: &[f64]| unknowns.iter().zip(values.iter().copied()).into_py_dict(py).map(Bound::unbind);
    let mut own = Scene { start: motion.start.clone(), duration: aim.t - scene.start.t, ..scene.clone() };
    let constants = motion.motion.constants.clone();
    if constants.len() == own.multipliers.len() {
        own.multipliers.clone_from(&constants);
    }
    for removal in &mut own.removals {
        removal.constants = ConstantsRule::Zero;
    }
    let system = System::read(py, (&scene.name, None), own.to_toml(), Overrides::new())?;
    let times = motion.conjugate.as_ref();
    let column = |pick: fn(&motion::ConjugateTime) -> f64| {
        times.map(|times| vector(py, times.iter().map(pick).collect())).transpose()
    };
    Ok(Connection {
        system: Py::new(py, system)?,
        unknowns: named(&motion.unknowns)?,
        errors: named(&motion.errors)?,
        conjugate_times: column(|time| time.t)?,
        conjugate_errors: column(|time| time.error)?,
        multiplicities: times.map(|times| times.iter().map(|time| time.multiplicity).collect()),
        is_isolated: motion.is_isolated(),
        constants: vector(py, constants)?,
        velocities: vector(py, motion.start.v)?,
        action: motion.action[0],
        action_error: motion.action[1],
        residuals: aim.to.iter().map(|(name, _)| name).zip(motion.residuals).into_py_dict(py)?.unbind(),
        condition: motion.condition,
        is_minimum: motion.is_minimum,
        second_variation: motion.second_variation.words().to_string(),
        starts: motion.starts,
        by_half: motion.by_half,
    })
}
