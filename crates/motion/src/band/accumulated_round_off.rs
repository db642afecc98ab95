//! What round-off of rates adds up to in states, whichever way these were integrated.
//!
//! A rate to which `s` is added up is known to `ε s`, with `ε` the distance of numbers beside 1. What this
//! makes of a state within a time, `r' = ε s − λ r` with `λ = max(0, −∂ẏ/∂y)` of the state itself, is no
//! bound of its error, which may grow or average out. Where it is more than the two runs differ by, a run has
//! to tell what becomes of it ([`RoundOff::Counts`]); where it is not a small part of the state, either, no
//! estimate is to be trusted.

use equations::Compiled;

use super::estimate_failure::Doubt;
use super::limits::{CERTAINTY, ROUND_OFF, UNITS};
use crate::numbers::precise;
use symbolic::limits::SAME;

/// Time, states, and what is added up to their rates.
pub type Looked = (f64, Vec<f64>, Vec<f64>);

/// Rates at a time, of states near those of the motion there: whether they have values.
pub type Rates<'a> = dyn FnMut(f64, &[f64], &mut [f64]) -> bool + 'a;

/// Round-off that the rates accumulate, beside the difference of the runs.
pub enum RoundOff {
    /// No more than the difference of the runs, or than `ROUND_OFF`.
    Small,
    /// To be put into the rates: `d` and `η` of `perturbed_rates`.
    Counts(Vec<f64>),
    /// Too large for any error estimate.
    Doubted(Doubt),
}

/// How large states were, and at least what `sizes` say.
pub fn largest(looked: &[Looked], mut sizes: Vec<f64>) -> Vec<f64> {
    for (_, y, _) in looked {
        sizes.iter_mut().zip(y).for_each(|(size, y)| *size = size.max(y.abs()));
    }
    sizes
}

/// States and the sums of terms behind their rates at an instant; `None` where these cannot be evaluated.
/// Infinite sums, as at an infinite slope, become 0.
pub fn look(compiled: &mut Compiled, t: f64, y: &[f64]) -> Option<Looked> {
    let mut terms = compiled.terms_of_evaluation(t, y).ok()?;
    terms.truncate(y.len());
    terms.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
    Some((t, y.to_vec(), terms))
}

/// The same sums by adjoints, where they can be evaluated: along a chain of bodies paths cancel.
pub(crate) fn look_closer(compiled: &mut Compiled, (t, y, terms): &mut Looked) {
    if let Ok(closer) = compiled.adjoint_terms_of_rates(*t, y) {
        terms.iter_mut().zip(closer).for_each(|(term, closer)| *term = term.min(closer));
    }
}

/// `−∂ẏ_i/∂y_i` in the direction of time at an instant, where it is positive and no round-off, or else 0.
fn decay(rates: &mut Rates, direction: f64, (t, y, terms): &Looked, sizes: &[f64]) -> Option<Vec<f64>> {
    let (mut here, mut there) = (vec![0.0; y.len()], vec![0.0; y.len()]);
    if !rates(*t, y, &mut here) {
        return None;
    }
    let mut decay = vec![0.0; y.len()];
    for i in 0..y.len() {
        let (step, mut moved) = (f64::EPSILON.sqrt() * sizes[i].max(y[i].abs()), y.to_vec());
        moved[i] += step;
        if rates(*t, &moved, &mut there) {
            let change = direction * (here[i] - there[i]);
            decay[i] = if change > 16.0 * f64::EPSILON * terms[i] { change / step } else { 0.0 };
        }
    }
    Some(decay)
}

/// Sums over time of what is added up to rates.
struct Sums {
    sums: Vec<f64>,
    differences: Vec<f64>,
}

impl Sums {
    fn new(count: usize) -> Sums {
        Sums { sums: vec![0.0; count], differences: vec![0.0; count] }
    }

    /// From an instant to the next one, where the looser run is there; `decay` is 0 where it is not given.
    fn add(&mut self, [first, second]: [&Looked; 2], looser: &[f64], decay: &[f64]) {
        let time = (second.0 - first.0).abs();
        for (i, other) in looser.iter().enumerate() {
            let decay = decay.get(i).copied().unwrap_or(0.0);
            let held = if decay > 0.0 { -(-decay * time).exp_m1() / decay } else { time };
            let mean = 0.5 * (first.2[i] + second.2[i]);
            self.sums[i] = self.sums[i] * (-decay * time).exp() + f64::EPSILON * mean * held;
            self.differences[i] = self.differences[i].max((second.1[i] - other).abs());
        }
    }

    /// States whose round-off exceeds that of their numbers and `UNITS` times the difference of the runs.
    fn over<'a>(&'a self, sizes: &'a [f64]) -> impl Iterator<Item = usize> + 'a {
        let is_over = |i: &usize| self.sums[*i] > (UNITS * self.differences[*i]).max(ROUND_OFF * sizes[*i]);
        (0..self.sums.len()).filter(is_over)
    }
}

/// An instant and the next one, and the states of the looser run there.
fn stretches<'a>(
    looked: &'a [Looked],
    looser: &'a [Vec<f64>],
) -> impl Iterator<Item = ([&'a Looked; 2], &'a Vec<f64>)> {
    looked.windows(2).zip(looser.iter().skip(1)).map(|(pair, looser)| ([&pair[0], &pair[1]], looser))
}

/// Whether round-off is small if nothing decays, even if it were `between` times as large between instants.
pub fn is_small(looked: &[Looked], looser: &[Vec<f64>], sizes: &[f64], between: f64) -> bool {
    let mut sums = Sums::new(sizes.len());
    let sizes: Vec<f64> = sizes.iter().map(|size| size / between).collect();
    stretches(looked, looser).all(|(pair, looser)| {
        sums.add(pair, looser, &[]);
        sums.over(&sizes).next().is_none()
    })
}

/// Round-off that rates accumulate between instants of the kept run, from the states of the looser run there
/// and the names and sizes of states. A doubt begins where it exceeds `SAME` of a state and ten times the
/// difference of the runs: less can be put into a run, which shows how it grows; more would make another
/// motion. Rates that cannot be evaluated end the search.
pub fn accumulated(
    rates: &mut Rates,
    names: &dyn Fn() -> Vec<String>,
    looked: &[Looked],
    looser: &[Vec<f64>],
    sizes: &[f64],
) -> RoundOff {
    if is_small(looked, looser, sizes, 1.0) {
        return RoundOff::Small;
    }
    let (mut sums, mut over) = (Sums::new(sizes.len()), vec![false; sizes.len()]);
    for (pair, looser) in stretches(looked, looser) {
        let [(before, ..), second] = pair;
        let Some(decay) = decay(rates, (second.0 - before).signum(), second, sizes) else { break };
        sums.add(pair, looser, &decay);
        for i in sums.over(sizes) {
            over[i] = true;
            let (sum, difference) = (sums.sums[i], sums.differences[i]);
            if sum > SAME * sizes[i] && sum > CERTAINTY * difference {
                let (state, from, t) = (&names()[i], precise(*before), precise(second.0));
                let because = format!(
                    "the error estimate is not to be trusted from t = {from} on: the rate of {state} is a \
                     difference of larger terms, whose round-off may have come to {sum:.1e} at t = {t}, \
                     where the runs differ by {difference:.1e}"
                );
                return RoundOff::Doubted(Doubt { from: *before, because });
            }
        }
    }
    if over.contains(&true) { RoundOff::Counts(offsets_of(rates, looked, looser, &over)) } else { RoundOff::Small }
}

/// `d`, then `η`: the mean round-off of rates up to some instant, where that is largest, in the direction of
/// the way that a state goes by its rate, and as a part of the largest rate; of states whose round-off
/// counts. All of one sign: that in which the looser run is apart from the kept one.
fn offsets_of(rates_at: &mut Rates, looked: &[Looked], looser: &[Vec<f64>], counts: &[bool]) -> Vec<f64> {
    let zeros = vec![0.0_f64; counts.len()];
    let [mut sums, mut means, mut way, mut farthest] = [(); 4].map(|()| zeros.clone());
    let [mut largest, mut apart, mut rates] = [(); 3].map(|()| zeros.clone());
    for (pair, looser) in stretches(looked, looser) {
        let [(before, here, first), (t, y, terms)] = pair;
        if !rates_at(*t, y, &mut rates) {
            rates.fill(0.0);
        }
        for i in 0..counts.len() {
            sums[i] += 0.5 * (first[i] + terms[i]) * (t - before).abs();
            means[i] = means[i].max(sums[i] / (t - looked[0].0).abs());
            way[i] += rates[i] * (t - before);
            // a pulse may be between the instants
            let mean = (y[i] - here[i]) / (t - before);
            largest[i] = largest[i].max(rates[i].abs()).max(mean.abs());
            farthest[i] = if way[i].abs() > farthest[i].abs() { way[i] } else { farthest[i] };
            let difference = looser[i] - y[i];
            apart[i] = if difference.abs() > apart[i].abs() { difference } else { apart[i] };
        }
    }
    let time = looked.last().map_or(0.0, |last| last.0 - looked[0].0);
    let offset = |i: usize| if counts[i] { (0.5 * f64::EPSILON * means[i]).copysign(time * farthest[i]) } else { 0.0 };
    let offsets: Vec<f64> = (0..counts.len()).map(offset).collect();
    // how much of what is apart the offsets would make alone
    let likeness = |i: usize| if offsets[i] == 0.0 { 0.0 } else { apart[i] / (offsets[i] * time) };
    let sign = 1.0_f64.copysign((0..counts.len()).map(likeness).sum());
    let part = |i: usize| if offsets[i] == 0.0 { 0.0 } else { (offsets[i] / largest[i]).abs().min(SAME) };
    offsets.iter().map(|d| sign * d).chain((0..counts.len()).map(|i| sign * part(i))).collect()
}
