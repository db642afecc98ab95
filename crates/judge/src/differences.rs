//! Values and derivatives between samples, by the polynomial through the nearest of them.

/// Weights `w[d][j]` such that `Σⱼ w[d][j] y(tⱼ)` is the derivative of order `d ≤ 2` at `at` of the
/// polynomial through the samples (Fornberg 1988): exact for polynomials of a degree less than the number of
/// `nodes`.
pub fn weights(nodes: &[f64], at: f64) -> [Vec<f64>; 3] {
    let mut w = [0; 3].map(|_| vec![0.0; nodes.len()]);
    w[0][0] = 1.0;
    let (mut product, mut from) = (1.0, nodes[0] - at);
    for i in 1..nodes.len() {
        let (mut next, before) = (1.0, from);
        from = nodes[i] - at;
        for j in 0..i {
            let distance = nodes[i] - nodes[j];
            next *= distance;
            if j == i - 1 {
                for d in (0..3).rev() {
                    let lower = if d > 0 { d as f64 * w[d - 1][i - 1] } else { 0.0 };
                    w[d][i] = product * (lower - before * w[d][i - 1]) / next;
                }
            }
            for d in (0..3).rev() {
                let lower = if d > 0 { d as f64 * w[d - 1][j] } else { 0.0 };
                w[d][j] = (from * w[d][j] - lower) / distance;
            }
        }
        product = next;
    }
    w
}

/// The derivative of order `d` of `rows` at `t[i]`, by the `2 reach + 1` samples around it, or the first or
/// last ones.
pub fn derivative(t: &[f64], rows: &[Vec<f64>], i: usize, reach: usize, d: usize) -> Vec<f64> {
    let first = i.saturating_sub(reach).min(t.len().saturating_sub(2 * reach + 1));
    let window = first..(first + 2 * reach + 1).min(t.len());
    combine(&rows[window.clone()], &weights(&t[window], t[i])[d])
}

/// The value of `rows` halfway between `t[i]` and `t[i + 1]`, by six samples around it.
pub fn halfway(t: &[f64], rows: &[Vec<f64>], i: usize) -> Vec<f64> {
    let first = i.saturating_sub(2).min(t.len().saturating_sub(6));
    let window = first..(first + 6).min(t.len());
    combine(&rows[window.clone()], &weights(&t[window], (t[i] + t[i + 1]) / 2.0)[0])
}

fn combine(rows: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; rows[0].len()];
    for (row, w) in rows.iter().zip(weights) {
        sum.iter_mut().zip(row).for_each(|(s, x)| *s += w * x);
    }
    sum
}
