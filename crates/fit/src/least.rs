//! The least squares near a start.

use integrate::{BoundaryError, Residuals, ShootOptions};
use motion::shooting::Minimum;
use nalgebra::DMatrix;

use crate::Problem;

/// Least gain, as a part of χ², for which an iteration goes on, by [`Stage`].
const GAINS: [f64; 5] = [1e-2, 1e-4, 1e-8, 1e-6, 1e-4];
/// Iterations by [`Stage`].
const ITERATIONS: [usize; 5] = [10, 20, 100, 12, 50];

/// What is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// A beginning, coarsely; the start counts as a measurement.
    Beginning,
    /// The whole film, coarsely.
    Rough,
    /// The whole film.
    Whole,
    /// The whole film, with one unknown held beside a minimum.
    Profile,
    /// The whole film, coarsely, where residuals are many deviations.
    Poor,
}

/// The minimum near `start`, no unknown below its bound: one that would be is at it.
pub(crate) fn least(problem: &Problem, start: &[f64], scale: &[f64], stage: Stage) -> Result<Minimum, String> {
    let mut found = match start {
        [] => {
            let (values, _) = problem.clone().weighed(&[], false)?;
            return Ok(Minimum { value: values.norm_squared(), ..Minimum::start(0, Vec::new()) });
        }
        _ => minimise(&mut problem.clone(), start, scale, stage)?,
    };
    let bounds = problem.unknowns().iter().map(|unknown| unknown.bound);
    let mut each = bounds.zip(&found.unknowns).enumerate();
    let below = each.find_map(|(i, (bound, x))| bound.filter(|bound| x < bound).map(|bound| (i, bound)));
    if let Some((i, bound)) = below {
        let mut scale = scale.to_vec();
        found.unknowns.remove(i);
        scale.remove(i);
        found = least(&problem.without(i, bound), &found.unknowns, &scale, stage)?;
        found.unknowns.insert(i, bound);
    }
    Ok(found)
}

fn minimise(problem: &mut Problem, start: &[f64], scale: &[f64], stage: Stage) -> Result<Minimum, String> {
    let guess: Vec<f64> = start.iter().zip(scale).map(|(x, s)| x / s).collect();
    let count = problem.count();
    let held = (stage == Stage::Beginning).then(|| guess.clone());
    let rows = count + held.as_ref().map_or(0, Vec::len);
    let options = ShootOptions {
        max_iterations: ITERATIONS[stage as usize],
        least_gain: GAINS[stage as usize],
        ..ShootOptions::with_tolerance(1e-10)
    };
    let mut squares = Squares { problem: &mut *problem, scale, held };
    let shot = integrate::fit(&mut squares, rows, &guess, &options).map_err(|error| error.to_string())?;
    let theta: Vec<f64> = shot.unknowns.iter().zip(scale).map(|(x, s)| x * s).collect();
    let (values, _) = problem.weighed(&theta, false)?;
    Ok(Minimum { value: values.norm_squared(), ..Minimum::start(0, theta) })
}

/// Residuals as functions of unknowns over their scales.
struct Squares<'a> {
    problem: &'a mut Problem,
    scale: &'a [f64],
    held: Option<Vec<f64>>,
}

impl Squares<'_> {
    fn theta(&self, unknowns: &[f64]) -> Vec<f64> {
        unknowns.iter().zip(self.scale).map(|(x, s)| x * s).collect()
    }
}

impl Residuals for Squares<'_> {
    fn residual(&mut self, unknowns: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError> {
        let theta = self.theta(unknowns);
        let broken = |reason| BoundaryError::Residual { reason };
        let (values, _) = self.problem.weighed(&theta, false).map_err(broken)?;
        let held = self.held.iter().flatten().zip(unknowns).map(|(held, x)| x - held);
        residual.iter_mut().zip(values.iter().copied().chain(held)).for_each(|(r, value)| *r = value);
        Ok(())
    }

    fn jacobian(&mut self, unknowns: &[f64], jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        let theta = self.theta(unknowns);
        let broken = |reason| BoundaryError::Residual { reason };
        let (_, derivatives) = self.problem.weighed(&theta, true).map_err(broken)?;
        let width = unknowns.len();
        for (i, row) in jacobian.chunks_exact_mut(width).enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let held = f64::from(u8::from(i >= derivatives.nrows() && i - derivatives.nrows() == j));
                *entry = if i < derivatives.nrows() { derivatives[(i, j)] * self.scale[j] } else { held };
            }
        }
        Ok(true)
    }
}

/// The Jacobian with columns of length one, and their lengths.
pub(crate) fn scaled(jacobian: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let mut scaled = jacobian.clone();
    for (mut column, &length) in scaled.column_iter_mut().zip(&lengths) {
        if length > 0.0 {
            column /= length;
        }
    }
    (scaled, lengths)
}
