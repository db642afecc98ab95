//! The last digits of states, and what they are worth.

use equations::Compiled;

use crate::metric::subtract;

/// Units in the last place by which a start is moved.
pub(crate) const UNITS: f64 = 4.0;

/// Perturbation of each entry in units in the last place, with alternating sign.
pub(crate) fn move_digits(y: &mut [f64], units: impl Fn(usize) -> f64) {
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
    let there = compiled.outputs(t, &moved).ok()?.invariants;
    terms.iter_mut().zip(subtract(&there, &here)).for_each(|(term, change)| *term = term.max(change.abs() / part));
    Some(terms)
}

/// 1 or −1, place by place.
pub(crate) fn signs() -> impl Iterator<Item = f64> {
    let next = |state: &u64| {
        let state = state ^ (state << 13);
        let state = state ^ (state >> 7);
        Some(state ^ (state << 17))
    };
    let states = std::iter::successors(Some(0x9E37_79B9_7F4A_7C15_u64), next).skip(1);
    states.map(|state| if state & 1 == 0 { 1.0 } else { -1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_of_both_kinds_and_follow_no_period() {
        let all: Vec<f64> = signs().take(400).collect();
        assert!(all.iter().all(|sign| sign.abs() == 1.0) && all.iter().sum::<f64>().abs() < 80.0, "{all:?}");
        for period in 1..100 {
            let alike = all.iter().zip(&all[period..]).filter(|(a, b)| a == b).count();
            let part = alike as f64 / (all.len() - period) as f64;
            assert!((0.35..0.65).contains(&part), "{period}: {part}");
        }
    }

    #[test]
    fn digits_are_moved_in_units_of_each() {
        let (before, units) = ([1.0, -2e9, 3e-7, 0.0], [4.0, 4.0, 16.0, 4.0]);
        let mut y = before;
        move_digits(&mut y, |i| units[i]);
        for ((x, y), units) in before.into_iter().zip(y).zip(units) {
            let moved = ((y - x) / (f64::EPSILON * units)).abs();
            assert!((moved - x.abs()).abs() <= 0.5 * x.abs(), "{x:e}: {moved:e}");
        }
    }
}
