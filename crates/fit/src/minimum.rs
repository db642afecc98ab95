//! Minima of χ², and the selection of those to refine.

/// A local minimum.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// The unknowns.
    pub theta: Vec<f64>,
    /// The sum of squares there, priors included.
    pub chi_squared: f64,
    /// Starts that led there.
    pub reached: usize,
}

impl Minimum {
    /// A start, where χ² is not known.
    pub(crate) fn unseen(theta: Vec<f64>) -> Self {
        Minimum { theta, chi_squared: f64::INFINITY, reached: 1 }
    }
}

/// The least first, each once.
pub(crate) fn distinct(minima: &mut Vec<Minimum>, scale: &[f64]) {
    minima.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    let near = |a: &Minimum, b: &Minimum| distance(a, b, scale) < 1e-3;
    let mut kept: Vec<Minimum> = Vec::new();
    for minimum in minima.drain(..) {
        match kept.iter_mut().find(|other| near(other, &minimum)) {
            Some(other) => other.reached += minimum.reached,
            None => kept.push(minimum),
        }
    }
    *minima = kept;
}

/// No more than `count` of these: the least, then that which fits as well and is farthest from all others,
/// and so on; χ² does not tell those apart that fit.
pub(crate) fn spread_out(fits: &dyn Fn(f64) -> bool, found: Vec<Minimum>, scale: &[f64], count: usize) -> Vec<Minimum> {
    let (mut fitting, others): (Vec<_>, Vec<_>) = found.into_iter().partition(|m| fits(m.chi_squared));
    let mut kept: Vec<Minimum> = Vec::new();
    while kept.len() < count && !fitting.is_empty() {
        let nearest = |m: &Minimum| kept.iter().map(|k| distance(k, m, scale)).fold(f64::INFINITY, f64::min);
        let next = (0..fitting.len()).rev().max_by(|a, b| nearest(&fitting[*a]).total_cmp(&nearest(&fitting[*b])));
        kept.push(fitting.remove(next.unwrap_or(0)));
    }
    kept.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    kept.extend(others);
    kept.truncate(count);
    kept
}

/// The largest difference of an unknown, over its scale.
fn distance(a: &Minimum, b: &Minimum, scale: &[f64]) -> f64 {
    let each = a.theta.iter().zip(&b.theta).zip(scale).map(|((a, b), s)| ((a - b) / s).abs());
    each.fold(0.0, f64::max)
}
