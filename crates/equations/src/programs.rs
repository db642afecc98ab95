//! Programs of compiled equations in other number types.

use symbolic::{Bounded, Evaluator, Scalar};

use crate::dynamics::Dynamics;
use crate::planned::{Planned, again};

/// Programs of compiled equations in another number type: of the plain plan, and of the chosen one.
#[derive(Clone)]
pub struct Programs<T> {
    /// Rates, from `t, y, constants, z`.
    pub rates: Evaluator<T>,
    /// Coordinates, velocities, multipliers and invariants.
    pub outputs: Evaluator<T>,
    /// Of each block the matrix `∂R/∂z`, row-major, then `R`: for a block that is linear at `z = 0`.
    pub blocks: Vec<Evaluator<T>>,
    pub(crate) planned: Option<Planned<T>>,
}

impl<T: Scalar> Programs<T> {
    /// Without a chosen plan.
    pub fn plain(instant: &Dynamics) -> Self {
        Programs::of(instant, None)
    }

    pub(crate) fn of(instant: &Dynamics, planned: Option<&Planned>) -> Self {
        let Dynamics { rates, outputs, blocks, .. } = instant;
        let blocks = blocks.iter().map(|block| again(&block.program)).collect();
        Programs { rates: again(rates), outputs: again(outputs), blocks, planned: planned.map(Planned::again) }
    }
}

/// Programs in numbers that carry the sum of magnitudes behind them: [`Bounded`].
#[derive(Clone)]
pub(crate) struct Terms {
    pub(crate) programs: Programs<Bounded>,
    pub(crate) steep: Evaluator<Bounded>,
}
