//! Exponents of growth.

/// The slope of `log cost` over `log n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// The exponent.
    pub value: f64,
    /// Its standard error, from the scatter about the line.
    pub error: f64,
}

/// Fits `cost = c nᵖ` by least squares of the logarithms to `(n, cost)`; none for fewer than three points.
///
/// ```
/// let squares: Vec<(f64, f64)> = [20.0, 40.0, 80.0].map(|n: f64| (n, 3.0 * n * n)).into();
/// let fit = bench::exponent(&squares).unwrap();
/// assert!((fit.value - 2.0).abs() < 1e-12 && fit.error < 1e-12);
/// ```
pub fn exponent(points: &[(f64, f64)]) -> Option<Exponent> {
    let count = points.len() as f64;
    if points.len() < 3 {
        return None;
    }
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, cost)| (n.ln(), cost.ln())).collect();
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let spread: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
    let value = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
    let scatter: f64 = logs.iter().map(|p| (p.1 - y - value * (p.0 - x)).powi(2)).sum();
    Some(Exponent { value, error: (scatter / (count - 2.0) / spread).sqrt() })
}
