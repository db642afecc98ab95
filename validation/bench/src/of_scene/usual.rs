//! The default run: only the tolerance is given.

use integrate::Method;
use motion::{Choice, Setting, Settings, error_estimate, solve_from};

use super::{Effort, Truth};

/// A motion in the form and by the method that are chosen, as [`motion::solve_from`] gives it.
#[derive(Clone, Debug)]
pub struct Usual {
    /// Name of the form.
    pub form: &'static str,
    /// The method.
    pub method: Option<Method>,
    /// Seconds of both runs, least of several; to derive and compile stands apart.
    pub seconds: f64,
    /// Largest distance of the motion from the reference, in the kinetic metric.
    pub error: f64,
    /// Its own error estimate.
    pub estimate: f64,
}

impl Usual {
    /// Up to the end of the reference; `choice` has its constants in numbers.
    pub(super) fn new(setting: Setting, choice: &Choice, truth: &mut Truth, effort: &Effort) -> Result<Self, String> {
        let setting = Setting { end: truth.end(), ..setting };
        let settings = Settings { max_steps: effort.max_steps, ..Settings::default() };
        let (mut seconds, mut total) = (f64::INFINITY, 0.0);
        let mut repeats = 0;
        loop {
            repeats += 1;
            let mut motion = solve_from(setting, choice, &settings).map_err(|error| error.to_string())?;
            seconds = motion.seconds.integrate.min(seconds);
            total += motion.seconds.integrate;
            if !motion.is_complete() {
                return Err(motion.ending.status(None).1.unwrap_or_default());
            }
            if (total >= effort.seconds || total > effort.patience) && repeats >= effort.repeats {
                let mut error = 0.0_f64;
                for (i, t) in truth.times.clone().into_iter().enumerate() {
                    let here = motion.at(t).map_err(|error| error.to_string())?.coordinates;
                    error = error.max(truth.distance(i, &here));
                }
                let estimate = error_estimate(&mut motion, setting).map_err(|error| error.to_string())?.absolute;
                let method = motion.method.as_ref().map(|chosen| chosen.method);
                return Ok(Usual { form: motion.form.chosen.name, method, seconds, error, estimate });
            }
        }
    }
}
