//! Polynomials against the rates inside their steps.

use super::{LANES, Lane, LaneProblem, Lanes};
use crate::taylor_step::{DEFECT, LEAST_RELATIVE, MANY, UNLIMITED, each};
use std::f64::consts::GOLDEN_RATIO;

impl<P: LaneProblem> Lanes<'_, P> {
    /// As for a single motion: at many places where terms do not limit the step, which depend on the motion's
    /// own attempts only. And at divisors in the middle of the step.
    pub(super) fn check_defects(&mut self) {
        let under_way: [bool; LANES] = each(|l| self.riders[l].as_ref().is_some_and(|rider| !rider.fresh));
        let free: [bool; LANES] = each(|l| under_way[l] && UNLIMITED * self.taken[l].abs() < self.step[l]);
        let mut place: Lane = each(|l| {
            let work = self.riders[l].as_ref().map(|rider| rider.run.work);
            work.map_or(0.0, |work| GOLDEN_RATIO * (work.steps + work.rejected) as f64)
        });
        let relative = self.options.relative_tolerance.max(LEAST_RELATIVE);
        let mut forgiven = [1.0_f64; LANES];
        for ((y, reached), absolute) in self.candidate.iter().zip(&self.reached).zip(&self.absolute_tolerances) {
            let moved = |l: usize| (y[l] - reached[l]).abs() / (absolute[l] + relative * y[l].abs());
            forgiven = each(|l| forgiven[l].max(1.0 + moved(l)));
        }
        let count = if free.contains(&true) { MANY } else { 0 };
        for _ in 0..count {
            place = place.map(|place| (place + GOLDEN_RATIO).fract());
            let t: Lane = each(|l| self.t[l] + place[l] * self.taken[l]);
            let theta: Lane = each(|l| self.taken[l] / self.unit[l]);
            let share: Lane = each(|l| (t[l] - self.t[l]) / self.unit[l]);
            let inner = self.inner.iter_mut().zip(&mut self.inner_slope);
            let rows = inner.zip(self.coefficients.chunks_exact(self.orders));
            pulp::Arch::new().dispatch(
                #[inline(always)]
                move || {
                    for ((y, slope), row) in rows {
                        (*y, *slope) = ([0.0; LANES], [0.0; LANES]);
                        for c in row.iter().rev() {
                            *slope = each(|l| y[l] + share[l] * slope[l]);
                            *y = each(|l| c[l] + share[l] * y[l]);
                        }
                        *slope = each(|l| slope[l] * theta[l]);
                    }
                },
            );
            self.problem.rates(&t, &self.inner, &mut self.inner_rates);
            let values = self.inner.iter().zip(&self.inner_slope).zip(&self.inner_rates);
            for (((y, slope), rate), absolute) in values.zip(&self.absolute_tolerances) {
                for l in 0..LANES {
                    let allowed = DEFECT * (absolute[l] + relative * y[l].abs().max(slope[l].abs()));
                    let agrees = (slope[l] - rate[l] * self.taken[l]).abs() <= allowed * forgiven[l];
                    self.smooth[l] &= agrees || !free[l];
                }
            }
        }
        self.look_at_divisors();
    }
}

/// Lanes without NaN and infinity.
#[inline(always)]
pub(super) fn finite(values: &[Lane]) -> [bool; LANES] {
    let mut sums = [[0.0; LANES]; 2];
    for pair in values.chunks(2) {
        for (sum, x) in sums.iter_mut().zip(pair) {
            *sum = each(|l| sum[l] + 0.0 * x[l]);
        }
    }
    each(|l| sums[0][l] + sums[1][l] == 0.0)
}
