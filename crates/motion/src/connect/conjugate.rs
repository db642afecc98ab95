//! Times at which `det ∂q(t)/∂x` vanishes.
//!
//! Rows and columns are in units of the problem. All columns are dependent at first, by a power of `t − t₀`:
//! nothing is looked for before they are independent as far as round-off tells.

use integrate::PARTS;
use nalgebra::DMatrix;
use symbolic::limits::{HALF_THE_DIGITS, ITERATIONS};

use crate::SolveError;
use crate::band::SAMPLES;
use crate::band::limits::NEARLY_ZERO;

/// A time conjugate to the start of a motion.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct ConjugateTime {
    /// When.
    pub t: f64,
    /// What two runs differ by; infinite where the looser one has it not.
    #[schemars(with = "Option<f64>")]
    pub error: f64,
    /// By how much the rank of `∂q(t)/∂x` falls.
    pub multiplicity: usize,
}

/// `∂q(t)/∂x`.
pub type Matrix<'a> = dyn FnMut(f64) -> Result<DMatrix<f64>, SolveError> + 'a;

/// Times at which it is looked at.
pub fn samples(start: f64, end: f64, steps: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = (1..=SAMPLES).map(|i| start + (end - start) * i as f64 / SAMPLES as f64).collect();
    for step in steps.windows(2).filter(|step| step[1] > step[0]) {
        all.extend((1..PARTS).map(|i| step[0] + (step[1] - step[0]) * i as f64 / PARTS as f64));
    }
    all.sort_by(f64::total_cmp);
    let shortest = 1e-9 * (end - start);
    let mut last = start;
    all.retain(|&t| {
        let keep = t - last > shortest && t <= end;
        last = if keep { t } else { last };
        keep
    });
    all
}

struct Look {
    t: f64,
    positive: bool,
    smallest: f64,
}

fn look(matrix: &mut Matrix, t: f64) -> Result<Look, SolveError> {
    let found = matrix(t)?;
    Ok(Look { t, positive: found.determinant() > 0.0, smallest: smallest(&found) })
}

fn smallest(matrix: &DMatrix<f64>) -> f64 {
    singular_values(matrix).last().copied().unwrap_or(0.0)
}

/// The matrix with columns of length 1.
fn normalized(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for mut column in matrix.column_iter_mut() {
        let length = column.norm();
        column *= if length > 0.0 { length.recip() } else { 0.0 };
    }
    matrix
}

/// Falling.
fn singular_values(matrix: &DMatrix<f64>) -> Vec<f64> {
    match matrix.iter().all(|x| x.is_finite()) {
        true => matrix.singular_values().iter().copied().collect(),
        false => vec![0.0; matrix.nrows()],
    }
}

/// Condition number, infinite for a singular matrix.
pub(super) fn condition(matrix: &DMatrix<f64>) -> f64 {
    let values = singular_values(matrix);
    let (largest, smallest) = (values[0], values[values.len() - 1]);
    if smallest > 0.0 { largest / smallest } else { f64::INFINITY }
}

/// The times, each with its multiplicity, among `samples`; `None` where the matrix is singular at all.
///
/// # Errors
/// Those of the matrix.
pub fn times(matrix: &mut Matrix, samples: &[f64]) -> Result<Option<Vec<(f64, usize)>>, SolveError> {
    let mut looks = Vec::new();
    for &t in samples {
        if !looks.is_empty() || smallest(&normalized(matrix(t)?)) > HALF_THE_DIGITS {
            looks.push(look(matrix, t)?);
        }
    }
    if looks.is_empty() {
        return Ok(None);
    }
    let mut found = Vec::new();
    for i in 1..looks.len() {
        let [a, b] = [&looks[i - 1], &looks[i]];
        if a.positive != b.positive {
            let t = crossing(matrix, [a, b])?;
            found.push((t, multiplicity(matrix, [a.t, t, b.t])?.max(1)));
        } else if let Some(c) = looks.get(i + 1)
            && c.positive == b.positive
            && b.smallest <= a.smallest
            && b.smallest < c.smallest
        {
            found.extend(touching(matrix, [a, c])?);
        }
    }
    Ok(Some(found))
}

/// Where the sign changes between two times.
fn crossing(matrix: &mut Matrix, [a, b]: [&Look; 2]) -> Result<f64, SolveError> {
    let (mut from, mut to) = (a.t, b.t);
    for _ in 0..ITERATIONS {
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            break;
        }
        match look(matrix, middle)?.positive == a.positive {
            true => from = middle,
            false => to = middle,
        }
    }
    Ok(0.5 * (from + to))
}

/// The zeros between two times of the same sign: none, two, or one at which the rank falls by two or more.
fn touching(matrix: &mut Matrix, [a, b]: [&Look; 2]) -> Result<Vec<(f64, usize)>, SolveError> {
    let least = integrate::least(
        |t| match look(matrix, t) {
            Ok(other) if other.positive == a.positive => Ok(other.smallest),
            other => Err(other),
        },
        [a.t, b.t],
    );
    let t = match least {
        Ok((t, _)) => t,
        Err(other) => {
            let other = other?;
            let both = [crossing(matrix, [a, &other])?, crossing(matrix, [&other, b])?];
            return Ok(both.into_iter().map(|t| (t, 1)).collect());
        }
    };
    let found = multiplicity(matrix, [a.t, t, b.t])?;
    Ok(if found > 0 { vec![(t, found)] } else { Vec::new() })
}

/// How many singular values vanish at the time between two others.
fn multiplicity(matrix: &mut Matrix, times: [f64; 3]) -> Result<usize, SolveError> {
    let [before, at, after] = times.map(|t| matrix(t).map(|matrix| singular_values(&matrix)));
    let (before, at, after) = (before?, at?, after?);
    let vanishes = |i: &usize| at[*i] < NEARLY_ZERO * before[*i].min(after[*i]);
    Ok((0..at.len()).filter(vanishes).count())
}

/// The times of the kept run, with what those of the looser one differ by.
pub(super) fn with_errors(kept: &[(f64, usize)], looser: Option<&[(f64, usize)]>) -> Vec<ConjugateTime> {
    let other = |i: usize| looser.filter(|looser| looser.len() == kept.len()).map(|looser| looser[i].0);
    let each = kept.iter().enumerate();
    each.map(|(i, &(t, multiplicity))| {
        let error = other(i).map_or(f64::INFINITY, |other| (t - other).abs() + 4.0 * f64::EPSILON * t.abs());
        ConjugateTime { t, error, multiplicity }
    })
    .collect()
}
