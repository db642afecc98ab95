//! Outputs of a motion as a function of numbers of its scene, for fits: a motion that fails is not an error.

use std::sync::Arc;

use equations::Outputs;
use integrate::Status;
use mechanics::ConstantsRule;
use scene::Scene;

use crate::differences::size;
use crate::direction::Direction;
use crate::variational::{VariationalRun, Which};
use crate::{ByName, Choice, Settings, SolveError};

/// A motion read off at given times, for any values of some numbers: derived and compiled once. It is
/// integrated in one run, at [`Settings::tolerance`].
///
/// ```
/// # let text = include_str!("../../scene/scenes/sledge.toml");
/// use motion::{Model, Settings, choices};
/// let scene = scene::Scene::parse("sledge", text)?;
/// let mut model = Model::new(&scene, &choices(&scene)[0], &["phi'"], &[1.0, 2.0], &Settings::default())?;
/// // the sledge turns at a constant rate, from 0.3 rad on
/// let found = model.derivatives(&[0.5]);
/// assert!((found.outputs[1].coordinates[2] - 1.3).abs() < 1e-9 && found.ended.is_none());
/// assert!((found.derivatives[1][0].coordinates[2] - 2.0).abs() < 1e-9);
/// // what is not a start is said, and no error
/// assert!(model.outputs(&[f64::NAN]).ended.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Model {
    by_name: ByName,
    times: Arc<[f64]>,
    settings: Settings,
    start: f64,
}

/// Outputs of a motion, and why it ended.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// At the times that the motion reached.
    pub outputs: Vec<Outputs>,
    /// At each of them, by each number; empty where none were asked for.
    pub derivatives: Vec<Vec<Outputs>>,
    /// Why there are fewer times than were asked for.
    pub ended: Option<String>,
}

impl Model {
    /// For the numbers of these names and these times, ascending, the last one after the start.
    ///
    /// # Errors
    /// As [`ByName::new`]; [`SolveError::Member`] for times that make no sense, for constants that are
    /// natural at a horizon, and for methods that carry no derivatives.
    pub fn new(
        scene: &Scene,
        choice: &Choice,
        names: &[&str],
        times: &[f64],
        settings: &Settings,
    ) -> Result<Self, SolveError> {
        let refused = |reason: String| Err(SolveError::Member { reason });
        let start = scene.start.t;
        check(start, times)?;
        if matches!(choice.constants, ConstantsRule::Natural { .. }) {
            return refused(
                "constants that are natural at a horizon are found by a search: a model has given ones".into(),
            );
        }
        let by_name = ByName::new(scene, choice, names, settings)?;
        let method = by_name.varying().prepared().method.method;
        VariationalRun::check(method)?;
        let settings = Settings { method: Some(method), ..settings.clone() };
        Ok(Model { by_name, times: times.into(), settings, start })
    }

    /// The same at other times; nothing is derived anew.
    ///
    /// # Errors
    /// [`SolveError::Member`] for times that make no sense.
    pub fn with_times(&self, times: &[f64]) -> Result<Self, SolveError> {
        let mut other = self.clone();
        other.set_times(times)?;
        Ok(other)
    }

    /// From now on at other times.
    ///
    /// # Errors
    /// As [`Model::with_times`].
    pub fn set_times(&mut self, times: &[f64]) -> Result<(), SolveError> {
        check(self.start, times)?;
        self.times = times.into();
        Ok(())
    }

    /// From now on with this tolerance, if it is larger.
    pub fn coarsen(&mut self, tolerance: f64) {
        self.settings.tolerance = self.settings.tolerance.max(tolerance);
    }

    /// From now on a motion may take no more than `times` the steps, 10 at least, of that with these numbers;
    /// nothing changes where there is no such motion.
    ///
    /// # Panics
    /// If there are not as many as names.
    pub fn limit_steps(&mut self, row: &[f64], times: usize) {
        let (end, options) = self.end();
        if self.set(row).is_ok() {
            let run = self.by_name.varying_mut().prepared_mut().integrate(end, &options);
            if let Some(run) = run.ok().filter(|run| run.solution.status == Status::Completed) {
                let steps = run.solution.work.steps + run.solution.work.rejected;
                self.settings.max_steps = self.settings.max_steps.min(times * steps.max(10));
            }
        }
    }

    /// Names of the numbers.
    pub fn names(&self) -> &[String] {
        self.by_name.names()
    }

    /// The times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Names of the multipliers among the outputs.
    pub fn multipliers(&self) -> Vec<String> {
        self.by_name.varying().prepared().equations.multipliers.iter().map(|m| m.name.clone()).collect()
    }

    /// The outputs with these numbers.
    ///
    /// # Panics
    /// If there are not as many as names.
    pub fn outputs(&mut self, row: &[f64]) -> Reading {
        let mut found = Reading::default();
        found.ended = self.read(row, &mut found.outputs).err();
        found
    }

    /// The same with its derivatives by each number.
    ///
    /// # Panics
    /// If there are not as many as names.
    pub fn derivatives(&mut self, row: &[f64]) -> Reading {
        if row.is_empty() {
            let read = self.outputs(row);
            return Reading { derivatives: vec![Vec::new(); read.outputs.len()], ..read };
        }
        let mut found = Reading::default();
        found.ended = self.read_with_derivatives(row, &mut found).err();
        found
    }

    fn read(&mut self, row: &[f64], outputs: &mut Vec<Outputs>) -> Result<(), String> {
        self.set(row)?;
        let (end, options) = self.end();
        let prepared = self.by_name.varying_mut().prepared_mut();
        let run = prepared.integrate(end, &options).map_err(|error| error.to_string())?;
        for t in self.times.iter().take_while(|t| **t <= run.end()) {
            outputs.push(run.at(&mut prepared.compiled, *t).map_err(|error| error.to_string())?);
        }
        ended(&run.solution.status)
    }

    fn read_with_derivatives(&mut self, row: &[f64], found: &mut Reading) -> Result<(), String> {
        self.set(row)?;
        let along = self.directions(row).map_err(|error| error.to_string())?;
        let (end, options) = self.end();
        let prepared = self.by_name.varying_mut().prepared_mut();
        let carried = VariationalRun::run(prepared, &along, end, &options, Which::Kept);
        let mut carried = carried.map_err(|error| error.to_string())?;
        let reached = carried.ends().fold(f64::INFINITY, f64::min);
        for t in self.times.iter().take_while(|t| **t <= reached) {
            let (outputs, derivatives) = carried.at(prepared, *t).map_err(|error| error.to_string())?;
            found.outputs.push(outputs);
            found.derivatives.push(derivatives);
        }
        ended(carried.status())
    }

    fn set(&mut self, row: &[f64]) -> Result<(), String> {
        assert_eq!(row.len(), self.names().len(), "numbers");
        if let Some((name, x)) = self.names().iter().zip(row).find(|(_, x)| !x.is_finite()) {
            return Err(format!("{name} is {x}; it must be finite"));
        }
        self.by_name.set(row, None).map_err(|error| error.to_string())
    }

    fn end(&self) -> (f64, integrate::Options) {
        let end = self.times[self.times.len() - 1];
        // no more is read
        let wanted = Some(self.times.clone());
        (end, integrate::Options { wanted, ..self.settings.options(self.settings.tolerance) })
    }

    /// How the start and the constants move with each number.
    fn directions(&mut self, row: &[f64]) -> Result<Vec<Direction>, SolveError> {
        let by_name = &mut self.by_name;
        let along = (0..row.len()).map(|i| {
            let (name, mut moved) = (by_name.names()[i].clone(), row.to_vec());
            Direction::by(&name, row[i], size(row[i]), &mut |x| {
                moved[i] = x;
                by_name.set(&moved, None)?;
                Ok(by_name.varying().prepared().start_and_constants())
            })
        });
        let along = along.collect::<Result<_, _>>()?;
        by_name.set(row, None)?;
        Ok(along)
    }
}

/// Refuses times at which a motion from `start` has no outputs.
fn check(start: f64, times: &[f64]) -> Result<(), SolveError> {
    let refused = |reason: String| Err(SolveError::Member { reason });
    if let Some(pair) = times.windows(2).find(|pair| pair[0] > pair[1] || pair[1].is_nan()) {
        return refused(format!("times have to rise: {:?} comes before {:?}", pair[0], pair[1]));
    }
    match (times.first(), times.last()) {
        (Some(first), Some(last)) if *first >= start && *last > start && last.is_finite() => Ok(()),
        _ => refused(format!("times have to begin at the start {start:?} or after it, and to end after it")),
    }
}

fn ended(status: &Status) -> Result<(), String> {
    match status {
        Status::Completed => Ok(()),
        Status::Stopped { t, cause } => Err(format!("the motion stops at t = {t:?}: {cause}")),
    }
}

impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Model").field("names", &self.names()).field("times", &self.times).finish_non_exhaustive()
    }
}
