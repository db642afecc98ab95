//! Linear least squares with errors that hold where residuals depend on their neighbours in time.

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

/// Runs of neighbouring rows whose sums of scores count as independent.
const BLOCKS: usize = 20;

/// An estimate with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Number {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// The estimates `θ` of `y = X θ` with a row of `X` and an entry of `y` a line, in the order of time, and
/// their errors: `(XᵀX)⁻¹ (Σ s sᵀ) (XᵀX)⁻¹`, `s` the sum of `x r` over one of twenty blocks of neighbours. A
/// column of zeros has no estimate, nor has what is not finite; where columns are dependent within 1e-10,
/// none has.
pub fn fit(x: &[Vec<f64>], y: &[f64]) -> Vec<Option<Number>> {
    let width = x.first().map_or(0, Vec::len);
    let norms: Vec<f64> = (0..width).map(|j| x.iter().map(|row| row[j] * row[j]).sum::<f64>().sqrt()).collect();
    let mut numbers = vec![None; width];
    let kept: Vec<usize> = (0..width).filter(|&j| norms[j] > 1e-150 && norms[j].is_finite()).collect();
    if kept.is_empty() {
        return numbers;
    }
    // columns of length one: whether they are independent does not hang on units
    let rows = DMatrix::from_fn(x.len(), kept.len(), |i, j| x[i][kept[j]] / norms[kept[j]]);
    let right = DVector::from_column_slice(y);
    let svd = rows.clone().svd(true, true);
    if svd.singular_values.min() < 1e-10 {
        return numbers;
    }
    let Ok(theta) = svd.solve(&right, 0.0) else { return numbers };
    let rest = right - &rows * &theta;
    let Some(inverse) = (rows.transpose() * &rows).try_inverse() else { return numbers };
    let count = BLOCKS.min(x.len());
    let mut meat = DMatrix::zeros(kept.len(), kept.len());
    for block in 0..count {
        let (from, to) = (block * x.len() / count, (block + 1) * x.len() / count);
        let score = rows.rows(from, to - from).transpose() * rest.rows(from, to - from);
        meat += &score * score.transpose();
    }
    let free = count.saturating_sub(kept.len()).max(1);
    let covariance = &inverse * meat * &inverse * (count as f64 / free as f64);
    for (k, &j) in kept.iter().enumerate() {
        let number = Number { value: theta[k] / norms[j], error: covariance[(k, k)].sqrt() / norms[j] };
        numbers[j] = Some(number).filter(|n| n.value.is_finite() && n.error.is_finite());
    }
    numbers
}

/// Root of the mean square.
pub fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0usize), |(s, n), x| (s + x * x, n + 1));
    (sum / count.max(1) as f64).sqrt()
}
