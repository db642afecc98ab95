//! The motion that errors are measured against.

use std::time::Duration;

use anyhow::{Context, Result, bail};
use deltaq::Metric;
use scene::Scene;
use serde_json::{Value, json};

use crate::{Problem, Tools};

/// Tolerance of the reference: heyoka in 113 bits.
const TOLERANCE: f64 = 1e-28;
/// Of ours, which has to agree with it.
const OURS: f64 = 1e-14;
/// How far the two may be apart.
const AGREEMENT: f64 = 1e-10;

/// Coordinates at the times of a case, and the metric in which distances from them are taken.
pub(crate) struct Reference {
    coordinates: Vec<Vec<f64>>,
    times: Vec<f64>,
    velocities: Vec<f64>,
    metric: Metric,
    /// Distance of our own DOP853 at the tightest tolerance.
    pub(crate) confirmed: f64,
}

/// The table of coordinates in an answer.
pub(crate) fn coordinates(answer: &Value) -> Result<Vec<Vec<f64>>> {
    serde_json::from_value(answer["coordinates"].clone()).context("coordinates")
}

impl Reference {
    /// Computes the reference: heyoka's Taylor method in 113 bits, from expressions that heyoka differentiates itself, which our own
    /// [`integrate::Method::Dop853`] has to confirm. This is the one place where another reference would be put in.
    ///
    /// # Errors
    /// Where there is no reference, or ours does not confirm it.
    pub(crate) fn new(problem: &Problem, scene: &Scene, tools: &mut Tools, limit: Duration) -> Result<Reference> {
        let form = if problem.trailers.is_some() { "reduced" } else { "scene" };
        let mut case = problem.case.clone();
        (case.purpose, case.form) = ("reference".into(), form.into());
        tools.ask("heyoka", "reference", &Tools::set_up(&case), limit).context("the reference")?;
        let run = |method: &str, tolerance: f64| json!({ "do": "run", "method": method, "tolerance": tolerance, "task": "trajectory", "repeat": 0 });
        let answer = tools.ask("heyoka", "reference", &run("Taylor, 113 bits", TOLERANCE), limit);
        let mut reference = Reference {
            coordinates: coordinates(&answer.context("the reference")?)?,
            times: problem.case.times.clone(),
            velocities: scene.start.v.clone(),
            metric: Metric::new(&scene.system)?,
            confirmed: 0.0,
        };
        let ours = tools.ask("ours", "ours-scene", &run("Dop853", OURS), limit).context("ours beside the reference")?;
        reference.confirmed = reference.error(&coordinates(&ours)?)?;
        if reference.confirmed.is_nan() || reference.confirmed > AGREEMENT {
            bail!("the reference and ours are {:.1e} apart", reference.confirmed);
        }
        Ok(reference)
    }

    /// The largest `sqrt(Δqᵀ M Δq)` over the times; of a table with two rows, that at the last time.
    pub(crate) fn error(&mut self, found: &[Vec<f64>]) -> Result<f64> {
        let places: Vec<usize> = match found.len() {
            2 => vec![0, self.times.len() - 1],
            count if count == self.times.len() => (0..count).collect(),
            count => bail!("{count} times in an answer"),
        };
        let mut largest = 0.0_f64;
        for (&place, q) in places.iter().zip(found) {
            let reference = &self.coordinates[place];
            if q.len() != reference.len() {
                bail!("{} coordinates in an answer", q.len());
            }
            largest = largest.max(self.metric.distance(self.times[place], reference, &self.velocities, q));
        }
        Ok(largest)
    }
}
