//! Round-off of the equations themselves, which both runs of a motion share.

use crate::lost_digits::{Looked, finite, is_small, largest};
use crate::{Doubt, Motion};

/// Stretches of a motion at whose ends rates are looked at; and of the first look, which most motions pass.
const STRETCHES: usize = 32;
const FEW: usize = 4;
/// Part of a stopped motion that is looked at: just before a singularity all terms are large.
pub(crate) const BEFORE_THE_END: f64 = 0.9;

impl Motion {
    /// Where round-off of the rates has come to more than the runs differ by.
    pub(crate) fn rounded_off(&mut self) -> Option<Doubt> {
        let looked = self.terms_along(FEW);
        let length = (self.end() - self.start()).abs();
        if is_small(&looked, &self.sizes_of(&looked), length) {
            return None;
        }
        let looked = self.terms_along(STRETCHES);
        let sizes = self.sizes_of(&looked);
        let looser: Vec<Vec<f64>> = looked.iter().map_while(|(t, ..)| self.looser_state(*t)).collect();
        self.lost_digits(&looked, &looser, &sizes)
    }

    /// How much has been added up to each coordinate since the start at a few times: no difference under
    /// round-off of that says that motions differ. Nothing where it cannot be told.
    pub(crate) fn terms_of_coordinates_along(&mut self) -> Vec<(f64, Vec<f64>)> {
        let looked = self.terms_along(FEW);
        let mut sums = vec![0.0; self.equations.states.len()];
        let mut found = Vec::with_capacity(looked.len());
        for (i, (t, y, terms)) in looked.iter().enumerate() {
            if let Some((before, _, first)) = i.checked_sub(1).map(|i| &looked[i]) {
                let both = first.iter().zip(terms).map(|(a, b)| 0.5 * (a + b) * (t - before).abs());
                sums.iter_mut().zip(both).for_each(|(sum, part)| *sum += part);
            }
            let states: Vec<f64> = sums.iter().zip(y).map(|(sum, y)| sum + y.abs()).collect();
            let Some(terms) = self.terms_of_coordinates(*t, y, &states) else { break };
            found.push((*t, terms));
        }
        found
    }

    /// Time, states and what is added up to their rates at equidistant instants, as far as that can be told.
    fn terms_along(&mut self, stretches: usize) -> Vec<Looked> {
        let (start, part) = (self.start(), if self.is_complete() { 1.0 } else { BEFORE_THE_END });
        let times = self.grid(stretches).into_iter().map(|t| self.kept_before(start + part * (t - start)));
        let times: Vec<f64> = times.collect();
        times.into_iter().map_while(|t| self.terms_of_rates(t).map(|(y, terms)| (t, y, finite(terms)))).collect()
    }

    /// The largest value of each state, or the size by which it was integrated, if that is more.
    fn sizes_of(&self, looked: &[Looked]) -> Vec<f64> {
        let mut sizes = self.sizes_of_states();
        sizes.resize(self.equations.states.len(), 0.0);
        largest(looked, sizes)
    }
}
