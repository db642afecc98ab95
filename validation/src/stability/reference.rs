//! What a motion should have been: closed forms, and equations derived by hand in other variables.

use integrate::{DenseOutput, EvaluationError, Options, Problem, Start, integrate};

/// Coordinates over time.
pub type Road = Box<dyn Fn(f64) -> Vec<f64> + Send + Sync>;

/// `ẏ = F(t, y)`.
pub type Rates = Box<dyn Fn(f64, &[f64], &mut [f64]) + Send + Sync>;

/// Coordinates from `(t, y)`.
pub type Reading = Box<dyn Fn(f64, &[f64]) -> Vec<f64> + Send + Sync>;

/// A road to the same motion that does not share the failure of what it judges.
pub enum Reference {
    /// The motion in closed form.
    Closed(Road),
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
    /// The coordinates at `t`, and those by a second run, whose distance is what they may be off by.
    pub fn at(&mut self, t: f64) -> (Vec<f64>, Vec<f64>) {
        match self {
            Known::Closed(road) => {
                let q = road(t);
                (q.clone(), q)
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
        }
    }
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
