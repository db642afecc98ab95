//! The motion in time: `(q, v)` with `v' = a` of [`Maggi::accelerations`].

use integrate::{EvaluationError, Options, Problem, Projection, Solution, Start, Status};
use mechanics::State;
use symbolic::limits::NOTHING;

use super::{Maggi, MaggiError};

/// A motion, as far as it came.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The integrator's solution, `(q, v)`; [`Motion::state`] reads it.
    pub solution: Solution,
    y: Vec<f64>,
}

impl Motion {
    /// How the run ended; where `A` or the stacked matrix became singular, with the words of [`MaggiError`].
    /// Whatever it says, the motion is valid up to [`Motion::end`].
    pub fn ending(&self) -> &Status {
        &self.solution.status
    }

    /// How far the motion came.
    pub fn end(&self) -> f64 {
        self.solution.dense.end()
    }

    /// Time, positions and velocities at `t`.
    ///
    /// # Errors
    /// [`MaggiError::Dense`] for a time that the motion does not have.
    pub fn state(&mut self, t: f64) -> Result<State, MaggiError> {
        self.solution.dense.try_evaluate(t, &mut self.y)?;
        let (q, v) = self.y.split_at(self.y.len() / 2);
        Ok(State { t, q: q.to_vec(), v: v.to_vec() })
    }
}

/// See [`Maggi::solve`].
pub(super) fn solve(maggi: &mut Maggi, start: &State, end: f64, tolerance: f64) -> Result<Motion, MaggiError> {
    let State { t, q, v } = start;
    maggi.accelerations(*t, q, v)?;
    let found = maggi.constraint_residual(*t, q, v)?;
    if found > NOTHING {
        return Err(MaggiError::OffConstraint { found, limit: NOTHING });
    }
    let start = Start { t: *t, y: [&q[..], v].concat() };
    let options = Options { projection: Projection::Off, ..Options::with_tolerance(tolerance) };
    let solution = integrate::integrate(&mut Run { maggi }, &start, end, &options)?;
    Ok(Motion { solution, y: start.y })
}

/// What the integrator integrates.
struct Run<'a> {
    maggi: &'a mut Maggi,
}

impl Problem for Run<'_> {
    fn dimension(&self) -> usize {
        2 * self.maggi.n
    }

    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        let (q, v) = y.split_at(self.maggi.n);
        let (q_rates, v_rates) = rates.split_at_mut(self.maggi.n);
        q_rates.copy_from_slice(v);
        let done = self.maggi.write_accelerations(t, q, v, v_rates);
        done.map_err(|error| EvaluationError { reason: error.to_string() })
    }
}
