//! The reference that errors are taken against.

use anyhow::Result;
use integrate::{Options, Status};
use mechanics::State;
use motion::band::BEFORE_THE_END;
use motion::{Metric, Prepared};
use reference::{CachedReference, Question, reference};
use scene::Scene;

use super::KeptReferences;

/// Where a motion truly is at some times.
pub struct Truth {
    /// Times, the last at the end.
    pub times: Vec<f64>,
    /// Upper bound of the error of the coordinates, in the kinetic metric.
    pub error: f64,
    /// How they were computed.
    pub origin: String,
    /// Whether the motion ends before the scene does, and the times therefore before its end.
    pub shortened: bool,
    /// [`Question::digests`].
    pub(super) digests: [u64; 2],
    source: Source,
}

enum Source {
    /// In double-double arithmetic.
    Wide(CachedReference),
    /// In `f64`, where the other failed: coordinates and velocities at each time.
    Narrow(Vec<(Vec<f64>, Vec<f64>)>, Box<Metric>),
}

/// Error that is asked of the reference.
const ACCURACY: f64 = 1e-15;

impl Truth {
    /// `count` times of the motion that `ready` starts, up to the scene's end or just before its own. What is
    /// `kept` of these equations from this start is not computed again.
    ///
    /// # Errors
    /// Where the motion cannot be computed.
    pub fn new(scene: &Scene, ready: &Prepared, count: usize, kept: &KeptReferences) -> Result<Truth> {
        let mut ready = ready.clone();
        let end = scene.start.t + scene.duration;
        let [looser, tighter] =
            [1e-13, 2e-15].map(|tolerance| ready.integrate(end, &Options::with_tolerance(tolerance)));
        let (looser, tighter) = (looser?, tighter?);
        let shortened = [&looser, &tighter].iter().any(|run| run.solution.status != Status::Completed);
        let reached = tighter.end().min(looser.end());
        let end = if shortened { ready.t + BEFORE_THE_END * (reached - ready.t) } else { end };
        let at = |i: usize| if i == count { end } else { ready.t + (end - ready.t) * i as f64 / count as f64 };
        let times: Vec<f64> = (1..=count).map(at).collect();

        let start = State { t: ready.t, ..scene.start.clone() };
        let question =
            Question { system: &scene.system, start: &start, equations: &ready.equations, constants: &ready.constants };
        let digests = question.digests(&times, ACCURACY);
        let wide = |found: CachedReference, origin: &str| {
            let (error, origin) = (found.error, origin.into());
            Truth { times: times.clone(), error, origin, shortened, digests, source: Source::Wide(found) }
        };
        if let Some(found) = kept.find(digests).filter(|found| found.times() == count) {
            return Ok(wide(found.clone(), "double-double, two methods, kept"));
        }
        let refused = match reference(&question, &times, ACCURACY) {
            Ok(found) => return Ok(wide(CachedReference::from(&found), "double-double, two methods")),
            Err(error) => error,
        };
        let mut metric = Metric::new(&scene.system)?;
        let mut error = 0.0_f64;
        let mut places = Vec::new();
        for &t in &times {
            let (here, there) = (tighter.at(&mut ready.compiled, t)?, looser.at(&mut ready.compiled, t)?);
            error = error.max(metric.distance(t, &here.coordinates, &here.velocities, &there.coordinates));
            places.push((here.coordinates, here.velocities));
        }
        let origin = format!("DOP853 at tolerance 2e-15 (none in double-double arithmetic: {refused})");
        Ok(Truth { times, error, origin, shortened, digests, source: Source::Narrow(places, Box::new(metric)) })
    }

    /// Time of the last sample.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(f64::NAN)
    }

    /// What may be kept of it.
    pub(super) fn wide(&self) -> Option<&CachedReference> {
        match &self.source {
            Source::Wide(found) => Some(found),
            Source::Narrow(..) => None,
        }
    }

    /// Distance of the coordinates `q` from the motion at the time of index `i`, kinetic metric.
    pub fn distance(&mut self, i: usize, q: &[f64]) -> f64 {
        match &mut self.source {
            Source::Wide(found) => found.distance(i, q),
            Source::Narrow(places, metric) => {
                let (right, v) = &places[i];
                metric.distance(self.times[i], right, v, q)
            }
        }
    }
}
