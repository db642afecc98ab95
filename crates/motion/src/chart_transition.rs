//! A chart after the first of a motion, whose outputs are those of the first.

use std::collections::HashMap;

use equations::{Compiled, Equations, Outputs};
use mechanics::{State, System};
use symbolic::Symbol;

use crate::start_values::StartValues;
use crate::{Prepared, SingleRun, SolveError};

/// What charts have in common besides coordinates and velocities.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Quantity {
    /// The momentum of the coordinate of this name.
    Momentum(String),
    /// Another multiplier or invariant of the formulation, which every chart calls alike.
    Derived(String),
    /// An invariant of the user's own, whatever it is called.
    Watched(String),
}

impl Quantity {
    /// What the formulation calls so.
    fn derived(name: &str) -> Quantity {
        match name.strip_prefix("momentum ") {
            Some(coordinate) => Quantity::Momentum(coordinate.into()),
            None => Quantity::Derived(name.into()),
        }
    }
}

/// What is handed over from chart to chart: a state, and multipliers or momenta.
pub(crate) type Point = (State, HashMap<Quantity, f64>);

impl Prepared {
    /// The states at a point, as one run of the same motion may come to.
    pub(crate) fn states_of(&mut self, system: &System, (state, named): &Point) -> Vec<f64> {
        self.values.set(&system.values_at(state));
        self.values.set_constants(&Names::of(&self.equations).constants(named));
        self.values.evaluate().0.to_vec()
    }

    /// Both runs start from these points next.
    pub(crate) fn enter(&mut self, system: &System, [kept, looser]: &[Point; 2]) {
        self.other_start = Some(self.states_of(system, looser));
        self.states_of(system, kept);
        self.t = kept.0.t;
        self.set_constants(&Names::of(&self.equations).constants(&kept.1));
    }
}

/// What the outputs and constants of equations are called in every chart, with the sign that they have there.
#[derive(Clone)]
pub(crate) struct Names {
    /// Of multipliers, then of invariants.
    outputs: Vec<(Quantity, f64)>,
    constants: Vec<(Quantity, f64)>,
    of_removal: bool,
}

impl Names {
    pub(crate) fn of(equations: &Equations) -> Self {
        let g = &equations.graph;
        let mut outputs: Vec<(Quantity, f64)>;
        let constants: Vec<(Quantity, f64)>;
        if let Some(removal) = &equations.removal {
            let memory = equations.free_constants.iter().filter_map(|c| Some(&removal.memory[c.memory?]));
            constants = memory.map(|w| (Quantity::Momentum(g.name(w.symbol)), -1.0)).collect();
            outputs = removal.parameters.iter().map(|u| (Quantity::Momentum(g.name(u.symbol)), 1.0)).collect();
            outputs.extend(constants.iter().cloned());
        } else {
            outputs = equations.multipliers.iter().map(|mu| (Quantity::derived(&mu.name), 1.0)).collect();
            constants = outputs.iter().take(equations.free_constants.len()).cloned().collect();
        }
        let (derived, own) = equations.invariants.split_at(equations.invariants.len() - equations.watched);
        outputs.extend(derived.iter().map(|c| (Quantity::derived(&c.name), 1.0)));
        outputs.extend(own.iter().map(|c| (Quantity::Watched(c.name.clone()), 1.0)));
        Names { outputs, constants, of_removal: equations.removal.is_some() }
    }

    /// State and named quantities; those of a costate that was left out are missing, for they are zero.
    pub(crate) fn handed_over(&self, t: f64, outputs: Outputs) -> Point {
        let values = outputs.multipliers.into_iter().chain(outputs.invariants);
        let named = self.outputs.iter().zip(values).map(|((quantity, sign), x)| (quantity.clone(), sign * x)).collect();
        (State { t, q: outputs.coordinates, v: outputs.velocities }, named)
    }

    /// The free constants.
    pub(crate) fn constants(&self, named: &HashMap<Quantity, f64>) -> Vec<f64> {
        values(&self.constants, named)
    }

    /// Whether all that `others` have has a value here: only costates that are zero may be missing.
    pub(crate) fn give(&self, others: &Names) -> bool {
        let known = |quantity: &Quantity| self.outputs.iter().any(|(own, _)| own == quantity);
        let may_be_zero = |quantity: &Quantity| self.of_removal && matches!(quantity, Quantity::Momentum(_));
        others.outputs.iter().all(|(quantity, _)| known(quantity) || may_be_zero(quantity))
    }
}

/// Each with its sign; zero where it is missing.
fn values(names: &[(Quantity, f64)], named: &HashMap<Quantity, f64>) -> Vec<f64> {
    names.iter().map(|(quantity, sign)| sign * named.get(quantity).copied().unwrap_or(0.0)).collect()
}

/// A chart after the first, whose outputs are those of the first.
#[derive(Clone)]
pub(crate) struct Later {
    compiled: Compiled,
    names: Names,
    first: Names,
    /// Multipliers of the first.
    multipliers: usize,
    /// The states of the first, from `t`, positions, velocities and its constants.
    states: StartValues,
    symbols: Vec<Symbol>,
}

impl Later {
    pub(crate) fn new(system: &System, first: &Prepared, own: &Prepared) -> Self {
        Later {
            compiled: own.compiled.clone(),
            names: Names::of(&own.equations),
            first: Names::of(&first.equations),
            multipliers: first.equations.multipliers.len(),
            states: first.values.clone(),
            symbols: [vec![system.time], system.positions(), system.velocities()].concat(),
        }
    }

    pub(crate) fn outputs(&mut self, run: &SingleRun, t: f64) -> Result<Outputs, SolveError> {
        let (State { q, v, .. }, named) = self.names.handed_over(t, run.at(&mut self.compiled, t)?);
        let mut multipliers = values(&self.first.outputs, &named);
        let invariants = multipliers.split_off(self.multipliers);
        Ok(Outputs { coordinates: q, velocities: v, multipliers, invariants })
    }

    pub(crate) fn states(&mut self, run: &SingleRun, t: f64) -> Result<Vec<f64>, SolveError> {
        let (State { q, v, .. }, named) = self.names.handed_over(t, run.at(&mut self.compiled, t)?);
        let point = [&[t], &q[..], &v].concat();
        self.states.set(&self.symbols.iter().copied().zip(point).collect());
        self.states.set_constants(&self.first.constants(&named));
        Ok(self.states.evaluate().0.to_vec())
    }
}
