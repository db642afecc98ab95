//! The last digits of states, and what they are worth.

use equations::Compiled;

use super::limits::UNITS;
use crate::metric::subtract;

/// Perturbation of each entry in units in the last place, with alternating sign.
pub fn move_digits(y: &mut [f64], units: impl Fn(usize) -> f64) {
    let places = (0..y.len()).zip(signs());
    y.iter_mut().zip(places).for_each(|(x, (i, sign))| *x *= 1.0 + sign * units(i) * f64::EPSILON);
}

/// How much is added up to each invariant at `(t, y)`, of states that have these sizes. A state that is zero
/// by cancellation tells by its size.
pub(crate) fn terms_of_invariants(compiled: &mut Compiled, t: f64, y: &[f64], sizes: &[f64]) -> Option<Vec<f64>> {
    let (here, mut terms) = (compiled.outputs(t, y).ok()?.invariants, compiled.terms_of_invariants(t, y).ok()?);
    let part = UNITS * f64::EPSILON;
    let sizes = sizes.iter().chain(std::iter::repeat(&0.0)).zip(signs());
    let moved: Vec<f64> = y.iter().zip(sizes).map(|(y, (size, sign))| y + sign * part * size.max(y.abs())).collect();
    // states that are so far apart may have no outputs
    let there = compiled.outputs(t, &moved).map_or_else(|_| here.clone(), |there| there.invariants);
    terms.iter_mut().zip(subtract(&there, &here)).for_each(|(term, change)| *term = term.max(change.abs() / part));
    Some(terms)
}

/// 1 or −1, place by place.
pub fn signs() -> impl Iterator<Item = f64> {
    let next = |state: &u64| {
        let state = state ^ (state << 13);
        let state = state ^ (state >> 7);
        Some(state ^ (state << 17))
    };
    let states = std::iter::successors(Some(0x9E37_79B9_7F4A_7C15_u64), next).skip(1);
    states.map(|state| if state & 1 == 0 { 1.0 } else { -1.0 })
}
