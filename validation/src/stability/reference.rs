//! What a motion should have been: closed forms, and equations derived by hand in other variables.

use deltaq::{Choice, Ending, Motion, Setting, Settings, derive_at, solve};
use integrate::{DenseOutput, EvaluationError, Options, Problem, Start, integrate};
use mechanics::{ConstantsRule, State, System};
use referees::maggi::{self, Form, Maggi};

/// Coordinates over time.
pub type Road = Box<dyn Fn(f64) -> Vec<f64> + Send + Sync>;

/// `ẏ = F(t, y)`.
pub type Rates = Box<dyn Fn(f64, &[f64], &mut [f64]) + Send + Sync>;

/// Coordinates from `(t, y)`.
pub type Reading = Box<dyn Fn(f64, &[f64]) -> Vec<f64> + Send + Sync>;

/// A system and its start.
pub type Posed = Box<dyn Fn() -> Result<(System, State), String> + Send + Sync>;

/// A road to the same motion that does not share the failure of what it judges.
pub enum Reference {
    /// The motion in closed form.
    Closed(Road),
    /// Chetaev's motion by Maggi's equations, of a system in the same coordinates with equivalent constraints.
    Maggi(Posed),
    /// The motion of the same formulation, free constants zero, of a system in the same coordinates with equivalent constraints that are
    /// regular where those judged are not. It does not share the failure, but it shares the derivation.
    Equivalent {
        /// The system and the start.
        posed: Posed,
        /// The formulation, which has no removal.
        formulation: &'static str,
    },
    /// Equations in other variables, derived by hand and well conditioned where the judged ones are not.
    Ode {
        /// `y(t₀)`.
        y: Vec<f64>,
        /// `F`.
        rates: Rates,
        /// From `(t, y)` to the coordinates of the judged motion.
        read: Reading,
    },
}

/// Tolerances of the two runs of an [`Reference::Ode`], and the limit on their steps.
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];
const STEPS: usize = 2_000_000;

/// Tolerances of the two runs of a [`Reference::Maggi`] and of a [`Reference::Equivalent`], whose solves of one instant leave more round-off.
const MAGGI: [f64; 2] = [1e-10, 1e-12];

/// A reference that stops within this part of the time before the motion stops at the same singularity; nothing is compared in between.
const SAME_STOP: f64 = 1e-3;

/// Length of a run that is needed only for its start.
const SHORTEST: f64 = 1e-9;

/// A reference, known up to some time.
pub enum Known<'a> {
    /// At any time.
    Closed(&'a Road),
    /// At the start only.
    Start {
        /// How the state is read.
        read: &'a Reading,
        /// The start.
        t: f64,
        /// The state there.
        y: &'a [f64],
    },
    /// From two runs of Maggi's equations, the second one tighter.
    Maggi(Box<[maggi::Motion; 2]>),
    /// From the two runs of a motion.
    Motion(Box<Motion>),
    /// From two runs, the second one tighter.
    Runs {
        /// How the states are read.
        read: &'a Reading,
        /// The looser and the tighter run.
        runs: Box<[DenseOutput; 2]>,
    },
}

impl Reference {
    /// The reference from `start` (where the state is `y`) to `end`, or why it does not reach it.
    ///
    /// # Errors
    /// The words of the integrator.
    pub fn up_to(&self, start: f64, end: f64) -> Result<Known<'_>, String> {
        match self {
            Reference::Maggi(posed) => {
                let (system, state) = posed()?;
                let run = |tolerance: f64| -> Result<maggi::Motion, String> {
                    let mut maggi = Maggi::new(&system).map_err(|error| error.to_string())?;
                    // an end is needed even where nothing is to be compared but the start
                    let end = if end == start { start + SHORTEST } else { end };
                    let motion =
                        maggi.solve(&state, end, tolerance, Form::Accelerations).map_err(|error| error.to_string())?;
                    match motion.ending() {
                        maggi::Ending::Completed => Ok(motion),
                        // at the same singularity
                        maggi::Ending::Stopped { t, .. } if (end - t).abs() <= SAME_STOP * (end - start).abs() => {
                            Ok(motion)
                        }
                        other => Err(format!("the reference stops: {other:?}")),
                    }
                };
                Ok(Known::Maggi(Box::new([run(MAGGI[0])?, run(MAGGI[1])?])))
            }
            Reference::Equivalent { posed, formulation } => {
                let (system, start) = posed()?;
                let end = if end == start.t { start.t + SHORTEST } else { end };
                let motion = derived(&system, &start, end, formulation).map_err(|error| error.to_string())?;
                match &motion.ending {
                    Ending::Stopped { t, cause } if (end - t).abs() > SAME_STOP * (end - start.t).abs() => {
                        Err(format!("the reference stops at {t}: {cause}"))
                    }
                    _ => Ok(Known::Motion(Box::new(motion))),
                }
            }
            Reference::Ode { y, read, .. } if end == start => Ok(Known::Start { read, t: start, y }),
            Reference::Closed(road) => Ok(Known::Closed(road)),
            Reference::Ode { y, rates, read } => {
                let run = |tolerance: f64| {
                    let mut field = Field { dimension: y.len(), rates };
                    let options = Options { max_steps: STEPS, ..Options::with_tolerance(tolerance) };
                    let start = Start { t: start, y: y.clone() };
                    let solution = integrate(&mut field, &start, end, &options).map_err(|e| e.to_string())?;
                    match solution.status {
                        integrate::Status::Completed => Ok(solution.dense),
                        integrate::Status::Stopped { t, cause } => Err(format!("the reference stops at {t}: {cause}")),
                    }
                };
                Ok(Known::Runs { read, runs: Box::new([run(TOLERANCES[0])?, run(TOLERANCES[1])?]) })
            }
        }
    }
}

impl Known<'_> {
    /// The coordinates at `t`, and those by a second run, whose distance is what they may be off by; `None` between where the reference stops and where
    /// a motion stops at the same singularity.
    pub fn at(&mut self, t: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        Some(match self {
            Known::Closed(road) => {
                let q = road(t);
                (q.clone(), q)
            }
            Known::Maggi(runs) => {
                let [looser, kept] = &mut **runs;
                if t > looser.end().min(kept.end()) {
                    return None;
                }
                let read = |run: &mut maggi::Motion| {
                    let size = run.solution.dense.dimension();
                    run.state(t).map_or_else(|_| vec![f64::NAN; size], |state| state.q)
                };
                (read(kept), read(looser))
            }
            Known::Motion(motion) => {
                if t > motion.end() {
                    return None;
                }
                let size = motion.equations.coordinates.len();
                motion.at_in_both_runs(t).map_or_else(
                    |_| (vec![f64::NAN; size], vec![f64::NAN; size]),
                    |(a, b)| (a.coordinates, b.coordinates),
                )
            }
            Known::Start { read, t, y } => (read(*t, y), read(*t, y)),
            Known::Runs { read, runs } => {
                let mut y = vec![0.0; runs[0].dimension()];
                let [looser, kept] = &**runs;
                looser.evaluate(t, &mut y);
                let second = read(t, &y);
                kept.evaluate(t, &mut y);
                (read(t, &y), second)
            }
        })
    }
}

fn derived(system: &System, start: &State, end: f64, formulation: &'static str) -> Result<Motion, deltaq::SolveError> {
    let constants = ConstantsRule::Zero;
    let choice = Choice { label: formulation.into(), formulation, removal: None, constants: constants.clone() };
    let settings = Settings { tolerance: MAGGI[0], max_steps: STEPS, ..Settings::default() };
    solve(Setting { system, start, end }, derive_at(system, start, &choice)?, &constants, &settings)
}

struct Field<'a> {
    dimension: usize,
    rates: &'a Rates,
}

impl Problem for Field<'_> {
    fn dimension(&self) -> usize {
        self.dimension
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        (self.rates)(t, y, rates);
        Ok(())
    }
    fn jacobian(&mut self, t: f64, _: &[f64], _: &mut [f64]) -> Result<(), EvaluationError> {
        Err(EvaluationError { reason: format!("a reference has no Jacobian, asked for at t = {t}") })
    }
}
