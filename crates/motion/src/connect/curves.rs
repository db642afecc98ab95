//! Motions that are one curve.

use crate::band::{CERTAINTY, SOME};
use crate::connect::two_point::TwoPoint;
use crate::shooting::Minimum;
use symbolic::limits::SAME;

/// Two results of searches, or curves, and two final results are one where unknowns differ by less, in units
/// of the problem.
pub(super) const ONE: [f64; 2] = [1e-4, SAME];

/// Motions that are one curve, once, with the least constants: one for several constants has an abnormal
/// lift, and is marked.
pub(super) fn one_per_curve(exact: Vec<Minimum>, problem: &mut TwoPoint) -> Vec<(Minimum, bool)> {
    let free = problem.velocities.free.len();
    let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let size = |x: &[f64]| x[free..].iter().map(|x| x.abs()).fold(0.0, f64::max);
    let mut kept: Vec<((Minimum, bool), Vec<f64>)> = Vec::new();
    for found in exact {
        let x = &found.unknowns;
        let curve = problem.curve(x, SOME).unwrap_or_default();
        let is_same = |((other, _), known): &&mut ((Minimum, bool), Vec<f64>)| {
            let apart = largest(&curve, known);
            !curve.is_empty()
                && apart <= ONE[0]
                && largest(&x[free..], &other.unknowns[free..]) > CERTAINTY * apart.max(SAME)
        };
        match kept.iter_mut().find(is_same) {
            None => kept.push(((found, false), curve)),
            Some(((other, several), known)) => {
                *several = true;
                (other.reached, other.first) = (other.reached + found.reached, other.first.min(found.first));
                if size(x) < size(&other.unknowns) {
                    (other.unknowns, *known) = (found.unknowns, curve);
                }
            }
        }
    }
    kept.into_iter().map(|(exact, _)| exact).collect()
}
