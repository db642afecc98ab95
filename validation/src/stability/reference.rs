//! References of motions: closed forms, and equations derived by hand in other variables.

use equations::Formulation;
use integrate::{DenseOutput, EvaluationError, Options, Problem, Start, Status, integrate};
use mechanics::{ConstantsRule, State, System};
use motion::TRUSTED;
use motion::{Choice, Ending, Motion, Setting, Settings, derive_at, solve};
use referees::maggi::{self, Maggi};

/// Coordinates over time.
pub type Road = Box<dyn Fn(f64) -> Vec<f64> + Send + Sync>;

/// `ẏ = F(t, y)`.
pub type Rates = Box<dyn Fn(f64, &[f64], &mut [f64]) + Send + Sync>;

/// Coordinates from `(t, y)`.
pub type Reading = Box<dyn Fn(f64, &[f64]) -> Vec<f64> + Send + Sync>;

/// A system and its start.
pub type Posed = Box<dyn Fn() -> Result<(System, State), String> + Send + Sync>;

/// An independent derivation of the same motion, which does not share the failure that it judges.
pub enum Reference {
    /// The motion in closed form.
    Closed(Road),
    /// Chetaev's motion by Maggi's equations, in the same coordinates with equivalent constraints.
    Maggi(Posed),
    /// The same formulation's motion, free constants zero, same coordinates, equivalent constraints that are
    /// regular where those judged are not. It shares the derivation, not the failure.
    Equivalent {
        /// The system and the start.
        posed: Posed,
        /// The formulation, which has no removal.
        formulation: &'static Formulation,
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

/// Steps of equal length of a long run, and the limit on those of the adaptive methods.
pub const MILLION: usize = 1_000_000;

/// Tolerances of the two runs of an [`Reference::Ode`].
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];

/// Tolerances of the runs of [`Reference::Maggi`] and [`Reference::Equivalent`]: their solves round off more.
const MAGGI: [f64; 2] = [1e-10, 1e-12];

/// Length of a run that is needed only for its start.
const SHORTEST: f64 = 1e-9;

/// A reference up to some time: the coordinates at `t`, and those by a second run, whose distance is the
/// doubt; `None` between its stop and a motion's at the same singularity.
pub type Known<'a> = Box<dyn FnMut(f64) -> Option<(Vec<f64>, Vec<f64>)> + 'a>;

impl Reference {
    /// The reference from `start` (where the state is `y`) to `end`, or why it does not reach it.
    ///
    /// # Errors
    /// The words of the integrator.
    pub fn up_to(&self, start: f64, end: f64) -> Result<Known<'_>, String> {
        // an end is needed even where nothing is to be compared but the start
        let later = if end == start { start + SHORTEST } else { end };
        let same_stop = |t: f64| (later - t).abs() <= TRUSTED * (later - start).abs();
        match self {
            Reference::Closed(road) => Ok(Box::new(move |t| Some((road(t), road(t))))),
            Reference::Maggi(posed) => {
                let (system, state) = posed()?;
                let run = |tolerance: f64| -> Result<maggi::Motion, String> {
                    let mut maggi = Maggi::new(&system).map_err(|error| error.to_string())?;
                    let motion = maggi.solve(&state, later, tolerance).map_err(|error| error.to_string())?;
                    match motion.ending() {
                        Status::Stopped { t, .. } if !same_stop(*t) => Err(format!("the reference stops at {t}")),
                        _ => Ok(motion),
                    }
                };
                let (mut looser, mut kept) = (run(MAGGI[0])?, run(MAGGI[1])?);
                let size = system.dimension();
                Ok(Box::new(move |t| {
                    let read = |run: &mut maggi::Motion| run.state(t).map_or(vec![f64::NAN; size], |state| state.q);
                    (t <= looser.end().min(kept.end())).then(|| (read(&mut kept), read(&mut looser)))
                }))
            }
            Reference::Equivalent { posed, formulation } => {
                let (system, start) = posed()?;
                let mut motion = derived(&system, &start, later, formulation).map_err(|error| error.to_string())?;
                if let Ending::Stopped { t, cause } = &motion.ending
                    && !same_stop(*t)
                {
                    return Err(format!("the reference stops at {t}: {cause}"));
                }
                let unknown = vec![f64::NAN; system.dimension()];
                Ok(Box::new(move |t| {
                    if t > motion.end() {
                        return None;
                    }
                    let both = motion.at_in_both_runs(t).map(|(a, b)| (a.coordinates, b.coordinates));
                    Some(both.unwrap_or_else(|_| (unknown.clone(), unknown.clone())))
                }))
            }
            Reference::Ode { y, read, .. } if end == start => {
                Ok(Box::new(move |_| Some((read(start, y), read(start, y)))))
            }
            Reference::Ode { y, rates, read } => {
                let run = |tolerance: f64| {
                    let mut field = Field { dimension: y.len(), rates };
                    let options = Options { max_steps: 2 * MILLION, ..Options::with_tolerance(tolerance) };
                    let start = Start { t: start, y: y.clone() };
                    let solution = integrate(&mut field, &start, end, &options).map_err(|e| e.to_string())?;
                    match solution.status {
                        Status::Completed => Ok(solution.dense),
                        Status::Stopped { t, cause } => Err(format!("the reference stops at {t}: {cause}")),
                    }
                };
                let (looser, kept) = (run(TOLERANCES[0])?, run(TOLERANCES[1])?);
                let mut y = vec![0.0; y.len()];
                Ok(Box::new(move |t| {
                    let mut at = |run: &DenseOutput| {
                        run.evaluate(t, &mut y);
                        read(t, &y)
                    };
                    Some((at(&kept), at(&looser)))
                }))
            }
        }
    }
}

fn derived(
    system: &System,
    start: &State,
    end: f64,
    formulation: &'static Formulation,
) -> Result<Motion, motion::SolveError> {
    let constants = ConstantsRule::Zero;
    let choice = Choice { label: formulation.title.into(), formulation, removal: None, constants: constants.clone() };
    let settings = Settings { tolerance: MAGGI[0], max_steps: 2 * MILLION, ..Settings::default() };
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
}
