//! Start values of the states of derived equations.

use std::collections::HashMap;

use equations::Equations;
use mechanics::{State, complete_removal_start};
use symbolic::{Bounded, Dual, Evaluator, Expr, Scalar, Symbol};

use crate::{Setting, SolveError};

/// The expressions in which a derivation says what motions start from: `t, q, v`, what belongs to a removal,
/// the free constants → the states, guesses for the unknowns of the instant.
#[derive(Clone)]
pub(crate) struct StartValues {
    program: Evaluator<f64>,
    symbols: Vec<Symbol>,
    pub(crate) inputs: Vec<f64>,
    states: usize,
    unknowns: usize,
}

impl StartValues {
    /// At the start of `setting`, with the free constants zero.
    pub(crate) fn new(setting: Setting, equations: &Equations) -> Result<Self, SolveError> {
        let system = setting.system;
        let mut symbols = [system.positions(), system.velocities(), vec![system.time]].concat();
        let mut inputs = [&setting.start.q[..], &setting.start.v, &[setting.start.t]].concat();
        if let Some(removal) = &equations.removal {
            for (symbol, x) in complete_removal_start(system, removal, setting.start)?.values() {
                if !symbols.contains(&symbol) {
                    symbols.push(symbol);
                    inputs.push(x);
                }
            }
        }
        symbols.extend(equations.constant_symbols());
        inputs.resize(symbols.len(), 0.0);
        let mut outputs: Vec<Expr> = equations.states.iter().map(|y| y.start).collect();
        outputs.extend(equations.blocks.iter().flat_map(|b| b.guess.iter().copied()));
        let program = Evaluator::new(equations.tape(&symbols, &outputs)?);
        let (states, unknowns) = (equations.states.len(), equations.unknowns().len());
        Ok(StartValues { program, symbols, inputs, states, unknowns })
    }

    /// The place of a symbol in `inputs`.
    pub(crate) fn place(&self, symbol: Symbol) -> Option<usize> {
        self.symbols.iter().position(|&s| s == symbol)
    }

    /// The number that a symbol has at the start.
    pub(crate) fn value(&self, symbol: Symbol) -> Option<f64> {
        self.place(symbol).map(|place| self.inputs[place])
    }

    /// The place of the first free constant in `inputs`, for this number of them.
    pub(crate) fn first_constant(&self, constants: usize) -> usize {
        self.inputs.len() - constants
    }

    /// Another start of the same system.
    pub(crate) fn set(&mut self, values: &HashMap<Symbol, f64>) {
        for (symbol, input) in self.symbols.iter().zip(&mut self.inputs) {
            *input = values.get(symbol).copied().unwrap_or(*input);
        }
    }

    /// The same, of equations without variables of their own.
    pub(crate) fn set_state(&mut self, State { t, q, v }: &State) {
        let state = q.iter().chain(v).chain([t]);
        self.inputs.iter_mut().zip(state).for_each(|(input, x)| *input = *x);
    }

    pub(crate) fn set_constants(&mut self, constants: &[f64]) {
        let first = self.first_constant(constants.len());
        self.inputs[first..].copy_from_slice(constants);
    }

    /// States that are zero up to round-off: momenta are sums that may cancel.
    pub(crate) fn vanishing(&self) -> Vec<bool> {
        let inputs: Vec<Bounded> = self.inputs.iter().map(|&x| Bounded::from_f64(x)).collect();
        let mut program = Evaluator::new(self.program.tape().clone());
        program.evaluate(&inputs)[..self.states].iter().map(|x: &Bounded| x.may_be_zero()).collect()
    }

    /// The derivative of the states by the input at this place.
    pub(crate) fn derivative(&self, place: usize) -> Vec<f64> {
        let along = |(i, &x): (usize, &f64)| if i == place { Dual::along(x, 0) } else { Dual::from_f64(x) };
        let inputs: Vec<Dual> = self.inputs.iter().enumerate().map(along).collect();
        let mut program = Evaluator::new(self.program.tape().clone());
        program.evaluate(&inputs)[..self.states].iter().map(|x| x.tangents.0[0]).collect()
    }

    /// The states, and the guess for the unknowns of the instant, empty unless each has a derived one.
    pub(crate) fn evaluate(&mut self) -> (&[f64], &[f64]) {
        let (states, guess) = self.program.evaluate(&self.inputs).split_at(self.states);
        (states, if guess.len() == self.unknowns { guess } else { &[] })
    }
}
