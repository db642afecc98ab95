//! What round-off of rates adds up to in states, whichever way these were integrated.
//!
//! A rate to which `s` is added up is known to `ε s`, with `ε` the distance of numbers beside 1. What this
//! makes of a state within a time, `r' = ε s − λ r` with `λ = max(0, −∂ẏ/∂y)` of the state itself, is no
//! bound of its error, which may grow or average out; but where it is no small part of the state, and more
//! than the two runs differ by, no estimate is to be trusted.

use equations::{Compiled, Equations};

use crate::doubt::Doubt;
use crate::settings::CERTAINTY;

/// After a first look, what is added up between its instants may be so many times as much.
const BETWEEN: f64 = 1e3;
/// Part of a state over which its round-off is told.
const TOLD: f64 = 1e-6;

/// Time, states, and what is added up to their rates.
pub(crate) type Looked = (f64, Vec<f64>, Vec<f64>);

/// How large states were, and at least what `sizes` say.
pub(crate) fn largest(looked: &[Looked], mut sizes: Vec<f64>) -> Vec<f64> {
    for (_, y, _) in looked {
        sizes.iter_mut().zip(y).for_each(|(size, y)| *size = size.max(y.abs()));
    }
    sizes
}

/// Whether round-off within this length of time is a small part of states of these sizes.
pub(crate) fn is_small(looked: &[Looked], sizes: &[f64], length: f64) -> bool {
    let mut parts = looked.iter().flat_map(|(_, _, terms)| terms.iter().zip(sizes));
    parts.all(|(terms, size)| BETWEEN * f64::EPSILON * terms * length <= TOLD * size)
}

/// Numbers of terms as they count: an infinite slope tells nothing.
pub(crate) fn finite(mut terms: Vec<f64>) -> Vec<f64> {
    terms.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
    terms
}

/// `−∂ẏ_i/∂y_i` in the direction of time at an instant, where it is positive and no round-off, or else 0.
fn decay(compiled: &mut Compiled, direction: f64, (t, y, terms): &Looked, sizes: &[f64]) -> Option<Vec<f64>> {
    let (mut here, mut there) = (vec![0.0; y.len()], vec![0.0; y.len()]);
    compiled.rates(*t, y, &mut here).ok()?;
    let mut decay = vec![0.0; y.len()];
    for i in 0..y.len() {
        let (step, mut moved) = (f64::EPSILON.sqrt() * sizes[i].max(y[i].abs()), y.to_vec());
        moved[i] += step;
        if compiled.rates(*t, &moved, &mut there).is_ok() {
            let change = direction * (here[i] - there[i]);
            decay[i] = if change > 16.0 * f64::EPSILON * terms[i] { change / step } else { 0.0 };
        }
    }
    Some(decay)
}

/// The doubt that begins where round-off of the rates has come to more than the runs differ by: instants of
/// the kept run and states of the looser one there, with names and sizes of states. What cannot be evaluated
/// is another matter.
pub(crate) fn doubt(
    compiled: &mut Compiled,
    names: &[String],
    looked: &[Looked],
    looser: &[Vec<f64>],
    sizes: &[f64],
) -> Option<Doubt> {
    let mut sums = vec![0.0; sizes.len()];
    let mut differences = vec![0.0_f64; sizes.len()];
    for (pair, looser) in looked.windows(2).zip(looser.iter().skip(1)) {
        let [(before, _, first), second] = pair else { continue };
        let (t, kept, terms) = second;
        let decay = decay(compiled, (t - before).signum(), second, sizes)?;
        let time = (t - before).abs();
        for i in 0..sizes.len() {
            let held = if decay[i] > 0.0 { -(-decay[i] * time).exp_m1() / decay[i] } else { time };
            sums[i] = sums[i] * (-decay[i] * time).exp() + 0.5 * f64::EPSILON * (first[i] + terms[i]) * held;
            differences[i] = differences[i].max((kept[i] - looser[i]).abs());
            if sums[i] > TOLD * sizes[i] && sums[i] > CERTAINTY * differences[i] {
                let (state, sum, difference) = (&names[i], sums[i], differences[i]);
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

/// The names of the states.
pub(crate) fn names_of_states(equations: &Equations) -> Vec<String> {
    equations.states.iter().map(|state| equations.graph.name(state.symbol)).collect()
}
