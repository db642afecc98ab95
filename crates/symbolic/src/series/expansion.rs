//! Computation of the orders after the first, one by one.

use super::scalar::Place;
use super::{Correct, Implicit, Placed, Plan, SeriesScalar, SeriesTape, Source, Store, Task, Weights, Window};

impl<T: SeriesScalar> Plan<T> {
    /// Pairs with a coefficient of order `k − 1`.
    #[inline(always)]
    fn multiply<S: Store<T> + ?Sized>(&self, rows: &mut S, k: usize) {
        let newest = k - 1;
        if newest == 0 {
            return;
        }
        for i in 0..2 {
            let of = &self.halves[i][newest * self.stride..][..self.stride];
            let weights = Weights { of, plain: i == 0, next: self.orders[k].1 };
            rows.multiply(&self.products[i], weights, newest, self.order - 1);
        }
    }

    /// Order `k` of sums.
    #[inline(always)]
    fn add<S: Store<T> + ?Sized>(rows: &mut S, k: usize, additions: &[Placed<T>]) {
        let rows = rows.window(k - 1);
        for Placed { target, start, terms: [(v, a), (w, b)] } in additions {
            rows.set(*target, rows.get(*start) + *v * rows.get(*a) + *w * rows.get(*b));
        }
    }
}

pub(super) struct Expansion<'a, 'c, T> {
    pub(super) tape: &'a SeriesTape,
    pub(super) plan: &'a mut Plan<T>,
    pub(super) sweeps: usize,
    pub(super) correct: Correct<'c, T>,
}

impl<T: SeriesScalar> Expansion<'_, '_, T> {
    /// The unknowns of one block at order `k`, and what depends on them.
    #[inline(always)]
    fn solve<S: Store<T> + ?Sized>(&mut self, rows: &mut S, k: usize, block: usize) {
        let (tape, plan) = (self.tape, &mut *self.plan);
        let (from, to) = (tape.stages[block], tape.stages[block + 1]);
        let Implicit { unknowns, residuals } = &tape.blocks[block];
        for _ in 0..self.sweeps {
            Plan::add(rows, k, &plan.additions[from..to]);
            let (newest, stride) = (rows.window(k), plan.stride as Place);
            for (residual, source) in plan.residual.iter_mut().zip(residuals) {
                *residual = match source {
                    Source::Row(row) => newest.get(row * stride),
                    Source::Steady(_) => T::from_f64(0.0),
                };
            }
            (self.correct)(block, &mut plan.residual[..residuals.len()]);
            for (unknown, change) in unknowns.iter().zip(&plan.residual) {
                newest.set(unknown * stride, newest.get(unknown * stride) + *change);
            }
        }
        Plan::add(rows, k, &plan.additions[from..to]);
    }
}

impl<T: SeriesScalar> Task<T> for Expansion<'_, '_, T> {
    #[inline(always)]
    fn run<S: Store<T> + ?Sized>(mut self, rows: &mut S) {
        let order = self.plan.order;
        let explicit = self.tape.stages[0];
        for k in 1..=order {
            if k < order {
                self.plan.multiply(rows, k);
            }
            // Only now, so that no product waits for a coefficient that was just written.
            let (before, share) = (rows.window(k - 1), self.plan.orders[k].1);
            for (state, rate, factor) in &self.plan.states {
                before.set(state + 1, before.get(*rate) * (*factor * share));
            }
            if k == order {
                return;
            }
            Plan::add(rows, k, &self.plan.additions[..explicit]);
            for block in 0..self.tape.blocks.len() {
                self.solve(rows, k, block);
            }
            let factor = self.plan.orders[k].0;
            let newest = rows.window(k);
            for (slope, of) in &self.plan.slopes {
                newest.set(*slope, newest.get(*of) * factor);
            }
        }
    }
}
