//! The reference that errors are taken against.

use anyhow::Result;
use deltaq::Ready;
use integrate::{Options, Status};
use mechanics::Scene;

/// Where a motion truly is at some times.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Coordinates and velocities, in the order of time, the last at the end.
    pub samples: Vec<Sample>,
    /// What they are wrong by at most, in the largest coordinate.
    pub error: f64,
    /// How they were had.
    pub origin: String,
    /// Whether the motion ends before the scene does, and the samples therefore before its end.
    pub shortened: bool,
}

/// Where a motion is at one time.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Time.
    pub t: f64,
    /// `q`.
    pub q: Vec<f64>,
    /// `q̇`.
    pub v: Vec<f64>,
}

/// Of a motion that ends at a singularity this part is measured.
const PART: f64 = 0.9;

impl Truth {
    /// `count` samples of the motion that `ready` starts, up to the end of the scene or a little before the motion's own.
    ///
    /// # Errors
    /// Where the motion cannot be had.
    pub fn new(scene: &Scene, ready: &Ready, count: usize) -> Result<Truth> {
        let mut ready = ready.clone();
        let end = scene.start.t + scene.duration;
        let runs = [1e-13, 2e-15].map(|tolerance| ready.integrate(end, &Options::with_tolerance(tolerance)));
        let [looser, tighter] = runs;
        let (mut looser, mut tighter) = (looser?, tighter?);
        let shortened = [&looser, &tighter].iter().any(|run| run.status != Status::Completed);
        let reached = tighter.end().min(looser.end());
        let end = if shortened { ready.t + PART * (reached - ready.t) } else { end };
        let mut samples = Vec::new();
        let mut error = 0.0_f64;
        for i in 1..=count {
            let t = if i == count { end } else { ready.t + (end - ready.t) * i as f64 / count as f64 };
            let (here, there) = (tighter.at(&mut ready, t)?, looser.at(&mut ready, t)?);
            let apart = here.coordinates.iter().zip(&there.coordinates).map(|(a, b)| (a - b).abs());
            error = apart.fold(error, f64::max);
            samples.push(Sample { t, q: here.coordinates, v: here.velocities });
        }
        Ok(Truth { samples, error, origin: "DOP853 at tolerance 2e-15".into(), shortened })
    }

    /// Time of the last sample.
    pub fn end(&self) -> f64 {
        self.samples.last().map_or(f64::NAN, |s| s.t)
    }
}
