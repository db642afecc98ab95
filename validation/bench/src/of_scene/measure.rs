//! One setting measured, and one method over its tolerances.

use std::time::Instant;

use integrate::{Method, Options, Status, Work};
use motion::{Prepared, SingleRun};

use super::{Effort, Truth};

/// A setting and what it came to.
#[derive(Clone, Debug)]
pub struct Point {
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// Time, error and work, or why there are none.
    pub outcome: Result<Measured, String>,
}

/// Time, error and work of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Seconds, least of several runs.
    pub seconds: f64,
    /// Largest distance from the reference in the kinetic metric.
    pub error: f64,
    /// Steps and evaluations: the same on every machine.
    pub work: Work,
}

/// A method over its tolerances, from loose to tight.
#[derive(Clone, Debug)]
pub struct Series {
    /// The method.
    pub method: Method,
    /// Its settings.
    pub points: Vec<Point>,
}

/// A run that takes over this many times as long as another that is as good is not repeated: the least of its
/// times would be no less than that one's.
const BEYOND: f64 = 4.0;

impl Series {
    /// `others` are those of the same equations so far.
    pub(super) fn new(
        method: Method,
        ready: &mut Prepared,
        truth: &mut Truth,
        effort: &Effort,
        others: &[Series],
    ) -> Self {
        let known: Vec<Measured> =
            others.iter().flat_map(|series| &series.points).filter_map(|p| p.outcome.as_ref().ok().copied()).collect();
        // the two that go down to round-off are worth waiting for
        let reaches = matches!(method, Method::Taylor | Method::Dop853);
        let patience = if reaches { 4.0 * effort.patience } else { effort.patience };
        let mut points = Vec::new();
        for exponent in (3..=method.tightest()).step_by(effort.every) {
            let mut options = Options::with_tolerance(10.0_f64.powi(-exponent));
            options.method = method;
            options.max_steps = effort.max_steps;
            // the first run of a method pays for what it needs of the equations
            let known: &[Measured] = if points.is_empty() { &[] } else { &known };
            let outcome = measure(ready, &options, truth, effort, known);
            let slow = outcome.as_ref().map_or(0.0, |m| m.seconds) > patience;
            points.push(Point { tolerance: options.relative_tolerance, outcome });
            if slow {
                break;
            }
        }
        Series { method, points }
    }
}

fn measure(
    ready: &mut Prepared,
    options: &Options,
    truth: &mut Truth,
    effort: &Effort,
    known: &[Measured],
) -> Result<Measured, String> {
    let (mut seconds, mut total) = (f64::INFINITY, 0.0);
    let mut repeats = 0;
    let mut first: Option<f64> = None;
    loop {
        let clock = Instant::now();
        let run = ready.integrate(truth.end(), options).map_err(|error| error.to_string())?;
        let elapsed = clock.elapsed().as_secs_f64();
        if let Status::Stopped { t, cause } = &run.solution.status {
            return Err(format!("stopped at t = {t:.3}: {cause}"));
        }
        seconds = elapsed.min(seconds);
        total += elapsed;
        repeats += 1;
        // the same in each run
        let error = match first {
            Some(error) => error,
            None => *first.insert(error(&run, ready, truth)?),
        };
        let enough = total >= effort.seconds && repeats >= effort.repeats;
        let beaten = || known.iter().any(|other| other.error <= error && BEYOND * other.seconds < seconds);
        if enough || total > effort.patience || beaten() {
            return Ok(Measured { seconds, error, work: run.solution.work });
        }
    }
}

fn error(run: &SingleRun, ready: &mut Prepared, truth: &mut Truth) -> Result<f64, String> {
    let mut largest = 0.0_f64;
    for (i, t) in truth.times.clone().into_iter().enumerate() {
        let here = run.at(&mut ready.compiled, t).map_err(|error| error.to_string())?.coordinates;
        largest = largest.max(truth.distance(i, &here));
    }
    Ok(largest)
}
