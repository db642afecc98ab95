//! Rates and outputs of a plan, as straight-line programs.

use symbolic::{CompileError, Evaluator, Expr, Scalar, Symbol};

use crate::equations::Equations;
use crate::plan::Plan;

/// Compiled definitions: one tape for rates and one for outputs, each without what only the other needs.
#[derive(Clone)]
pub(crate) struct Planned<T = f64> {
    pub(crate) rates: Evaluator<T>,
    outputs: Evaluator<T>,
    watched: bool,
    /// Places in `(t, y, constants, z)` of what the tapes take.
    pub(crate) places: Vec<usize>,
    inputs: Vec<T>,
}

/// A program in another number type.
pub(crate) fn again<T: Scalar>(program: &Evaluator<f64>) -> Evaluator<T> {
    Evaluator::new(program.tape().clone())
}

impl Planned {
    /// `all`: symbols of `t, y`, the constants and the unknowns.
    pub(crate) fn new(
        equations: &Equations,
        plan: &Plan,
        all: &[Symbol],
        outputs: &[Expr],
    ) -> Result<Self, CompileError> {
        let places = plan.places(equations);
        let inputs: Vec<Symbol> = places.iter().map(|&i| all[i]).collect();
        let definitions = plan.all_definitions(equations);
        let program = |wanted: &[Expr]| {
            let condition = plan.condition.as_slice();
            equations.evaluator_by(&definitions, &inputs, &[wanted, condition].concat())
        };
        Ok(Planned {
            rates: program(&plan.rates(equations))?,
            outputs: program(outputs)?,
            watched: plan.condition.is_some(),
            inputs: vec![0.0; places.len()],
            places,
        })
    }

    /// Whether the definitions can be trusted at these values; where they always can, that costs nothing.
    pub(crate) fn is_trusted(&mut self, values: &[f64]) -> bool {
        !self.watched || self.trusted_rates(values).is_some()
    }

    /// Number of instructions of one evaluation of the rates.
    pub(crate) fn len(&self) -> usize {
        self.rates.tape().len()
    }

    /// The rates; `None` where they cannot be trusted.
    pub(crate) fn trusted_rates(&mut self, values: &[f64]) -> Option<&[f64]> {
        trusted(self.rates(values))
    }

    /// As [`Planned::trusted_rates`].
    pub(crate) fn trusted_outputs(&mut self, values: &[f64]) -> Option<&[f64]> {
        trusted(self.outputs(values))
    }

    /// The same in another number type.
    pub(crate) fn again<T: Scalar>(&self) -> Planned<T> {
        Planned {
            rates: again(&self.rates),
            outputs: again(&self.outputs),
            watched: self.watched,
            places: self.places.clone(),
            inputs: vec![T::from_f64(0.0); self.places.len()],
        }
    }
}

impl<T: Scalar> Planned<T> {
    /// The rates, and the condition if that is watched.
    pub(crate) fn rates(&mut self, values: &[T]) -> (&[T], &[T]) {
        let inputs = gather(&mut self.inputs, &self.places, values);
        apart(self.rates.evaluate(inputs), self.watched)
    }

    /// The outputs, in the same way.
    pub(crate) fn outputs(&mut self, values: &[T]) -> (&[T], &[T]) {
        let inputs = gather(&mut self.inputs, &self.places, values);
        apart(self.outputs.evaluate(inputs), self.watched)
    }
}

/// What the tapes take; nothing is copied where it stands together.
fn gather<'a, T: Copy>(room: &'a mut [T], places: &[usize], values: &'a [T]) -> &'a [T] {
    let count = places.len();
    if places.last().is_none_or(|&last| last < count) {
        return &values[..count];
    }
    for (x, &place) in room.iter_mut().zip(places) {
        *x = values[place];
    }
    room
}

fn apart<T>(values: &[T], watched: bool) -> (&[T], &[T]) {
    values.split_at(values.len() - usize::from(watched))
}

fn trusted<'a>((wanted, condition): (&'a [f64], &[f64])) -> Option<&'a [f64]> {
    let safe = condition.iter().all(|&x| x <= Plan::LIMIT) && wanted.iter().all(|x| x.is_finite());
    safe.then_some(wanted)
}
