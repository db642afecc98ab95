//! The start of a motion, and the settings of its integration.

use integrate::{Interrupt, Method, Options, Projection};
use mechanics::{State, System};
use scene::Scene;

use crate::{Form, SolveError};

/// The tolerance of the second run over that of the first.
pub const TIGHTER: f64 = 1e-2;

/// A gap has to be this many times the sum of the two error estimates to count as a difference.
pub const CERTAINTY: f64 = 10.0;

/// The start of a motion: a system, a state on its constraint, and the end time.
#[derive(Clone, Copy)]
pub struct Setting<'a> {
    /// The system.
    pub system: &'a System,
    /// `(t₀, q₀, v₀)`.
    pub start: &'a State,
    /// Time at which the motion is to end.
    pub end: f64,
}

/// What every motion of a scene starts from.
pub fn setting(scene: &Scene) -> Setting<'_> {
    Setting { system: &scene.system, start: &scene.start, end: scene.start.t + scene.duration }
}

/// How a motion is integrated.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Tolerance of the first run; the second, whose trajectory is kept, has [`TIGHTER`] times this.
    pub tolerance: f64,
    /// Method; `None`: the one that suits the equations and, where many steps are ahead, the motion:
    /// [`Method::Taylor`], or else [`Method::Dop853`] or [`Method::Radau5`].
    pub method: Option<Method>,
    /// Projection onto the constraint after every step.
    pub projection: Projection,
    /// Limit on the steps of one run.
    pub max_steps: usize,
    /// No step of the first run is longer, none of the second than half of it: equal steps would hide their
    /// error. > 0, infinite without a limit. Steps of a given length do not heed it.
    pub max_step: f64,
    /// Limit on the seconds of one run, wall clock; for a search of constants and for the members of an
    /// ensemble on all runs together. None by default: results then do not depend on the machine.
    pub time_limit: Option<f64>,
    /// In which form [`crate::solve_choice`] and ensembles take the equations.
    pub form: Form,
    /// All unknowns of an instant by LU factorization, as derived; otherwise in the form that
    /// [`equations::Plan::choose`] finds cheapest. The motion is the same to round-off, and is not held
    /// against the system's own constraints: its outputs may be coordinates of another one.
    pub plain: bool,
    /// Times at which the motion will be read off, if they are all known: a run whose steps take much memory
    /// keeps these, those at which a motion is looked at anyway, and nothing else ([`SolveError::Dense`]).
    pub times: Option<Vec<f64>>,
    /// The flag by which another thread ends all runs: what is under way then stops early, or is refused.
    pub interrupt: Option<Interrupt>,
}

impl Default for Settings {
    fn default() -> Self {
        let (method, projection) = (None, Projection::EveryStep);
        let (max_steps, max_step, time_limit, interrupt) = (1_000_000, f64::INFINITY, None, None);
        let (form, plain, times) = (Form::Suited, false, None);
        Settings {
            tolerance: 1e-11,
            method,
            projection,
            max_steps,
            max_step,
            time_limit,
            form,
            plain,
            times,
            interrupt,
        }
    }
}

/// Below this tolerance is round-off.
pub const LEAST_TOLERANCE: f64 = 1e-15;

impl Settings {
    /// How motions that are compared are integrated.
    pub fn protocol() -> Settings {
        // twice what any motion of the catalogue takes that does not run into a singularity
        Settings { max_steps: 200_000, ..Settings::default() }
    }

    /// Refuses a tolerance with which no run would be right.
    ///
    /// # Errors
    /// [`SolveError::Tolerance`].
    ///
    /// ```
    /// use motion::Settings;
    /// let refused = Settings { tolerance: 1e-300, ..Settings::default() }.check().unwrap_err();
    /// assert_eq!(refused.to_string(), "the tolerance 1e-300 is below round-off; the least is 1e-15");
    /// ```
    pub fn check(&self) -> Result<(), SolveError> {
        let tolerance = self.tolerance;
        match (LEAST_TOLERANCE..1.0).contains(&tolerance) {
            true => Ok(()),
            false => Err(SolveError::Tolerance { tolerance, least: LEAST_TOLERANCE }),
        }
    }

    /// Of one run at `tolerance` that begins now.
    pub fn options(&self, tolerance: f64) -> Options {
        let interrupt = match self.time_limit {
            Some(seconds) => Some(self.interrupt.clone().unwrap_or_default().within(seconds)),
            None => self.interrupt.clone(),
        };
        Options {
            method: self.method.unwrap_or(Method::Taylor),
            projection: self.projection,
            max_steps: self.max_steps,
            max_step: if tolerance < self.tolerance { 0.5 * self.max_step } else { self.max_step },
            interrupt,
            ..Options::with_tolerance(tolerance)
        }
    }
}
