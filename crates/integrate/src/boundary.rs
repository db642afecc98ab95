//! Boundary values by single shooting, and fits of free constants.
//!
//! ```text
//! shoot: find c ∈ Rᵏ with r(c) = 0,   r(c) ∈ Rᵏ        fit: minimise |r(c)|²,   r(c) ∈ Rᵐ,  m ≥ k
//! ```
//!
//! `r` is the caller's: it integrates from the start state that belongs to `c` and returns what is to vanish
//! at the end. The minimiser is the crate `levenberg-marquardt`, a port of MINPACK's.

use std::cell::RefCell;

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra_0_34::storage::Owned;
use nalgebra_0_34::{DMatrix, DVector, Dyn};
use thiserror::Error;

use crate::dense::DenseOutput;
use crate::error::CallError;
use crate::status::{Solution, Status, StopCause};

/// Stands for the residuals where they cannot be evaluated: the minimiser then tries a shorter step.
const OUT_OF_REACH: f64 = 1e100;
/// A guess this much better than the tolerance is not improved; for others differences are taken.
const AT_ONCE: f64 = 1e-3;
/// Above this condition number a Jacobian from differences does not determine the unknowns.
const SINGULAR: f64 = 1e12;

/// How to solve for the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct ShootOptions {
    /// [`shoot`] is done where the Euclidean norm `|r(c)|` is not above this; > 0. To [`fit`], a difference
    /// not above this is none: an unknown that changes no more stays where it is.
    pub tolerance: f64,
    /// Limit on the number of evaluated Jacobians; > 0.
    pub max_iterations: usize,
    /// Central differences are taken over `± difference_step · max(|c_j|, scale)`; in (0, 1). The error of a
    /// difference is about `difference_step² + (error of r)/difference_step` relative to the scale of `r`.
    pub difference_step: f64,
    /// The magnitude below which an unknown counts as small; > 0.
    pub scale: f64,
    /// Done where an iteration lessens `|r|²` by no more than this part, and none more was to be expected; in
    /// (0, 1).
    pub least_gain: f64,
}

impl ShootOptions {
    /// At most 50 iterations, differences over 1e-4 (for integration errors near 1e-12), unknowns of size 1,
    /// and no end before gains are as small as round-off.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self { tolerance, max_iterations: 50, difference_step: 1e-4, scale: 1.0, least_gain: 1e-14 }
    }
}

/// The unknowns found.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// c
    pub unknowns: Vec<f64>,
    /// `|r(c)|`, Euclidean.
    pub residual: f64,
    /// Jacobians evaluated on the way.
    pub iterations: usize,
    /// Evaluations of r, those for the Jacobians included.
    pub evaluations: usize,
    /// Whether the limit on iterations ended the search.
    pub exhausted: bool,
    /// Condition number (Euclidean norm) of the last `∂r/∂c` on the way; infinite where the unknowns are not
    /// determined, or none was evaluated.
    pub condition: f64,
}

/// No unknowns were found, or the question makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BoundaryError {
    /// There are no unknowns, or fewer residuals than unknowns.
    #[error("{residuals} residuals for {unknowns} unknowns; needed: unknowns ≥ 1, residuals ≥ unknowns")]
    Dimension {
        /// Length of the guess.
        unknowns: usize,
        /// Number of residuals.
        residuals: usize,
    },
    /// An option, or a component of the guess, is out of its range.
    #[error("{name} is {found}, it must be {needed}")]
    Option {
        /// Which one.
        name: &'static str,
        /// Its value.
        found: f64,
        /// Its range.
        needed: &'static str,
    },
    /// The residual cannot be evaluated at the guess; in the caller's words.
    #[error("the residual cannot be evaluated: {reason}")]
    Residual {
        /// The caller's own words.
        reason: String,
    },
    /// A residual is NaN or infinite at the guess.
    #[error("residual {index} is {found}")]
    NotFinite {
        /// Which one, counted from 0.
        index: usize,
        /// Its value.
        found: f64,
    },
    /// The integration inside the residual was a bad call.
    #[error(transparent)]
    Call(#[from] CallError),
    /// The integration inside the residual stopped before its end.
    #[error("the integration stopped at t = {t}: {cause}")]
    Stopped {
        /// Where it stopped.
        t: f64,
        /// Why.
        cause: StopCause,
    },
    /// The residual stays above the tolerance.
    #[error("the residual is {residual:.1e} after {iterations} iterations, the tolerance is {limit:.0e}")]
    NotConverged {
        /// The smallest `|r|` found.
        residual: f64,
        /// [`ShootOptions::tolerance`].
        limit: f64,
        /// Jacobians evaluated.
        iterations: usize,
    },
    /// The residual stays above the tolerance; the last Jacobian does not fix the unknowns.
    #[error("the residual is {residual}; the condition number of its Jacobian is {condition}, the limit is {limit}")]
    Singular {
        /// The smallest `|r|` found.
        residual: f64,
        /// Condition number of that Jacobian.
        condition: f64,
        /// 1e12.
        limit: f64,
    },
}

impl Solution {
    /// The dense output of a completed run, for use in a residual.
    ///
    /// # Errors
    /// [`BoundaryError::Stopped`] where the run ended before its end.
    pub fn completed(&self) -> Result<&DenseOutput, BoundaryError> {
        match &self.status {
            Status::Completed => Ok(&self.dense),
            Status::Stopped { t, cause } => Err(BoundaryError::Stopped { t: *t, cause: cause.clone() }),
        }
    }
}

/// What is to vanish as a function of the unknowns: reads `c`, writes `r(c)`.
pub type Residual<'a> = dyn FnMut(&[f64], &mut [f64]) -> Result<(), BoundaryError> + 'a;

/// Single shooting: finds `c` near `guess` with `|r(c)| ≤ tolerance`, as many residuals as unknowns.
///
/// One step more is taken by the last Jacobian, for the sake of the last digits. Where `residual` returns an
/// error the step is shortened. The solution is the one that the guess leads to. Single shooting is for
/// moderate growth: under `e^K` in `c`, residuals stay above about `e^K` times the integration error.
///
/// # Errors
/// See [`BoundaryError`].
///
/// # Examples
/// `y'' = −y`, `y(0) = 0`, `y(1) = 1`: the slope at 0 is `1/sin 1`.
/// ```
/// use integrate::{ShootOptions, shoot};
/// let mut end = |c: &[f64], r: &mut [f64]| {
///     r[0] = c[0] * 1f64.sin() - 1.0;
///     Ok(())
/// };
/// let shot = shoot(&mut end, &[0.3], &ShootOptions::with_tolerance(1e-12)).unwrap();
/// assert!((shot.unknowns[0] - 1.0 / 1f64.sin()).abs() < 1e-11);
/// ```
pub fn shoot(residual: &mut Residual, guess: &[f64], options: &ShootOptions) -> Result<Shot, BoundaryError> {
    let shot = minimise(residual, guess.len(), guess, options, [options.tolerance, 0.0])?;
    // The negation catches a condition or residual that is NaN.
    if shot.residual <= options.tolerance {
        Ok(shot)
    } else if shot.condition <= SINGULAR {
        let Shot { residual, iterations, .. } = shot;
        Err(BoundaryError::NotConverged { residual, limit: options.tolerance, iterations })
    } else {
        Err(BoundaryError::Singular { residual: shot.residual, condition: shot.condition, limit: SINGULAR })
    }
}

/// Best-fitting constants: minimises `|r(c)|` over `c` near `guess`, `residuals ≥ k` of them.
///
/// Returns the best point found, with the residual norm there, which is not small where the model does not
/// fit; a `condition` above 1e12 says that the fit does not determine the constants. The minimum is a local
/// one; [`Shot::exhausted`] says that the limit on iterations was reached on the way to it.
///
/// # Errors
/// The variants for bad calls and for residuals that cannot be evaluated at the guess.
///
/// # Examples
/// The best constant for the values 1, 2, 6 is their mean.
/// ```
/// use integrate::{ShootOptions, fit};
/// let mut r = |c: &[f64], r: &mut [f64]| {
///     r.copy_from_slice(&[c[0] - 1.0, c[0] - 2.0, c[0] - 6.0]);
///     Ok(())
/// };
/// let shot = fit(&mut r, 3, &[0.0], &ShootOptions::with_tolerance(1e-12)).unwrap();
/// assert!((shot.unknowns[0] - 3.0).abs() < 1e-9);
/// assert!((shot.residual - 14f64.sqrt()).abs() < 1e-9);
/// ```
pub fn fit(
    residual: &mut Residual,
    residuals: usize,
    guess: &[f64],
    options: &ShootOptions,
) -> Result<Shot, BoundaryError> {
    minimise(residual, residuals, guess, options, [0.0, options.tolerance])
}

/// The best point of a minimisation that ends early where `|r| ≤ enough`; differences up to `noise` are none.
fn minimise(
    residual: &mut Residual,
    residuals: usize,
    guess: &[f64],
    options: &ShootOptions,
    [enough, noise]: [f64; 2],
) -> Result<Shot, BoundaryError> {
    check(residuals, guess, options)?;
    let mut search = Search {
        residual,
        residuals,
        options,
        enough,
        noise,
        at: guess.to_vec(),
        best: guess.to_vec(),
        smallest: f64::INFINITY,
        iterations: 0,
        evaluations: 0,
        first: None,
        last: None,
        condition: f64::INFINITY,
    };
    search.first = Some(search.values(guess)?);
    let minimiser = LevenbergMarquardt::new().with_patience(10 * options.max_iterations).with_ftol(options.least_gain);
    let (problem, _report) = minimiser.minimize(Target(RefCell::new(search)));
    let mut search = problem.0.into_inner();
    search.finish();
    let Search { best, smallest, iterations, evaluations, condition, .. } = search;
    let exhausted = iterations >= options.max_iterations;
    Ok(Shot { unknowns: best, residual: smallest, iterations, evaluations, exhausted, condition })
}

fn check(residuals: usize, guess: &[f64], options: &ShootOptions) -> Result<(), BoundaryError> {
    if guess.is_empty() || residuals < guess.len() {
        return Err(BoundaryError::Dimension { unknowns: guess.len(), residuals });
    }
    let positive = "finite and above 0";
    let in_range = |x: f64| x > 0.0 && x.is_finite();
    for (name, found) in
        [("tolerance", options.tolerance), ("max_iterations", options.max_iterations as f64), ("scale", options.scale)]
    {
        if !in_range(found) {
            return Err(BoundaryError::Option { name, found, needed: positive });
        }
    }
    for (name, found) in [("difference_step", options.difference_step), ("least_gain", options.least_gain)] {
        if !(found > 0.0 && found < 1.0) {
            return Err(BoundaryError::Option { name, found, needed: "above 0 and below 1" });
        }
    }
    match guess.iter().find(|c| !c.is_finite()) {
        Some(&found) => Err(BoundaryError::Option { name: "guess", found, needed: "finite" }),
        None => Ok(()),
    }
}

fn condition(jacobian: &DMatrix<f64>) -> f64 {
    let values = jacobian.singular_values();
    // Sorted, largest first; there is at least one.
    let (largest, smallest) = (values[0], values[values.len() - 1]);
    if smallest > 0.0 { largest / smallest } else { f64::INFINITY }
}

struct Search<'a, 'r> {
    residual: &'a mut Residual<'r>,
    residuals: usize,
    options: &'a ShootOptions,
    enough: f64,
    noise: f64,
    at: Vec<f64>,
    best: Vec<f64>,
    smallest: f64,
    iterations: usize,
    evaluations: usize,
    /// r at the guess, until the minimiser asks for it.
    first: Option<Vec<f64>>,
    /// The last Jacobian, and its condition.
    last: Option<DMatrix<f64>>,
    condition: f64,
}

impl Search<'_, '_> {
    /// r(c), finite or an error; remembers the best c.
    fn values(&mut self, unknowns: &[f64]) -> Result<Vec<f64>, BoundaryError> {
        let mut values = vec![0.0; self.residuals];
        self.evaluations += 1;
        (self.residual)(unknowns, &mut values)?;
        if let Some(index) = values.iter().position(|r| !r.is_finite()) {
            return Err(BoundaryError::NotFinite { index, found: values[index] });
        }
        let norm = values.iter().map(|r| r * r).sum::<f64>().sqrt();
        if norm < self.smallest {
            self.smallest = norm;
            self.best.copy_from_slice(unknowns);
        }
        Ok(values)
    }

    /// ∂r/∂c by central differences; one-sided where one side cannot be evaluated.
    fn differences(&mut self, unknowns: &[f64]) -> Result<DMatrix<f64>, BoundaryError> {
        let mut jacobian = DMatrix::zeros(self.residuals, unknowns.len());
        let mut shifted = unknowns.to_vec();
        for (j, mut column) in jacobian.column_iter_mut().enumerate() {
            let step = self.options.difference_step * unknowns[j].abs().max(self.options.scale);
            shifted[j] = unknowns[j] + step;
            let above = self.values(&shifted);
            shifted[j] = unknowns[j] - step;
            let below = self.values(&shifted);
            shifted[j] = unknowns[j];
            let (above, below, width) = match (above, below) {
                (Ok(above), Ok(below)) => (above, below, 2.0 * step),
                (Ok(above), Err(_)) => (above, self.values(unknowns)?, step),
                (Err(_), Ok(below)) => (self.values(unknowns)?, below, step),
                (Err(error), Err(_)) => return Err(error),
            };
            for (i, entry) in column.iter_mut().enumerate() {
                *entry = above[i] - below[i];
            }
            column *= if column.norm() > self.noise { width.recip() } else { 0.0 };
        }
        self.condition = condition(&jacobian);
        self.last = Some(jacobian.clone());
        Ok(jacobian)
    }

    /// One step more, kept where it is one nearer; none where what was found is not good enough.
    fn finish(&mut self) {
        if self.smallest == 0.0 || self.smallest > self.enough {
            return;
        }
        let (best, last) = (self.best.clone(), self.last.take().filter(|_| self.condition <= SINGULAR));
        let (Some(jacobian), Ok(values)) = (last, self.values(&best)) else { return };
        if let Some(step) = jacobian.lu().solve(&DVector::from_vec(values)) {
            // what cannot be evaluated is not nearer
            let _ = self.values(&best.iter().zip(step.iter()).map(|(c, s)| c - s).collect::<Vec<_>>());
        }
    }
}

/// What the minimiser sees.
struct Target<'a, 'r>(RefCell<Search<'a, 'r>>);

impl LeastSquaresProblem<f64, Dyn, Dyn> for Target<'_, '_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, unknowns: &DVector<f64>) {
        self.0.get_mut().at.copy_from_slice(unknowns.as_slice());
    }

    fn params(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.0.borrow().at)
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let search = &mut *self.0.borrow_mut();
        let at = search.at.clone();
        // it asks for the guess first
        let values = match search.first.take() {
            Some(values) => Ok(values),
            None => search.values(&at),
        };
        let values = values.unwrap_or_else(|_| vec![OUT_OF_REACH; search.residuals]);
        Some(DVector::from_vec(values))
    }

    /// `None` ends the minimisation: good enough, out of iterations, or no differences.
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let search = &mut *self.0.borrow_mut();
        let enough = if search.iterations == 0 { AT_ONCE * search.enough } else { search.enough };
        if search.smallest <= enough || search.iterations >= search.options.max_iterations {
            return None;
        }
        search.iterations += 1;
        let at = search.at.clone();
        search.differences(&at).ok()
    }
}
