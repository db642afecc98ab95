//! Round-off of the equations themselves, which both runs of a motion share.

use std::iter::zip;

use integrate::Options;

use crate::charts::{self, Course};
use crate::disturbed::disturbed;
use crate::lost_digits::{Looked, RoundOff, is_small, largest, look_closer};
use crate::trajectory::Trajectory;
use crate::{Motion, Prepared, Setting, Settings, SolveError};

/// Number of stretches of a motion at whose ends rates are evaluated; fewer in a first check, which most
/// motions pass even if sums of terms are `BETWEEN` times as large between these instants.
pub(crate) const STRETCHES: usize = 32;
pub(crate) const FEW: usize = 4;
const BETWEEN: f64 = 8.0;
/// So many ends of steps are looked at besides, or all, a like number of steps apart.
const ENDS: usize = 64;
/// Fraction of a stopped motion that is checked: just before a singularity all terms are large.
pub(crate) const BEFORE_THE_END: f64 = 0.9;

impl Motion {
    /// Round-off of the rates, which both runs share, as a part of their difference: where it is more
    /// than that, the looser run is made again with as much of it in its rates as there may be; where
    /// that run does not come as far, as it may not keep the constraint, the looser run stays. A doubt
    /// where round-off is no small part of a state.
    ///
    /// # Errors
    /// [`SolveError`] where the equations cannot be compiled again.
    pub(crate) fn count_round_off(&mut self, setting: Setting, settings: &Settings) -> Result<(), SolveError> {
        let (mut looked, looser, sizes) = self.looked_at(FEW);
        if is_small(&looked, &looser, &sizes, BETWEEN) {
            return Ok(());
        }
        self.look_closer(&mut looked);
        if is_small(&looked, &looser, &sizes, BETWEEN) {
            return Ok(());
        }
        let (mut looked, looser, sizes) = self.looked_at(STRETCHES);
        self.look_closer(&mut looked);
        let mut found = self.round_off(&looked, &looser, &sizes);
        if matches!(found, RoundOff::Counts(_)) {
            // what is large for the time of a few steps raises a doubt: in all of another run it would be far
            // too much
            let grid = self.instants(STRETCHES);
            let (looked, looser): (Vec<_>, Vec<_>) =
                zip(looked, looser).filter(|((t, ..), _)| grid.contains(t)).unzip();
            found = self.round_off(&looked, &looser, &sizes);
        }
        match found {
            RoundOff::Small => {}
            RoundOff::Doubted(doubt) => self.doubt = Some(doubt),
            RoundOff::Counts(disturbance) => {
                let equations = disturbed(&self.equations, &disturbance);
                let prepared = Prepared::around(setting, equations, self.constants.clone(), 0, settings)?;
                if let Ok(looser) = self.looser_again(setting, prepared, settings) {
                    self.replace_looser(looser);
                }
            }
        }
        Ok(())
    }

    /// Instants of the kept run in its first chart, the states of the looser one there, and sizes of states.
    pub(crate) fn looked_at(&mut self, stretches: usize) -> (Vec<Looked>, Vec<Vec<f64>>, Vec<f64>) {
        let mut looked = self.terms_along(stretches);
        if let Some(change) = self.charts.first() {
            // behind it, the pivots of the first chart are small
            let time = (change.t - self.start()).abs();
            looked.retain(|(t, ..)| (t - self.start()).abs() < time);
        }
        let sizes = self.sizes_of(&looked);
        let looser = looked.iter().map_while(|(t, ..)| self.looser_state(*t)).collect();
        (looked, looser, sizes)
    }

    fn looser_again(
        &self,
        setting: Setting,
        mut prepared: Prepared,
        settings: &Settings,
    ) -> Result<Trajectory, SolveError> {
        if let Trajectory::TimeLoop(kept) = &self.kept {
            let options = Options { wanted: self.wanted.clone(), ..settings.options(settings.tolerance) };
            return Ok(Trajectory::TimeLoop(Box::new(prepared.second_run(kept, setting.end, &options)?)));
        }
        match charts::run(setting, &mut prepared, settings, f64::INFINITY)? {
            Course::Run(runs) => {
                let [_, looser] = runs.trajectories;
                Ok(looser)
            }
            // only a run that has patience to lose
            Course::Unsuited(_) => Ok(self.looser.clone()),
        }
    }

    /// Where the motion stops before its end, another run may do so a little earlier.
    pub(crate) fn replace_looser(&mut self, looser: Trajectory) {
        let (start, reached) = (self.start(), looser.ends()[1]);
        let [length, other] = [self.end(), reached].map(|t| (t - start).abs());
        if other >= length || !self.is_complete() && other > BEFORE_THE_END * length {
            self.looser = looser;
            self.read_to_the_end();
        }
    }

    /// The sum of terms behind each coordinate since the start, at a few times: a difference below the
    /// round-off of that sum is no difference of motions. The list ends where sums cannot be evaluated.
    pub fn terms_of_coordinates_along(&mut self) -> Vec<(f64, Vec<f64>)> {
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

    /// How much of the motion is looked at.
    fn part(&self) -> f64 {
        if self.is_complete() { 1.0 } else { BEFORE_THE_END }
    }

    /// Equidistant instants.
    fn instants(&self, stretches: usize) -> Vec<f64> {
        let (start, part) = (self.start(), self.part());
        self.grid(stretches).into_iter().map(|t| self.kept_before(start + part * (t - start))).collect()
    }

    /// Time, states and the sums of terms behind their rates at equidistant instants and at ends of steps,
    /// more where these are short, up to the first at which they cannot be evaluated.
    fn terms_along(&mut self, stretches: usize) -> Vec<Looked> {
        let (start, part) = (self.start(), self.part());
        let length = (self.end() - start).abs();
        let ends = self.step_times();
        let number = ENDS.min(ends.len());
        let ends = (1..=number).map(|k| ends[k * ends.len() / number - 1]);
        let ends = ends.filter(|t| (t - start).abs() <= part * length).map(|t| self.kept_before(t));
        let mut times: Vec<f64> = self.instants(stretches).into_iter().chain(ends).collect();
        times.sort_by(|a, b| (a - start).abs().total_cmp(&(b - start).abs()));
        times.dedup();
        times.into_iter().map_while(|t| self.look(t)).collect()
    }

    /// [`look_closer`] at these instants.
    fn look_closer(&mut self, looked: &mut [Looked]) {
        for looked in looked {
            // a state that was read off has the root of the motion behind it
            if self.states_at(looked.0).is_ok() {
                look_closer(&mut self.compiled, looked);
            }
        }
    }

    /// The largest value of each state, or the size by which it was integrated, if that is more.
    pub(crate) fn sizes_of(&self, looked: &[Looked]) -> Vec<f64> {
        let mut sizes = self.kept.sizes().to_vec();
        sizes.resize(self.equations.states.len(), 0.0);
        largest(looked, sizes)
    }
}
