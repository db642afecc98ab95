//! The order of a method in its step, from motions of one start.

use schemars::JsonSchema;
use serde::Serialize;

use crate::Samples;

/// What three motions of one start say about the method that made them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Order {
    /// The time at which they are compared, the last that all have.
    pub t: f64,
    /// Distance of the two with the longest steps, `max |Δq|`, and of the next two.
    pub distances: [f64; 2],
    /// `p` of an error that goes as `hᵖ`.
    pub order: f64,
}

/// The order from the three longest of `steps`, the steps of the method that made `motions`; none where no
/// `p` between 0.1 and 12 explains the distances, or the motions have no time in common.
pub fn order(motions: &[Samples], steps: &[f64]) -> Option<Order> {
    let mut by_step: Vec<(f64, &Samples)> = steps.iter().copied().zip(motions).collect();
    by_step.sort_by(|a, b| b.0.total_cmp(&a.0));
    let [a, b, c] = by_step.get(..3)?.try_into().ok()?;
    let near = |s: &Samples, t: f64| s.t.iter().position(|x| (x - t).abs() <= 1e-9 * (1.0 + t.abs()));
    let (t, places) = a.1.t.iter().rev().find_map(|&t| {
        let places = [near(a.1, t)?, near(b.1, t)?, near(c.1, t)?];
        Some((t, places))
    })?;
    let [qa, qb, qc] = [(a.1, places[0]), (b.1, places[1]), (c.1, places[2])].map(|(s, i)| &s.q[i]);
    let distance = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    let distances = [distance(qa, qb), distance(qb, qc)];
    let excess = |p: f64| (a.0.powf(p) - b.0.powf(p)) / (b.0.powf(p) - c.0.powf(p)) - distances[0] / distances[1];
    let (mut low, mut high) = (0.1, 12.0);
    if excess(low).is_nan() || excess(low) > 0.0 || excess(high) < 0.0 {
        return None;
    }
    for _ in 0..80 {
        let middle = (low + high) / 2.0;
        if excess(middle) < 0.0 { low = middle } else { high = middle }
    }
    Some(Order { t, distances, order: low })
}
