//! Round-off of the equations themselves, which both runs of a motion share.
//!
//! A rate to which `s` is added up is known to `ε s`, with `ε` the distance of numbers beside 1. What this
//! makes of a state within a time, `r' = ε s − λ r` with `λ = max(0, −∂ẏ/∂y)` of the state itself, is no
//! bound of its error, which may grow or average out; but where it is no small part of the state, and more
//! than the two runs differ by, no estimate is to be trusted.

use crate::settings::CERTAINTY;
use crate::{Doubt, Motion};

/// Stretches of a motion at whose ends rates are looked at; and of the first look, which most motions pass.
const STRETCHES: usize = 32;
const FEW: usize = 4;
/// After the first look, what is added up between its instants may be so many times as much.
const BETWEEN: f64 = 1e3;
/// Part of a state over which its round-off is told.
const TOLD: f64 = 1e-6;
/// Part of a stopped motion that is looked at: just before a singularity all terms are large.
const BEFORE_THE_END: f64 = 0.9;

impl Motion {
    /// The doubt that begins where round-off of the rates has come to more than the runs differ by. What
    /// cannot be evaluated is another matter.
    pub(crate) fn rounded_off(&mut self) -> Option<Doubt> {
        let looked = self.terms_along(FEW);
        let length = (self.end() - self.start()).abs();
        let sizes = self.sizes_of(&looked);
        let is_small = |terms: &Vec<f64>| {
            let mut parts = terms.iter().zip(&sizes);
            parts.all(|(terms, size)| BETWEEN * f64::EPSILON * terms * length <= TOLD * size)
        };
        if looked.iter().all(|(_, _, terms)| is_small(terms)) {
            return None;
        }
        let looked = self.terms_along(STRETCHES);
        let sizes = self.sizes_of(&looked);
        let mut sums = vec![0.0; sizes.len()];
        let mut differences = vec![0.0_f64; sizes.len()];
        for pair in looked.windows(2) {
            let [(before, _, first), (t, kept, second)] = pair else { continue };
            let looser = self.looser_state(*t)?;
            let decay = self.decay_of_states(*t, kept, &sizes, second)?;
            let time = (t - before).abs();
            for i in 0..sizes.len() {
                let held = if decay[i] > 0.0 { -(-decay[i] * time).exp_m1() / decay[i] } else { time };
                sums[i] = sums[i] * (-decay[i] * time).exp() + 0.5 * f64::EPSILON * (first[i] + second[i]) * held;
                differences[i] = differences[i].max((kept[i] - looser[i]).abs());
                if sums[i] > TOLD * sizes[i] && sums[i] > CERTAINTY * differences[i] {
                    let state = self.equations.graph.name(self.equations.states[i].symbol);
                    let (sum, difference) = (sums[i], differences[i]);
                    let because = format!(
                        "the error estimate is not to be trusted from t = {before:.6} on: the rate of {state} is a \
                         difference of larger terms, whose round-off may have come to {sum:.1e} at t = {t:.6}, \
                         where the runs differ by {difference:.1e}"
                    );
                    return Some(Doubt { from: *before, because });
                }
            }
        }
        None
    }

    /// Time, states and what is added up to their rates at equidistant instants, as far as that can be told.
    /// An infinite slope tells nothing.
    fn terms_along(&mut self, stretches: usize) -> Vec<(f64, Vec<f64>, Vec<f64>)> {
        let (start, part) = (self.start(), if self.is_complete() { 1.0 } else { BEFORE_THE_END });
        let times = self.grid(stretches).into_iter().map(|t| self.kept_before(start + part * (t - start)));
        let times: Vec<f64> = times.collect();
        let times = times.into_iter();
        times
            .map_while(|t| {
                let (y, mut terms) = self.terms_of_rates(t)?;
                terms.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
                Some((t, y, terms))
            })
            .collect()
    }

    /// The largest value of each state, or the size by which it was integrated, if that is more.
    fn sizes_of(&self, looked: &[(f64, Vec<f64>, Vec<f64>)]) -> Vec<f64> {
        let mut sizes = self.sizes_of_states();
        sizes.resize(self.equations.states.len(), 0.0);
        for (_, y, _) in looked {
            sizes.iter_mut().zip(y).for_each(|(size, y)| *size = size.max(y.abs()));
        }
        sizes
    }
}
