//! How a gap starts: exponent and leading coefficient, measured and predicted.

use std::collections::HashMap;

use mechanics::{State, System};
use nalgebra::{DMatrix, DVector};
use symbolic::{CompileError, Symbol};

use crate::metric::{Metric, numbers, subtract};
use crate::{Motion, SolveError};

/// Growth of a gap near the start: `gap ≈ coefficient · (t − t₀)^exponent`.
#[derive(Clone, Debug)]
pub struct Growth {
    /// Slope of log gap over log t, extrapolated to the start.
    pub exponent: f64,
    /// What the exponent changes by when the fit has one term less: a measure of how far the range is from the start.
    pub uncertainty: f64,
    /// `Δq / (t − t₀)^k` extrapolated to the start, `k` the rounded exponent; length n.
    pub coefficient: Vec<f64>,
    /// Its kinetic length.
    pub length: f64,
    /// Fit range in `t − t₀`.
    pub from: f64,
    /// Fit range in `t − t₀`.
    pub to: f64,
}

/// The leading term of `q_vakonomic − q_Chetaev` for constraints linear in `v` (T5).
#[derive(Clone, Debug)]
pub struct LeadingTerm {
    /// 2 where `Π C μ₀ ≠ 0`, else 3.
    pub exponent: u32,
    /// `½ Π C μ₀`, or `−⅙ Π C λ₀`; length n.
    pub coefficient: Vec<f64>,
    /// Its kinetic length.
    pub length: f64,
}

impl Growth {
    /// `|measured − predicted| / |predicted|` of the leading coefficient, Euclidean norm over the coordinates.
    pub fn deviation_from(&self, predicted: &LeadingTerm) -> f64 {
        let norm = |x: &[f64]| x.iter().map(|a| a * a).sum::<f64>().sqrt();
        norm(&subtract(&self.coefficient, &predicted.coefficient)) / norm(&predicted.coefficient)
    }
}

/// The shortest fit range, as a fraction of the common time, and the longest.
const SHORTEST: f64 = 1e-4;
const LONGEST: f64 = 0.3;
/// Where the fit range begins, as a fraction of its end.
const BEGIN: f64 = 0.15;
/// Instants in the fit.
const FIT_POINTS: usize = 24;
/// The gap at the beginning of the fit range has to be this many times its certainty limit.
const FIT_CERTAINTY: f64 = 300.0;
/// A leading term under this fraction of the terms it is made of counts as zero.
const VANISHES: f64 = 1e-10;

/// Fits the growth of `first − second` near the start. `None` where the gap does not stand out from the errors there.
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
    let mut to = horizon * SHORTEST;
    while difference_at(BEGIN * to)?.2 <= FIT_CERTAINTY * limit_at(start + BEGIN * to) {
        to *= 1.5;
        if to > LONGEST * horizon {
            return Ok(None);
        }
    }
    let from = BEGIN * to;
    let step = (to - from) / (FIT_POINTS - 1) as f64;
    let differences: Vec<(f64, Vec<f64>, f64)> =
        (0..FIT_POINTS).map(|i| difference_at(from + step * i as f64)).collect::<Result<_, _>>()?;
    // log gap = log c + k log s + a s + b s²
    let design = |s: f64| [1.0, s.ln(), s / to, (s / to).powi(2)];
    let shorter = |s: f64| [1.0, s.ln(), s / to, 0.0];
    let logarithms: Vec<f64> = differences.iter().map(|d| d.2.ln()).collect();
    let Some(fit) = least_squares(&differences, &design, &logarithms) else { return Ok(None) };
    let exponent = fit[1];
    let uncertainty =
        least_squares(&differences, &shorter, &logarithms).map_or(f64::INFINITY, |fit| (fit[1] - exponent).abs());
    let k = exponent.round();
    // Δq / s^k = c + c₁ s + c₂ s² + c₃ s³, coordinate by coordinate
    let powers = |s: f64| [1.0, s / to, (s / to).powi(2), (s / to).powi(3)];
    let mut coefficient = vec![0.0; q0.len()];
    for (i, c) in coefficient.iter_mut().enumerate() {
        let scaled: Vec<f64> = differences.iter().map(|(s, d, _)| d[i] / s.powf(k)).collect();
        match least_squares(&differences, &powers, &scaled) {
            Some(fit) => *c = fit[0],
            None => return Ok(None),
        }
    }
    let length = metric.length(start, &q0, &v0, &coefficient);
    Ok(Some(Growth { exponent, uncertainty, coefficient, length, from, to }))
}

fn least_squares(
    at: &[(f64, Vec<f64>, f64)],
    design: &dyn Fn(f64) -> [f64; 4],
    values: &[f64],
) -> Option<DVector<f64>> {
    let matrix = DMatrix::from_fn(at.len(), 4, |i, j| design(at[i].0)[j]);
    matrix.svd(true, true).solve(&DVector::from_column_slice(values), 1e-14).ok()
}

/// Predicts the leading term of `q_vakonomic − q_Chetaev` from one start:
///
/// ```text
/// ½ Π C μ₀ t² + O(t³),   and where Π C μ₀ = 0:   −⅙ Π C λ₀ t³ + O(t⁴)
/// C = f_qᵀ − Ȧᵀ  (n×h, curvature of the constraint),   Π = M⁻¹ − M⁻¹Aᵀ (A M⁻¹ Aᵀ)⁻¹ A M⁻¹ .
/// ```
///
/// `None` where a constraint is not linear in `v`, or `M` is singular on the kernel of `A` at the start. (`Π` is computed from the saddle-point
/// system, so `M` itself may be singular.) `reaction` is Chetaev's `λ₀`.
///
/// # Errors
/// [`CompileError`] where an expression contains an undefined symbol.
///
/// ```
/// # let scene = scene::Scene::parse("sledge", include_str!("../../scene/sledge.toml"))?;
/// // the ice sledge: where mu0 is not zero, it turns differently from the start
/// let term = deltaq::leading_term(&scene.system, &scene.start, &[2.0], &[0.0])?.unwrap();
/// assert_eq!(term.exponent, 2);
/// // f_phi = -y'*sin(phi) - x'*cos(phi) is minus the speed along the blade; phi - phi_chetaev = f_phi*mu0/2 t²
/// let speed = scene.start.v[0] / 0.3_f64.cos();
/// assert!((term.coefficient[2] + speed).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn leading_term(
    system: &System,
    state: &State,
    multipliers: &[f64],
    reaction: &[f64],
) -> Result<Option<LeadingTerm>, CompileError> {
    if system.constraints.is_empty() || !system.constraints_linear_in_velocity() {
        return Ok(None);
    }
    let system = system.clone();
    let g = &system.graph;
    let mut values: HashMap<Symbol, f64> = system.parameter_values();
    values.extend(system.values_at(state));
    let (q, v) = (system.positions(), system.velocities());
    let jacobian = system.constraint_jacobian();
    let flow: Vec<_> = system.flow().into_iter().filter(|(s, _)| !v.contains(s)).collect();
    let jacobian_rate = symbolic::Matrix::from_fn(jacobian.rows(), jacobian.columns(), |i, j| {
        g.total_derivative(jacobian[(i, j)], &flow)
    });
    let a = numbers(g, &jacobian, &values)?;
    let curvature =
        (numbers(g, &g.jacobian(&system.constraints, &q), &values)? - numbers(g, &jacobian_rate, &values)?).transpose();
    let mass = numbers(g, &system.velocity_hessian(), &values)?;
    // Π F is the acceleration that the force F gives under the constraint: M α + Aᵀ κ = F, A α = 0
    let (n, h) = (mass.nrows(), a.nrows());
    let mut saddle = DMatrix::zeros(n + h, n + h);
    saddle.view_mut((0, 0), (n, n)).copy_from(&mass);
    saddle.view_mut((0, n), (n, h)).copy_from(&a.transpose());
    saddle.view_mut((n, 0), (h, n)).copy_from(&a);
    let saddle = saddle.lu();
    if !saddle.is_invertible() {
        return Ok(None);
    }
    let term = |weight: f64, multiplier: &[f64]| {
        let force = &curvature * DVector::from_column_slice(multiplier) * weight;
        let solution =
            saddle.solve(&force.clone().resize_vertically(n + h, 0.0)).unwrap_or_else(|| DVector::zeros(n + h));
        let coefficient = solution.rows(0, n).into_owned();
        let vanishes = coefficient.norm() <= VANISHES * solution.norm() || force.norm() == 0.0;
        let length = (coefficient.transpose() * &mass * &coefficient)[(0, 0)].abs().sqrt();
        (vanishes, coefficient.as_slice().to_vec(), length)
    };
    let (vanishes, coefficient, length) = term(0.5, multipliers);
    if !vanishes {
        return Ok(Some(LeadingTerm { exponent: 2, coefficient, length }));
    }
    if multipliers.iter().any(|&mu| mu != 0.0) {
        return Ok(None); // Π C μ₀ = 0 with μ₀ ≠ 0: the next term is not given by λ₀ alone
    }
    let (vanishes, coefficient, length) = term(-1.0 / 6.0, reaction);
    Ok((!vanishes).then_some(LeadingTerm { exponent: 3, coefficient, length }))
}
