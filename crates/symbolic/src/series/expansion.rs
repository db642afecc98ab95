//! Computation of the orders after the first, one by one.

use super::scalar::Packs;
use super::{Correct, Implicit, Placed, Plan, SeriesScalar, SeriesTape, Source, TERMS};

impl<T: SeriesScalar> Placed<T> {
    /// The sum of `P` plain and `N` weighted terms, in pairs; the last, for which it may have to wait, last.
    #[inline(always)]
    fn sum<const P: usize, const N: usize>(&self, rows: &[T]) -> T {
        let term = |i: usize| match i < P {
            true => rows[self.plain[i] as usize],
            false => self.weights[i - P] * rows[self.terms[i - P] as usize],
        };
        let count = P + N;
        if count < 2 {
            return if count == 0 { T::from_f64(0.0) } else { term(0) };
        }
        let mut sum = if count == 2 { term(0) } else { term(0) + term(1) };
        let mut next = 2;
        while next + 2 < count {
            sum = sum + (term(next) + term(next + 1));
            next += 2;
        }
        if next + 2 == count {
            sum = sum + term(next);
        }
        sum + term(count - 1)
    }
}

impl<T: SeriesScalar> Plan<T> {
    /// Order `k` of the products of a group.
    #[inline(always)]
    fn multiply(&self, rows: &mut [T], packs: &mut Packs, group: usize, k: usize) {
        let [plain, over] = &self.groups[group].products;
        T::multiply(rows, plain, packs, k, None);
        T::multiply(rows, over, packs, k, Some(self.orders[k].1));
    }

    /// Order `k` of the states of a group.
    #[inline(always)]
    fn integrate(&self, rows: &mut [T], group: usize, k: usize) {
        let (before, share) = (&mut rows[k - 1..], self.orders[k].1);
        for (state, rate, factor) in &self.groups[group].states {
            before[*state as usize + 1] = before[*rate as usize] * (*factor * share);
        }
    }

    /// Order `k` of sums.
    #[inline(always)]
    fn add(rows: &mut [T], k: usize, additions: &[Placed<T>]) {
        let rows = &mut rows[k - 1..];
        macro_rules! kinds {
            ($($kind:literal $plain:literal $weighted:literal,)*) => {
                for addition in additions {
                    let sum = match addition.kind {
                        $($kind => addition.sum::<$plain, $weighted>(rows),)*
                        _ => addition.sum::<TERMS, TERMS>(rows),
                    };
                    rows[addition.target as usize] = sum;
                }
            };
        }
        kinds!(
            0 0 0, 1 0 1, 2 0 2, 3 0 3, 4 0 4, 5 1 0, 6 1 1, 7 1 2, 8 1 3, 9 1 4, 10 2 0, 11 2 1, 12 2 2, 13 2 3,
            14 2 4, 15 3 0, 16 3 1, 17 3 2, 18 3 3, 19 3 4, 20 4 0, 21 4 1, 22 4 2, 23 4 3,
        );
    }

    /// Order `k` of `τ x'`.
    #[inline(always)]
    fn slopes(&self, rows: &mut [T], group: usize, k: usize) {
        let (newest, factor) = (&mut rows[k..], self.orders[k].0);
        for (slope, of) in &self.groups[group].slopes {
            newest[*slope as usize] = newest[*of as usize] * factor;
        }
    }

    /// Order `k ≥ 1` of what is computed one order ahead.
    #[inline(always)]
    fn lead(&self, rows: &mut [T], packs: &mut Packs, k: usize, additions: usize) {
        self.multiply(rows, packs, AHEAD, k);
        self.integrate(rows, AHEAD, k);
        Plan::add(rows, k, &self.additions[..additions]);
        self.slopes(rows, AHEAD, k);
    }

    /// Order `k` of time derivatives.
    #[inline(always)]
    fn differentiate(&self, rows: &mut [T], k: usize) {
        let (newest, factor) = (&mut rows[k..], self.orders[k + 1].0 * self.frequency);
        for (derivative, of) in &self.derivatives {
            newest[*derivative as usize] = newest[*of as usize + 1] * factor;
        }
    }
}

/// The groups of a tape.
const AHEAD: usize = 0;
const OTHERS: usize = 1;

pub(super) struct Expansion<'a, 'c, T> {
    pub(super) tape: &'a SeriesTape,
    pub(super) plan: &'a mut Plan<T>,
    pub(super) packs: &'a mut Packs,
    pub(super) sweeps: usize,
    pub(super) correct: Correct<'c, T>,
}

impl<T: SeriesScalar> Expansion<'_, '_, T> {
    /// The unknowns of one block at order `k`, and what depends on them.
    #[inline(always)]
    fn solve(&mut self, rows: &mut [T], k: usize, block: usize) {
        let (tape, plan) = (self.tape, &mut *self.plan);
        let (from, to) = (tape.stages[2 + block], tape.stages[3 + block]);
        let Implicit { unknowns, residuals } = &tape.blocks[block];
        let (newest, stride) = (&mut rows[k..], plan.stride);
        unknowns.iter().for_each(|unknown| newest[*unknown as usize * stride] = T::from_f64(0.0));
        for _ in 0..self.sweeps {
            Plan::add(rows, k, &plan.additions[from..to]);
            let newest = &mut rows[k..];
            for (residual, source) in plan.residual.iter_mut().zip(residuals) {
                *residual = match source {
                    Source::Row(row, factor) => newest[*row as usize * stride] * plan.values[*factor as usize],
                    Source::Steady(_) => T::from_f64(0.0),
                };
            }
            (self.correct)(block, &mut plan.residual[..residuals.len()]);
            for (unknown, change) in unknowns.iter().zip(&plan.residual) {
                let unknown = &mut newest[*unknown as usize * stride];
                *unknown = *unknown + *change;
            }
        }
        Plan::add(rows, k, &plan.additions[from..to]);
    }

    /// All orders, in turn.
    #[inline(always)]
    pub(super) fn run(mut self, rows: &mut [T]) {
        let order = self.plan.order;
        let (ahead, unknown) = (self.tape.stages[0], self.tape.stages[2]);
        let leads = ahead > 0 || !self.plan.groups[AHEAD].states.is_empty();
        if leads {
            self.plan.lead(rows, self.packs, 1, ahead);
        }
        for k in 1..=order {
            if k < order {
                self.plan.multiply(rows, self.packs, OTHERS, k);
            }
            // Only now, so that no product waits for a coefficient that was just written.
            self.plan.integrate(rows, OTHERS, k);
            if k == order {
                return;
            }
            let mut next = ahead;
            if leads {
                next = self.tape.stages[1];
                Plan::add(rows, k, &self.plan.additions[ahead..next]);
                self.plan.lead(rows, self.packs, k + 1, ahead);
                self.plan.differentiate(rows, k);
            }
            Plan::add(rows, k, &self.plan.additions[next..unknown]);
            for block in 0..self.tape.blocks.len() {
                self.solve(rows, k, block);
            }
            self.plan.slopes(rows, OTHERS, k);
        }
    }
}
