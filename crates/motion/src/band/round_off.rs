//! Round-off of the equations themselves, which both runs of a motion share.

use std::iter::zip;

use integrate::Options;

use super::TwoRuns;
use super::accumulated_round_off::{Looked, RoundOff, accumulated, is_small, largest, look, look_closer};
use super::limits::{BEFORE_THE_END, BETWEEN, FEW, LOOKS};
use super::perturbed_rates::perturbed;
use crate::charts::{self, Course};
use crate::trajectory::Trajectory;
use crate::{Motion, Prepared, Setting, Settings, SolveError};

/// Instants of the kept run in its first chart, up to the first at which sums of terms cannot be evaluated;
/// states of the looser run there; and sizes of states.
pub(crate) fn looked_at(runs: &mut dyn TwoRuns, stretches: usize) -> (Vec<Looked>, Vec<Vec<f64>>, Vec<f64>) {
    let mut times = [runs.equidistant(stretches), runs.ends_of_steps()].concat();
    let start = times[0];
    times.sort_by(|a, b| (a - start).abs().total_cmp(&(b - start).abs()));
    times.dedup();
    let at = |t: f64| {
        let y = runs.states(t)?;
        let looked = look(runs.compiled(), t, &y)?;
        Some((looked, runs.looser_states(t)?))
    };
    let (looked, looser): (Vec<Looked>, _) = times.into_iter().map_while(at).unzip();
    let mut sizes = runs.sizes();
    sizes.resize(runs.compiled().dimension(), 0.0);
    let sizes = largest(&looked, sizes);
    (looked, looser, sizes)
}

/// What round-off of the rates comes to beside the difference of the runs.
pub(crate) fn round_off(runs: &mut dyn TwoRuns) -> RoundOff {
    let (mut looked, looser, sizes) = looked_at(runs, FEW);
    if is_small(&looked, &looser, &sizes, BETWEEN) {
        return RoundOff::Small;
    }
    closer(runs, &mut looked);
    if is_small(&looked, &looser, &sizes, BETWEEN) {
        return RoundOff::Small;
    }
    // runs that keep few instants have no more of them
    let (looked, looser, sizes) = if runs.equidistant(LOOKS) == runs.equidistant(FEW) {
        (looked, looser, sizes)
    } else {
        let (mut looked, looser, sizes) = looked_at(runs, LOOKS);
        closer(runs, &mut looked);
        (looked, looser, sizes)
    };
    let found = rates_of(runs, &looked, &looser, &sizes);
    if !matches!(found, RoundOff::Counts(_)) {
        return found;
    }
    // what is large for the time of a few steps raises a doubt: in all of another run it would be far too
    // much
    let grid = runs.equidistant(LOOKS);
    let (looked, looser): (Vec<_>, Vec<_>) = zip(looked, looser).filter(|((t, ..), _)| grid.contains(t)).unzip();
    rates_of(runs, &looked, &looser, &sizes)
}

/// Sums of terms by adjoints at these instants.
fn closer(runs: &mut dyn TwoRuns, looked: &mut [Looked]) {
    for looked in looked {
        // the equations have the root of the motion there
        if runs.states(looked.0).is_some() {
            look_closer(runs.compiled(), looked);
        }
    }
}

fn rates_of(runs: &mut dyn TwoRuns, looked: &[Looked], looser: &[Vec<f64>], sizes: &[f64]) -> RoundOff {
    let names = runs.names();
    let mut rates =
        |t: f64, y: &[f64], rates: &mut [f64]| runs.states(t).is_some() && runs.compiled().rates(t, y, rates).is_ok();
    accumulated(&mut rates, &|| names.clone(), looked, looser, sizes)
}

impl Motion {
    /// Round-off of the rates, which both runs share, as a part of their difference: if it is more than that,
    /// the looser run is made again with as much of it in its rates as there may be. If that run does not
    /// come as far, as it may not keep the constraint, the looser run stays. A doubt if round-off is no small
    /// part of a state.
    ///
    /// # Errors
    /// [`SolveError`] if the equations cannot be compiled again.
    pub(crate) fn count_round_off(&mut self, setting: Setting, settings: &Settings) -> Result<(), SolveError> {
        match round_off(self) {
            RoundOff::Small => {}
            RoundOff::Doubted(doubt) => self.doubt = Some(doubt),
            RoundOff::Counts(offsets) => {
                let equations = perturbed(&self.equations, &offsets);
                let prepared = Prepared::around(setting, equations, self.constants.clone(), 0, settings)?;
                if let Ok(looser) = self.looser_again(setting, prepared, settings) {
                    self.replace_looser(looser);
                }
            }
        }
        Ok(())
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

    /// If the motion stops before its end, another run may do so a little earlier.
    pub(crate) fn replace_looser(&mut self, looser: Trajectory) {
        let (start, reached) = (self.start(), looser.ends()[1]);
        let [length, other] = [self.end(), reached].map(|t| (t - start).abs());
        if other >= length || !self.is_complete() && other > BEFORE_THE_END * length {
            self.looser = looser;
            self.read_to_the_end();
        }
    }
}
