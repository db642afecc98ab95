//! Motions that are one curve.

use crate::connect::two_point::TwoPoint;

/// Instants at which curves are compared, and how much more constants differ than curves where they do.
const COMPARED: usize = 16;
/// Curves are one where they differ by less, in units of the problem; smaller differences are none.
const SAME: f64 = 1e-4;
const LEAST: f64 = 1e-6;
const MORE: f64 = 100.0;

/// Unknowns of a motion, how many starts led to it, and whether others with other constants are the same
/// curve.
pub(super) type Exact = (Vec<f64>, usize, bool);

/// Motions that are one curve, once, with the least constants: one for several constants has an abnormal
/// lift.
pub(super) fn one_per_curve(exact: Vec<(Vec<f64>, usize)>, problem: &mut TwoPoint) -> Vec<Exact> {
    let free = problem.velocities.free.len();
    let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let size = |x: &[f64]| x[free..].iter().map(|x| x.abs()).fold(0.0, f64::max);
    let mut kept: Vec<(Exact, Vec<f64>)> = Vec::new();
    for (x, starts) in exact {
        let curve = problem.curve(&x, COMPARED).unwrap_or_default();
        let is_same = |((other, ..), known): &&mut (Exact, Vec<f64>)| {
            let apart = largest(&curve, known);
            !curve.is_empty() && apart <= SAME && largest(&x[free..], &other[free..]) > MORE * apart.max(LEAST)
        };
        match kept.iter_mut().find(is_same) {
            None => kept.push(((x, starts, false), curve)),
            Some(((other, count, several), known)) => {
                (*count, *several) = (*count + starts, true);
                if size(&x) < size(other) {
                    (*other, *known) = (x, curve);
                }
            }
        }
    }
    kept.into_iter().map(|(exact, _)| exact).collect()
}
