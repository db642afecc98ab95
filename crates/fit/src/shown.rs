//! What films show of the unknowns beside a minimum, and unknowns that change nothing there.

use motion::shooting::Minimum;
use nalgebra::{DMatrix, DVector};

use crate::least::{Stage, least, scaled};
use crate::problem::NOTHING;
use crate::profile::SHOWN;
use crate::search::is_as_high;
use crate::{FitError, Problem};

/// What films show of the unknowns to first order.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Standard errors, one per unknown; infinite for those in a combination that no film shows.
    pub errors: Vec<f64>,
    /// Combinations that no film shows, as text.
    pub hidden: Vec<String>,
}

/// Standard errors of the unknowns at `theta`, to first order: roots of the diagonal of `(JᵀJ)⁻¹`. What is
/// seen in the films has no part in it, so that films that are not yet made can be judged.
///
/// # Errors
/// [`FitError::NoMotion`].
pub fn standard_errors(problem: &Problem, theta: &[f64]) -> Result<Shown, FitError> {
    let derivatives = problem.clone().weighed(theta, true);
    let (_, jacobian) = derivatives.map_err(|reason| FitError::NoMotion { starts: 1, reason })?;
    Ok(shown(problem, theta, &jacobian))
}

/// The same where residuals have this Jacobian.
pub(crate) fn shown(problem: &Problem, theta: &[f64], jacobian: &DMatrix<f64>) -> Shown {
    let (matrix, lengths) = scaled(jacobian);
    let width = lengths.len();
    let alone = alone(problem, theta, &lengths);
    let seen: Vec<usize> = (0..width).filter(|j| !alone.contains(j)).collect();
    let mut hidden: Vec<DVector<f64>> = (0..width)
        .filter(|j| alone.contains(j))
        .map(|j| DVector::from_fn(width, |i, _| f64::from(u8::from(i == j))))
        .collect();
    let mut squares = vec![0.0; width];
    if !seen.is_empty() {
        let svd = matrix.select_columns(&seen).svd(false, true);
        let rows = svd.v_t.as_ref().expect("asked for");
        let limit = SHOWN * svd.singular_values.max();
        for (row, &s) in rows.row_iter().zip(svd.singular_values.iter()) {
            if s.is_nan() || s <= limit {
                let mut along = DVector::zeros(width);
                seen.iter().zip(row.iter()).for_each(|(&j, x)| along[j] = x / lengths[j]);
                hidden.push(along);
            } else {
                seen.iter().zip(row.iter()).for_each(|(&j, x)| squares[j] += (x / (s * lengths[j])).powi(2));
            }
        }
    }
    let mut errors: Vec<f64> = squares.into_iter().map(f64::sqrt).collect();
    for along in &hidden {
        parts(along, &lengths).into_iter().for_each(|i| errors[i] = f64::INFINITY);
    }
    Shown { errors, hidden: hidden.iter().map(|along| combination(problem, along, &lengths)).collect() }
}

/// The unknowns that change nothing: a change by their own size, 1 for zero, changes residuals by less than
/// [`NOTHING`] in all.
fn alone(problem: &Problem, theta: &[f64], lengths: &[f64]) -> Vec<usize> {
    let size = |j: usize| {
        let size = problem.start()[j].abs();
        if size > 0.0 { size.max(theta[j].abs()) } else { 1.0_f64.max(theta[j].abs()) }
    };
    (0..lengths.len()).filter(|&j| lengths[j] * size(j) < NOTHING).collect()
}

/// The unknowns in a direction; parts that change residuals by less than a thousandth of the largest do not
/// count.
fn parts(along: &DVector<f64>, lengths: &[f64]) -> Vec<usize> {
    let size = |(x, l): (&f64, &f64)| if *l > 0.0 { (x * l).abs() } else { x.abs() };
    let sizes: Vec<f64> = along.iter().zip(lengths).map(size).collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    (0..sizes.len()).filter(|&i| sizes[i] > 1e-3 * largest).collect()
}

/// A direction that no film shows, as text.
fn combination(problem: &Problem, along: &DVector<f64>, lengths: &[f64]) -> String {
    let parts = parts(along, lengths);
    let label = |i: usize| problem.unknowns()[i].label();
    match parts[..] {
        [only] => label(only),
        _ => {
            let part = |&i: &usize| format!("{} by {:.3e}", label(i), along[i] / along[parts[0]]);
            parts.iter().map(part).collect::<Vec<_>>().join(" with ")
        }
    }
}

/// Parts of the size of an unknown by which it is moved for a second look.
const LOOKS: [f64; 4] = [1e-2, 0.03, 0.1, 0.5];

/// The least of these changes of an unknown, whose derivative is nothing, that moves residuals all the same:
/// they are stationary there.
pub(crate) fn moving(problem: &Problem, best: &Minimum, i: usize) -> Option<f64> {
    let mut looked = problem.clone();
    let (here, _) = looked.weighed(&best.unknowns, false).ok()?;
    let size = if best.unknowns[i] == 0.0 { 1.0 } else { best.unknowns[i].abs() };
    LOOKS.into_iter().map(|part| part * size).find(|step| {
        let mut theta = best.unknowns.clone();
        theta[i] += step;
        let moved = looked.weighed(&theta, false);
        moved.is_ok_and(|(there, _)| (there - &here).norm() > 1e3 * NOTHING)
    })
}

/// The least minimum, where one begins beside unknowns at which residuals are stationary: no derivative leads
/// away from there.
pub(crate) fn off_stationary(problem: &Problem, best: Minimum) -> Minimum {
    let Ok((_, jacobian)) = problem.clone().weighed(&best.unknowns, true) else { return best };
    let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let mut least_known = best.clone();
    for i in alone(problem, &best.unknowns, &lengths) {
        let Some(step) = moving(problem, &best, i) else { continue };
        let scale: Vec<f64> = lengths.iter().map(|l| if *l > 0.0 { l.recip() } else { step }).collect();
        for side in [1.0, -1.0] {
            let mut theta = best.unknowns.clone();
            theta[i] += side * step;
            let found = least(problem, &theta, &scale, Stage::Whole);
            if let Some(found) = found.ok().filter(|found| !is_as_high(least_known.value, found.value)) {
                least_known = Minimum { reached: best.reached, first: best.first, ..found };
            }
        }
    }
    least_known
}

/// What a minimum is where unknowns that change nothing there are held.
pub(crate) struct Near {
    /// These, ascending.
    pub(crate) held: Vec<usize>,
    /// The problem with these where the search began, its minimum, and the Jacobian there.
    pub(crate) less: Problem,
    pub(crate) best: Minimum,
    pub(crate) jacobian: DMatrix<f64>,
}

impl Near {
    pub(crate) fn new(problem: &Problem, best: &Minimum) -> Result<Near, FitError> {
        let no_motion = |reason| FitError::NoMotion { starts: 1, reason };
        let (_, jacobian) = problem.clone().weighed(&best.unknowns, true).map_err(no_motion)?;
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        let held = alone(problem, &best.unknowns, &lengths);
        if held.len() == lengths.len() && held.iter().all(|&i| moving(problem, best, i).is_none()) {
            return Err(FitError::ShowsNothing);
        }
        let (mut shown, mut theta, mut scale) = (problem.clone(), best.unknowns.clone(), lengths);
        for &i in held.iter().rev() {
            shown = shown.without(i, problem.start()[i]);
            theta.remove(i);
            scale.remove(i);
        }
        let all = |held, jacobian| Near { held, less: problem.clone(), best: best.clone(), jacobian };
        if held.is_empty() {
            return Ok(all(held, jacobian));
        }
        scale.iter_mut().for_each(|length| *length = 1.0 / *length);
        let found = least(&shown, &theta, &scale, Stage::Whole).map_err(no_motion)?;
        // an unknown is held where χ² is as high
        if !is_as_high(found.value, best.value) {
            return Ok(all(Vec::new(), jacobian));
        }
        let (_, jacobian) = shown.clone().weighed(&found.unknowns, true).map_err(no_motion)?;
        Ok(Near { held, less: shown, best: Minimum { reached: best.reached, first: best.first, ..found }, jacobian })
    }
}
