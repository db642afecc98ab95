//! Compiled programs in numbers that carry the sum of magnitudes behind them ([`Bounded`]).

use symbolic::{Bounded, Evaluator};

use crate::blocks::CompiledBlock;
use crate::plan::Plan;
use crate::planned::{Planned, gather};

/// Those of compiled equations.
#[derive(Clone)]
pub(crate) struct Terms {
    pub(crate) rates: Evaluator<Bounded>,
    pub(crate) outputs: Evaluator<Bounded>,
    pub(crate) steep: Evaluator<Bounded>,
    pub(crate) blocks: Vec<Evaluator<Bounded>>,
    pub(crate) planned: Option<PlannedTerms>,
}

/// Rates and outputs of a plan. An elimination in a fixed order may add up more than a factorization.
#[derive(Clone)]
pub(crate) struct PlannedTerms {
    rates: Evaluator<Bounded>,
    outputs: Evaluator<Bounded>,
    watched: bool,
    places: Vec<usize>,
    inputs: Vec<Bounded>,
}

impl PlannedTerms {
    fn new(planned: &Planned) -> PlannedTerms {
        let inputs = vec![Bounded { value: 0.0, magnitude: 0.0 }; planned.places.len()];
        let [rates, outputs] = [&planned.rates, &planned.outputs].map(again);
        PlannedTerms { rates, outputs, watched: planned.watched, places: planned.places.clone(), inputs }
    }

    /// What was added up to rates where the plan is trusted, if that is more than `magnitudes`.
    pub(crate) fn rates(&mut self, inputs: &[Bounded], magnitudes: &mut [f64]) {
        let inputs = gather(&mut self.inputs, &self.places, inputs);
        raise(magnitudes, self.rates.evaluate(inputs), self.watched);
    }

    /// As [`PlannedTerms::rates`].
    pub(crate) fn outputs(&mut self, inputs: &[Bounded], magnitudes: &mut [f64]) {
        let inputs = gather(&mut self.inputs, &self.places, inputs);
        raise(magnitudes, self.outputs.evaluate(inputs), self.watched);
    }
}

fn raise(magnitudes: &mut [f64], values: &[Bounded], watched: bool) {
    let (wanted, condition) = values.split_at(values.len() - usize::from(watched));
    if condition.iter().all(|x| x.value <= Plan::LIMIT) && wanted.iter().all(|x| x.value.is_finite()) {
        magnitudes.iter_mut().zip(wanted).for_each(|(m, x)| *m = m.max(x.magnitude));
    }
}

fn again(program: &Evaluator<f64>) -> Evaluator<Bounded> {
    Evaluator::new(program.tape().clone())
}

impl Terms {
    /// Of rates, outputs, arguments of steep functions, blocks, and the plan that takes their place.
    pub(crate) fn new(programs: [&Evaluator<f64>; 3], blocks: &[CompiledBlock], planned: Option<&Planned>) -> Terms {
        let [rates, outputs, steep] = programs.map(again);
        let blocks = blocks.iter().map(|block| again(&block.program)).collect();
        Terms { rates, outputs, steep, blocks, planned: planned.map(PlannedTerms::new) }
    }
}
