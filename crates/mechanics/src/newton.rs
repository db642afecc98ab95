//! Newton's method for `r(x) = 0` with any number of equations and unknowns: the one Newton of the crate.
//!
//! Each step is the shortest `s` that minimizes `‖W (r + J s)‖`: Gauss–Newton by singular values, or by `Q R`
//! where a large `J` is far from singular. Steps are halved until `‖W r‖` falls. `W` scales the rows of
//! `J` to 1, so that the units of the equations do not matter. Convergence is quadratic at a regular root; a
//! linear system is solved by one step, and every root gets one step more for the sake of its last digits.

use nalgebra::{DMatrix, DVector};
use symbolic::limits::ITERATIONS;

use crate::SingularValues;

/// `r`, `J = ∂r/∂x` and the size of the terms of `r`, at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// `r(x)`, length m.
    pub residual: DVector<f64>,
    /// `∂r/∂x`, m×n.
    pub jacobian: DMatrix<f64>,
    /// Sum of the magnitudes of the terms of each equation, length m: what its residual is compared with.
    pub magnitude: DVector<f64>,
}

impl Evaluation {
    /// Largest `|rᵢ| / (|rᵢ| + magnitudeᵢ + 10⁻⁴ ‖Jᵢ‖ ‖x‖)`: between 0 and 1.
    ///
    /// The last term is there because an unknown that vanishes comes out as round-off of the others.
    pub fn relative_residual(&self, x: &DVector<f64>) -> f64 {
        let ratio = |i: usize| match self.residual[i].abs() {
            0.0 => 0.0,
            r => r / (r + self.term_size(i, x)),
        };
        (0..self.residual.len()).map(ratio).fold(0.0, f64::max)
    }

    fn term_size(&self, i: usize, x: &DVector<f64>) -> f64 {
        const SLACK: f64 = 1e-4;
        self.magnitude[i].abs() + SLACK * x.norm() * self.jacobian.row(i).norm()
    }

    /// What the terms of the equations add up to in each unknown: `Σⱼ |J⁺|ᵢⱼ (magnitudeⱼ + 10⁻⁴ ‖Jⱼ‖ ‖x‖)`.
    ///
    /// # Errors
    /// [`NewtonError::NotFinite`].
    pub(crate) fn sizes(&self, x: &DVector<f64>) -> Result<Vec<f64>, NewtonError> {
        let Decomposition { weights, factors, rank } = Decomposition::new(self, NewtonOptions::default().rank_limit)?;
        let inverse = |i: usize, j: usize| {
            (0..rank).map(|k| factors.right[(k, i)] * factors.left[(j, k)] / factors.values[k]).sum::<f64>()
        };
        let term = |i: usize, j: usize| inverse(i, j).abs() * weights[j] * self.term_size(j, x);
        Ok((0..x.len()).map(|i| (0..self.residual.len()).map(|j| term(i, j)).sum()).collect())
    }

    fn is_finite(&self) -> bool {
        let parts = [self.residual.as_slice(), self.jacobian.as_slice(), self.magnitude.as_slice()];
        parts.iter().all(|part| part.iter().all(|x| x.is_finite()))
    }

    /// Factors that bring the largest entry of each row of `J` to 1.
    fn row_weights(&self) -> DVector<f64> {
        let weight = |row: usize| {
            let size = self.jacobian.row(row).amax();
            if size > 0.0 { 1.0 / size } else { 1.0 }
        };
        DVector::from_fn(self.residual.len(), |row, _| weight(row))
    }
}

/// When to stop, and what counts as zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonOptions {
    /// Relative residual at which the iteration ends.
    pub tolerance: f64,
    /// Largest relative residual that is accepted where round-off, not the method, ends the iteration.
    pub limit: f64,
    /// Steps allowed.
    pub iterations: usize,
    /// Singular values of the row-scaled `J` under this fraction of the largest count as zero.
    pub rank_limit: f64,
}

impl Default for NewtonOptions {
    fn default() -> Self {
        NewtonOptions { tolerance: 1e-14, limit: 1e-10, iterations: 100, rank_limit: 1e-12 }
    }
}

/// A point where the iteration ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Root {
    /// `x`, length n.
    pub x: DVector<f64>,
    /// [`Evaluation::relative_residual`] at `x`.
    pub residual: f64,
    /// Steps taken, the last one for the digits included.
    pub iterations: usize,
    /// Rank of `J` at `x`.
    pub rank: usize,
    /// Orthonormal basis of the kernel of `J` at `x`, n×(n − rank): the directions left open.
    pub null_space: DMatrix<f64>,
}

/// Why no root was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum NewtonError {
    /// The iteration ended where the residual is least nearby, but not zero.
    #[error("residual {:.3e} (limit {limit:.0e}) after {} steps", .best.residual, .best.iterations)]
    NotConverged {
        /// Where the iteration ended: stationary for `‖W r‖` unless the steps ran out.
        best: Box<Root>,
        limit: f64,
    },
    /// Residual or Jacobian is not finite.
    #[error("residual or Jacobian is not finite at step {iteration}")]
    NotFinite { iteration: usize },
}

/// Solves `r(x) = 0` from `x0`.
///
/// With fewer independent equations than unknowns the root is near `x0`, for linear ones the nearest.
///
/// # Errors
/// [`NewtonError`]. [`NewtonError::NotConverged`] carries the least-squares point.
///
/// ```
/// use mechanics::newton::{Evaluation, NewtonOptions, solve};
/// use nalgebra::{DMatrix, DVector};
/// let vector = |x: f64| DVector::from_element(1, x);
/// let square_root_of_two = |x: &DVector<f64>| Evaluation {
///     residual: vector(x[0] * x[0] - 2.0),
///     jacobian: DMatrix::from_element(1, 1, 2.0 * x[0]),
///     magnitude: vector(x[0] * x[0] + 2.0),
/// };
/// let root = solve(square_root_of_two, vector(1.0), &NewtonOptions::default())?;
/// assert!((root.x[0] - 2.0_f64.sqrt()).abs() < 1e-15);
/// assert!(root.iterations <= 7);
/// # Ok::<(), mechanics::newton::NewtonError>(())
/// ```
pub fn solve(
    mut evaluate: impl FnMut(&DVector<f64>) -> Evaluation,
    x0: DVector<f64>,
    options: &NewtonOptions,
) -> Result<Root, NewtonError> {
    let mut x = x0;
    let mut here = evaluate(&x);
    if !here.is_finite() {
        return Err(NewtonError::NotFinite { iteration: 0 });
    }
    let mut decomposition = Decomposition::new(&here, options.rank_limit)?;
    let mut iterations = 0;
    while iterations < options.iterations {
        let residual = here.relative_residual(&x);
        let step = decomposition.step(&here);
        let polish = residual <= options.tolerance;
        let next = if polish {
            let next = moved(&mut evaluate, &x, &step, 1.0);
            (next.1.is_finite() && next.1.relative_residual(&next.0) <= residual).then_some(next)
        } else {
            damped(&mut evaluate, &x, &here, &step)
        };
        let Some(next) = next else { break };
        // that of linear equations serves for all steps
        if next.1.jacobian != here.jacobian {
            decomposition = Decomposition::new(&next.1, options.rank_limit)?;
        }
        (x, here) = next;
        iterations += 1;
        if polish {
            break;
        }
    }
    let root = Root {
        residual: here.relative_residual(&x),
        iterations,
        rank: decomposition.rank,
        null_space: decomposition.null_space(),
        x,
    };
    if root.residual <= options.limit {
        Ok(root)
    } else {
        Err(NewtonError::NotConverged { best: Box::new(root), limit: options.limit })
    }
}

fn moved(
    evaluate: &mut impl FnMut(&DVector<f64>) -> Evaluation,
    x: &DVector<f64>,
    step: &DVector<f64>,
    fraction: f64,
) -> (DVector<f64>, Evaluation) {
    let x = x + step * fraction;
    let evaluation = evaluate(&x);
    (x, evaluation)
}

/// The longest of 1, ½, ¼ … of the step that reduces `‖W r‖` enough.
fn damped(
    evaluate: &mut impl FnMut(&DVector<f64>) -> Evaluation,
    x: &DVector<f64>,
    here: &Evaluation,
    step: &DVector<f64>,
) -> Option<(DVector<f64>, Evaluation)> {
    const SUFFICIENT: f64 = 1e-4;
    let weights = here.row_weights();
    let merit = |e: &Evaluation| e.residual.component_mul(&weights).norm();
    let before = merit(here);
    for halving in 0..ITERATIONS as i32 {
        let fraction = 0.5_f64.powi(halving);
        let next = moved(evaluate, x, step, fraction);
        if next.0 == *x {
            return None;
        }
        if next.1.is_finite() && merit(&next.1) < (1.0 - SUFFICIENT * fraction) * before {
            return Some(next);
        }
    }
    None
}

/// Singular values of the row-scaled `J`, padded with zero rows to all n right singular vectors; or what
/// [`triangular`] finds instead.
struct Decomposition {
    weights: DVector<f64>,
    factors: SingularValues,
    /// How many are not zero.
    rank: usize,
}

impl Decomposition {
    fn new(e: &Evaluation, rank_limit: f64) -> Result<Self, NewtonError> {
        let (m, n) = e.jacobian.shape();
        let weights = e.row_weights();
        let padded = DMatrix::from_fn(m.max(n), n, |i, j| if i < m { weights[i] * e.jacobian[(i, j)] } else { 0.0 });
        let factors = match triangular(&padded, rank_limit) {
            Some(factors) => factors,
            None => decompose(&padded)?,
        };
        Ok(Decomposition { weights, rank: factors.rank(rank_limit), factors })
    }

    /// The shortest least-squares solution of `W J s = −W r`.
    fn step(&self, e: &Evaluation) -> DVector<f64> {
        let mut step = DVector::zeros(e.jacobian.ncols());
        let weighted = e.residual.component_mul(&self.weights);
        for k in 0..self.rank {
            let along: f64 = weighted.iter().zip(self.factors.left.column(k).iter()).map(|(r, u)| r * u).sum();
            step -= self.factors.right.row(k).transpose() * (along / self.factors.values[k]);
        }
        step
    }

    fn null_space(&self) -> DMatrix<f64> {
        self.factors.right.rows_range(self.rank..).transpose()
    }
}

/// `Q`, ones and `R⁻ᵀ` of a large matrix that is far from losing rank: `A⁺ = R⁻¹ Qᵀ`, many times faster than
/// singular values.
fn triangular(matrix: &DMatrix<f64>, rank_limit: f64) -> Option<SingularValues> {
    const LARGE: usize = 32;
    let n = matrix.ncols();
    if n < LARGE || SingularValues::least_at_least(&matrix.transpose()) <= rank_limit * matrix.norm() {
        return None;
    }
    let factors = matrix.clone().qr();
    let inverse = factors.r().solve_upper_triangular(&DMatrix::identity(n, n))?;
    Some(SingularValues { left: factors.q(), values: DVector::from_element(n, 1.0), right: inverse.transpose() })
}

/// Singular values of a finite matrix.
pub(crate) fn decompose(matrix: &DMatrix<f64>) -> Result<SingularValues, NewtonError> {
    match matrix.iter().all(|x| x.is_finite()) {
        true => Ok(SingularValues::of(matrix)),
        false => Err(NewtonError::NotFinite { iteration: 0 }),
    }
}
