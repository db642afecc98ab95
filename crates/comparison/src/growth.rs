//! How a gap starts: exponent and leading coefficient, measured and predicted.

use mechanics::SingularValues;
use nalgebra::{DMatrix, DVector};

use motion::band::LOOKS;
use motion::{Metric, subtract};
use motion::{Motion, SolveError};
use symbolic::limits::SAME;

/// Growth of a gap near the start: `gap ≈ coefficient · (t − t₀)^exponent`.
#[derive(Clone, Debug)]
pub struct Growth {
    /// Slope of log gap over log t, extrapolated to the start.
    pub exponent: f64,
    /// The exponent's change when the fit has one term less: how far the range is from the start.
    pub uncertainty: f64,
    /// `Δq / (t − t₀)^k` extrapolated to the start, `k` the rounded exponent; length n.
    pub coefficient: Vec<f64>,
    /// The part of it that changes when the fit has one term less, Euclidean.
    pub coefficient_uncertainty: f64,
    /// Its kinetic length.
    pub length: f64,
    /// Fit range in `t − t₀`.
    pub from: f64,
    /// Fit range in `t − t₀`.
    pub to: f64,
}

/// Leading term of the difference of two motions with one start: `coefficient · (t − t₀)^exponent` (T5).
///
/// `y_k / ((k+1)(k+2))` where the difference of their accelerations along one starts with `y_k (t − t₀)^k`.
/// Chetaev to vakonomic: `½ Π C μ₀ t²`, `Π` at `μ₀` if `f` is not affine in `v`, and
/// `−⅙ Π C λ₀ t³` for `μ₀ = 0`.
#[derive(Clone, Debug)]
pub struct LeadingTerm {
    /// `k + 2`.
    pub exponent: u32,
    /// Length n.
    pub coefficient: Vec<f64>,
    /// Its kinetic length.
    pub length: f64,
    /// The time up to which a lower term may make more of the difference, lost in its round-off; 0 where all
    /// lower ones are zero.
    pub from: f64,
    /// The time after which a later term may make more of the difference than this one.
    pub reach: f64,
    /// Whether it is proved in exact numbers that this term is the first one: then the motions differ.
    pub proved: bool,
}

/// A growth is compared with its prediction if it was measured within this part of the time in which the
/// predicted term leads. It is measured within as large a part of the common time.
const LEADS: f64 = 0.3;

impl LeadingTerm {
    /// Whether it leads between these times.
    pub fn leads(&self, from: f64, to: f64) -> bool {
        self.from < LEADS * from && to < LEADS * self.reach
    }
}

impl Growth {
    /// Whether it is that of this term, as far as one was measured where the term leads.
    pub fn is_of(&self, predicted: &LeadingTerm) -> bool {
        self.exponent.round() == f64::from(predicted.exponent) || predicted.leads(self.from, self.to)
    }

    /// `|measured − predicted| / |predicted|` of leading coefficients, Euclidean over the coordinates.
    pub fn deviation_from(&self, predicted: &LeadingTerm) -> f64 {
        norm(&subtract(&self.coefficient, &predicted.coefficient)) / norm(&predicted.coefficient)
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|a| a * a).sum::<f64>().sqrt()
}

/// Where the fit range begins, as a fraction of its end.
const BEGIN: f64 = 0.15;
/// The gap at the beginning of the fit range has to be this many times its certainty limit.
const FIT_CERTAINTY: f64 = 300.0;

/// Fits the growth of `first − second` near the start. `None` if the gap is not above errors there.
///
/// # Errors
/// [`SolveError`] where a motion cannot be read off.
pub fn growth(
    first: &mut Motion,
    second: &mut Motion,
    metric: &mut Metric,
    limit_at: &dyn Fn(f64) -> f64,
) -> Result<Option<Growth>, SolveError> {
    let start = first.start();
    let horizon = first.end().min(second.end()) - start;
    let origin = first.at(start)?;
    let (q0, v0) = (origin.coordinates, origin.velocities);
    let mut difference_at = |s: f64| -> Result<(f64, Vec<f64>, f64), SolveError> {
        let difference = subtract(&first.at(start + s)?.coordinates, &second.at(start + s)?.coordinates);
        let gap = metric.length(start, &q0, &v0, &difference);
        Ok((s, difference, gap))
    };
    // the shortest range over which the gap stands out from the errors
    let mut to = horizon * SAME;
    while difference_at(BEGIN * to)?.2 <= FIT_CERTAINTY * limit_at(start + BEGIN * to) {
        to *= 1.5;
        if to == 0.0 || to > LEADS * horizon {
            return Ok(None);
        }
    }
    let from = BEGIN * to;
    let step = (to - from) / (LOOKS - 1) as f64;
    let differences: Vec<(f64, Vec<f64>, f64)> =
        (0..LOOKS).map(|i| difference_at(from + step * i as f64)).collect::<Result<_, _>>()?;
    // log gap = log c + k log s + a s + b s²
    let design = |s: f64| [1.0, s.ln(), s / to, (s / to).powi(2)];
    let shorter = |s: f64| [1.0, s.ln(), s / to, 0.0];
    let logarithms: Vec<f64> = differences.iter().map(|d| d.2.ln()).collect();
    let fit = least_squares(&differences, &design, &logarithms);
    let exponent = fit[1];
    let uncertainty = (least_squares(&differences, &shorter, &logarithms)[1] - exponent).abs();
    let k = exponent.round();
    // Δq / s^k = c + c₁ s + c₂ s² + c₃ s³, coordinate by coordinate
    let extrapolated = |terms: usize| -> Vec<f64> {
        let powers = |s: f64| std::array::from_fn(|p| if p < terms { (s / to).powi(p as i32) } else { 0.0 });
        let scaled = |i: usize| -> Vec<f64> { differences.iter().map(|(s, d, _)| d[i] / s.powf(k)).collect() };
        (0..q0.len()).map(|i| least_squares(&differences, &powers, &scaled(i))[0]).collect()
    };
    let coefficient = extrapolated(4);
    let coefficient_uncertainty = norm(&subtract(&coefficient, &extrapolated(3))) / norm(&coefficient);
    let length = metric.length(start, &q0, &v0, &coefficient);
    Ok(Some(Growth { exponent, uncertainty, coefficient, coefficient_uncertainty, length, from, to }))
}

fn least_squares(at: &[(f64, Vec<f64>, f64)], design: &dyn Fn(f64) -> [f64; 4], values: &[f64]) -> DVector<f64> {
    let matrix = DMatrix::from_fn(at.len(), 4, |i, j| design(at[i].0)[j]);
    SingularValues::of(&matrix).solve(&DVector::from_column_slice(values), 1e-14)
}
