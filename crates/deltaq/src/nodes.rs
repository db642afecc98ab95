//! A discrete motion as states of the derived equations.

use discrete::{DiscreteError, Trajectory};
use equations::Compiled;
use mechanics::System;
use symbolic::{Symbol, Tape, Workspace};

use crate::SolveError;
use crate::run::Prepared;

/// A discrete trajectory, with what makes states `y` of its `(x, v, ν)`: the expressions in which the derivation says what motions start from.
#[derive(Clone)]
pub(crate) struct Nodes {
    trajectory: Trajectory,
    tape: Tape,
    workspace: Workspace<f64>,
    inputs: Vec<f64>,
    outputs: Vec<f64>,
    states: usize,
    /// Where the time, the `x`, the `v` and the multipliers go in `inputs`, and which of these.
    time: usize,
    positions: Vec<(usize, usize)>,
    rates: Vec<(usize, usize)>,
    multipliers: Vec<(usize, usize)>,
}

impl Nodes {
    pub(crate) fn new(trajectory: Trajectory, prepared: &Prepared, system: &System) -> Self {
        let symbols = &prepared.start_symbols;
        let place = |symbol: Symbol| symbols.iter().position(|&s| s == symbol);
        let places = |of: &[Symbol]| of.iter().enumerate().filter_map(|(i, &s)| Some((place(s)?, i))).collect();
        let (x, v) = match &prepared.equations.removal {
            None => (system.positions(), system.velocities()),
            Some(removal) => {
                let memory = removal.memory.iter().map(|w| w.symbol);
                let x = removal.parameters.iter().map(|u| u.symbol).chain(memory).collect();
                (x, removal.parameters.iter().map(|u| u.rate).collect())
            }
        };
        let constants = &prepared.equations.free_constants;
        let first = symbols.len() - constants.len();
        Nodes {
            trajectory,
            workspace: prepared.start_tape.workspace(),
            outputs: vec![0.0; prepared.start_tape.outputs()],
            states: prepared.equations.states.len(),
            tape: prepared.start_tape.clone(),
            // what a discrete motion does not know may not be asked for
            inputs: vec![f64::NAN; symbols.len()],
            time: place(system.time).unwrap_or(0),
            positions: places(&x),
            rates: places(&v),
            multipliers: constants.iter().enumerate().map(|(i, c)| (first + i, c.memory.unwrap_or(i))).collect(),
        }
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
        self.inputs[self.time] = t;
        for (places, values) in
            [(&self.positions, &sample.x), (&self.rates, &sample.v), (&self.multipliers, &sample.multipliers)]
        {
            for &(place, i) in places {
                self.inputs[place] = values[i];
            }
        }
        self.tape.evaluate(&self.inputs, &mut self.workspace, &mut self.outputs);
        if let Some(&found) = self.outputs.iter().find(|x| !x.is_finite()) {
            return Err(DiscreteError::NotFinite { what: "a state", found, t }.into());
        }
        let (y, guess) = self.outputs.split_at(self.states);
        state.copy_from_slice(y);
        if compiled.needs_guess() && !guess.is_empty() {
            compiled.set_guess(guess);
        }
        Ok(())
    }
}
