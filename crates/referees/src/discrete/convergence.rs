//! How a discrete motion tends to a given one as its step is halved.

use std::fmt::Display;

use discrete::{Discrete, DiscreteError};

/// Errors over halvings of the step, plain and extrapolated.
///
/// All are the largest of `|q_k − q(t_k)| / max(1, |q_i| on the motion)` over coarsest nodes and coordinates.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// Steps of each level, each twice the one before.
    pub steps: Vec<usize>,
    /// `errors[i][j]`: level i, extrapolated j ≤ i times; order 2j + 2.
    pub errors: Vec<Vec<f64>>,
    /// How far the last two columns of the last level are apart: the referee's own estimate of the error of
    /// the best extrapolation but one. Knows nothing of the reference. At least the round-off of the march.
    pub estimate: f64,
    /// Largest difference between the best extrapolation and the reference.
    pub difference: f64,
}

impl Convergence {
    /// Orders of column `j`: `log₂ (errors[i−1][j] / errors[i][j])` at levels `i`, both over `plateau`.
    pub fn orders(&self, column: usize, plateau: f64) -> Vec<f64> {
        let pairs = self.errors.windows(2).filter(|pair| pair[0].len() > column);
        let errors = pairs.map(|pair| (pair[0][column], pair[1][column]));
        errors.filter(|&(one, two)| one > plateau && two > plateau).map(|(one, two)| (one / two).log2()).collect()
    }

    /// The error of the finest grid without extrapolation.
    pub fn finest(&self) -> f64 {
        self.errors[self.errors.len() - 1][0]
    }
}

/// The largest round-off of a march, a step; the error estimate is not under it.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// The errors of `discrete` against `reference` (`t ↦ q`) with `steps, 2·steps, 4·steps, …` steps, `levels`
/// of them, and of Richardson's extrapolation
///
/// ```text
/// T_{i,0} = q(h/2ⁱ) ,      T_{i,j} = T_{i,j−1} + (T_{i,j−1} − T_{i−1,j−1}) / (4ʲ − 1)
/// ```
///
/// which has order 2j + 2 where the error is a power series in `h²`.
///
/// # Errors
/// As [`Discrete::positions`]; [`DiscreteError::TooFew`] under 2 levels; [`DiscreteError::Reference`].
pub fn convergence<E: Display>(
    discrete: &mut Discrete,
    steps: usize,
    levels: usize,
    mut reference: impl FnMut(f64) -> Result<Vec<f64>, E>,
) -> Result<Convergence, DiscreteError> {
    if levels < 2 {
        return Err(DiscreteError::TooFew { what: "the number of levels", found: levels, limit: 2 });
    }
    let mut expected = Vec::with_capacity(steps + 1);
    for k in 0..=steps {
        let t = discrete.time(k, steps.max(1));
        let q = reference(t).map_err(|e| DiscreteError::Reference { t, cause: e.to_string() })?;
        expected.push(q);
    }
    let size: Vec<f64> =
        (0..expected[0].len()).map(|i| expected.iter().fold(1.0_f64, |a, q| a.max(q[i].abs()))).collect();
    let distance = |one: &[Vec<f64>], two: &[Vec<f64>]| {
        let nodes = one.iter().zip(two).flat_map(|(a, b)| a.iter().zip(b).zip(&size));
        nodes.map(|((a, b), size)| ((a - b) / size).abs()).fold(0.0, f64::max)
    };
    let mut rows: Vec<Vec<Vec<Vec<f64>>>> = Vec::with_capacity(levels);
    for level in 0..levels {
        let every = 1 << level;
        let positions: Vec<Vec<f64>> = discrete.positions(steps * every)?.into_iter().step_by(every).collect();
        let mut row = vec![positions];
        for j in 1..=level {
            let factor = 1.0 / (4.0_f64.powi(j as i32) - 1.0);
            let extrapolated = row[j - 1].iter().zip(&rows[level - 1][j - 1]).map(|(fine, coarse)| {
                fine.iter().zip(coarse).map(|(fine, coarse)| fine + (fine - coarse) * factor).collect()
            });
            row.push(extrapolated.collect());
        }
        rows.push(row);
    }
    let errors: Vec<Vec<f64>> =
        rows.iter().map(|row| row.iter().map(|positions| distance(positions, &expected)).collect()).collect();
    let last = &rows[levels - 1];
    let finest = steps << (levels - 1);
    Ok(Convergence {
        steps: (0..levels).map(|level| steps << level).collect(),
        estimate: distance(&last[levels - 1], &last[levels - 2]).max(ROUND_OFF * finest as f64),
        difference: errors[levels - 1][levels - 1],
        errors,
    })
}
