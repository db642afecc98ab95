//! When values are known: time derivatives, and what is computed one order ahead for them.

use rustc_hash::{FxHashMap, FxHashSet};

use super::Builder;
use super::motion::Motion;
use crate::programs::program::{Id, Value};
use crate::series::SeriesInput;

/// When a value is known, from one order to the next.
pub(super) type Stage = usize;

/// Constant in time.
pub(super) const STEADY: Stage = 0;
/// One order before all others.
pub(super) const AHEAD: Stage = 1;
/// Without time derivatives and unknowns.
const PLAIN: Stage = 2;
/// Without unknowns; with those of block b: `DERIVED + 1 + b`.
pub(super) const DERIVED: Stage = 3;

impl Builder<'_> {
    pub(super) fn extend_stages(&mut self) {
        for id in self.stages.len()..self.program.len() {
            let stage = self.stage_of(id as Id, |o| self.stages[o as usize]);
            self.stages.push(stage);
        }
    }

    fn stage_of(&self, id: Id, of: impl Fn(Id) -> Stage) -> Stage {
        let value = self.program.value(id);
        match value {
            _ if self.derivatives.contains_key(&id) => DERIVED,
            _ if self.ahead.contains(&id) => AHEAD,
            Value::Input(i) => match self.inputs[i as usize] {
                SeriesInput::Steady => STEADY,
                SeriesInput::Time if !self.derivatives.is_empty() => AHEAD,
                SeriesInput::Time | SeriesInput::State(_) => PLAIN,
                SeriesInput::Unknown(block) => DERIVED + 1 + block,
            },
            _ if self.integrated.contains_key(&id) => PLAIN,
            _ => {
                let (operands, count) = value.operands();
                operands[..count].iter().map(|o| of(*o)).max().unwrap_or(STEADY)
            }
        }
    }

    /// Finds the functions that are integrated, and which of `declared` serve as time derivatives: what they
    /// are the derivatives of can be known one order ahead.
    pub(super) fn declare(&mut self, declared: impl Iterator<Item = (Id, Id)>) {
        let mut derivatives: FxHashMap<Id, Id> = FxHashMap::default();
        for (derivative, of) in declared {
            let moves = self.varies(derivative) && self.motions[derivative as usize] == Motion::Any;
            if moves && of < derivative && self.varies(of) {
                derivatives.entry(derivative).or_insert(of);
            }
        }
        loop {
            (self.derivatives, self.ahead) = (derivatives.clone(), FxHashSet::default());
            self.integrated.clear();
            let used = self.integrate_functions();
            self.restage();
            let before = derivatives.len();
            derivatives.retain(|derivative, _| used.contains(derivative));
            let leaves = self.reach(derivatives.values().copied(), true);
            let rates = leaves.iter().filter_map(|leaf| self.rate_of(*leaf));
            let behind = self.reach(rates, false);
            derivatives.retain(|derivative, _| !behind.contains(derivative));
            if derivatives.len() == before {
                let late: FxHashSet<Id> = leaves.iter().copied().filter(|leaf| !self.leads(*leaf)).collect();
                derivatives.retain(|_, of| late.is_empty() || self.reach([*of], true).is_disjoint(&late));
                self.ahead = leaves;
            }
            if derivatives.len() == before {
                self.restage();
                return;
            }
        }
    }

    /// Whether a series is not made of others of the same order: of states, unknowns, and time derivatives.
    fn is_leaf(&self, id: Id) -> bool {
        let input = matches!(self.program.value(id), Value::Input(i) if self.inputs[i as usize] != SeriesInput::Time);
        self.varies(id) && (input || self.integrated.contains_key(&id) || self.derivatives.contains_key(&id))
    }

    /// What values are made of: leaves, or all.
    fn reach(&self, values: impl IntoIterator<Item = Id>, leaves: bool) -> FxHashSet<Id> {
        let mut seen = FxHashSet::default();
        let mut pending: Vec<Id> = values.into_iter().collect();
        while let Some(id) = pending.pop() {
            if seen.insert(id) && !self.is_leaf(id) {
                let (operands, count) = self.program.value(id).operands();
                pending.extend(&operands[..count]);
            }
        }
        seen.retain(|id| !leaves || self.is_leaf(*id));
        seen
    }

    /// Whether the rate of a leaf is known without time derivatives and unknowns.
    fn leads(&self, leaf: Id) -> bool {
        match self.rate_of(leaf) {
            Some(rate) => self.stages[rate as usize] < DERIVED,
            None => false,
        }
    }

    fn restage(&mut self) {
        self.stages.clear();
        self.extend_stages();
    }

    /// The rate of a state or of a function that is integrated.
    fn rate_of(&self, leaf: Id) -> Option<Id> {
        match self.program.value(leaf) {
            Value::Input(i) => match self.inputs[i as usize] {
                SeriesInput::State(rate) => Some(self.outputs[rate]),
                _ => None,
            },
            _ => self.integrated.get(&leaf).map(|i| i.rate),
        }
    }
}
