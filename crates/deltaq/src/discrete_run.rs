//! A discrete motion as states of the derived equations.

use discrete::{DiscreteError, Trajectory};
use equations::{Compiled, Equations};
use mechanics::System;
use symbolic::Symbol;

use crate::SolveError;
use crate::start_values::StartValues;

/// A discrete trajectory; its `(x, v, ν)` give states `y` by the derivation's expressions of start values.
#[derive(Clone)]
pub(crate) struct DiscreteRun {
    trajectory: Trajectory,
    values: StartValues,
    /// Where the time, the `x`, the `v` and the multipliers go in the inputs of `values`, and which of these.
    time: usize,
    positions: Vec<(usize, usize)>,
    rates: Vec<(usize, usize)>,
    multipliers: Vec<(usize, usize)>,
}

impl DiscreteRun {
    pub(crate) fn new(trajectory: Trajectory, mut values: StartValues, equations: &Equations, system: &System) -> Self {
        let places = |of: &[Symbol]| of.iter().enumerate().filter_map(|(i, &s)| Some((values.place(s)?, i))).collect();
        let (x, v) = match &equations.removal {
            None => (system.positions(), system.velocities()),
            Some(removal) => {
                let memory = removal.memory.iter().map(|w| w.symbol);
                let x = removal.parameters.iter().map(|u| u.symbol).chain(memory).collect();
                (x, removal.parameters.iter().map(|u| u.rate).collect())
            }
        };
        let constants = &equations.free_constants;
        let first = values.first_constant(constants.len());
        let (time, positions, rates) = (values.place(system.time).unwrap_or(0), places(&x), places(&v));
        // what a discrete motion does not know may not be asked for
        values.inputs.fill(f64::NAN);
        let multipliers = constants.iter().enumerate().map(|(i, c)| (first + i, c.memory.unwrap_or(i))).collect();
        DiscreteRun { trajectory, values, time, positions, rates, multipliers }
    }

    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.times()[0], self.trajectory.end()]
    }

    pub(crate) fn times(&self) -> &[f64] {
        self.trajectory.times()
    }

    /// Writes the state at `t`; sets the guess from which the equations of the instant are solved.
    pub(crate) fn state(&mut self, compiled: &mut Compiled, t: f64, state: &mut [f64]) -> Result<(), SolveError> {
        let sample = self.trajectory.at(t)?;
        self.values.inputs[self.time] = t;
        for (places, values) in
            [(&self.positions, &sample.x), (&self.rates, &sample.v), (&self.multipliers, &sample.multipliers)]
        {
            for &(place, i) in places {
                self.values.inputs[place] = values[i];
            }
        }
        let (y, guess) = self.values.evaluate();
        if let Some(&found) = y.iter().chain(guess).find(|x| !x.is_finite()) {
            return Err(DiscreteError::NotFinite { what: "a state", found, t }.into());
        }
        state.copy_from_slice(y);
        if compiled.needs_guess() && !guess.is_empty() {
            compiled.set_guess(guess);
        }
        Ok(())
    }
}
