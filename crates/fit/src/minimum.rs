//! Minima of χ², and the selection of those to refine.

use motion::shooting::{self, Minimum};

/// The least first, each once.
pub(crate) fn distinct(minima: &mut Vec<Minimum>, scale: &[f64]) {
    shooting::distinct(minima, |known, other| known.distance(other, scale) < 1e-3);
}

/// No more than `count` of these: the least, then that which fits as well and is farthest from all others,
/// and so on; χ² does not tell those apart that fit.
pub(crate) fn spread_out(fits: &dyn Fn(f64) -> bool, found: Vec<Minimum>, scale: &[f64], count: usize) -> Vec<Minimum> {
    let (mut fitting, others): (Vec<_>, Vec<_>) = found.into_iter().partition(|m| fits(m.value));
    let mut kept: Vec<Minimum> = Vec::new();
    while kept.len() < count && !fitting.is_empty() {
        let nearest = |m: &Minimum| kept.iter().map(|k| k.distance(m, scale)).fold(f64::INFINITY, f64::min);
        let next = (0..fitting.len()).rev().max_by(|a, b| nearest(&fitting[*a]).total_cmp(&nearest(&fitting[*b])));
        kept.push(fitting.remove(next.unwrap_or(0)));
    }
    kept.sort_by(|a, b| a.value.total_cmp(&b.value));
    kept.extend(others);
    kept.truncate(count);
    kept
}
