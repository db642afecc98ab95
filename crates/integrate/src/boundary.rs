//! Boundary values by single shooting, and fits of free constants.
//!
//! ```text
//! shoot: find c ∈ Rᵏ with r(c) = 0,   r(c) ∈ Rᵏ        fit: minimise |r(c)|²,   r(c) ∈ Rᵐ,  m ≥ k
//! ```
//!
//! The caller supplies `r`: it integrates from the start state that belongs to `c` and returns the residuals
//! at the end. Derivatives are also supplied by the caller ([`Residuals::jacobian`]), or else central
//! differences. The minimiser is the crate `levenberg-marquardt`, a port of MINPACK's.

mod search;
pub use search::AT_ONCE;

use levenberg_marquardt::LevenbergMarquardt;
use thiserror::Error;

use crate::dense::DenseOutput;
use crate::error::CallError;
use crate::status::{Solution, Status, StopCause};
use search::{Search, Target};

/// Above this condition number a Jacobian does not determine the unknowns.
const SINGULAR: f64 = 1e12;

/// How to solve for the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct ShootOptions {
    /// [`shoot`] ends when the Euclidean norm `|r(c)|` is at most this; > 0. [`fit`] takes a difference up to
    /// this for zero: an unknown that changes no more is left unchanged.
    pub tolerance: f64,
    /// Limit on the number of evaluated Jacobians; > 0.
    pub max_iterations: usize,
    /// Central differences are taken over `± difference_step · max(|c_j|, scale)`; in (0, 1). The error of a
    /// difference is about `difference_step² + (error of r)/difference_step` relative to the scale of `r`.
    pub difference_step: f64,
    /// The magnitude below which an unknown counts as small; > 0.
    pub scale: f64,
    /// The search ends when an iteration reduces `|r|²` by at most this fraction, as predicted; in (0, 1).
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
    /// How many of these the caller gave; the others are differences.
    pub exact: usize,
    /// Evaluations of r, those for differences included.
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
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum BoundaryError {
    /// There are no unknowns, or fewer residuals than unknowns.
    #[error("{residuals} residuals for {unknowns} unknowns; needed: unknowns ≥ 1, residuals ≥ unknowns")]
    Dimension { unknowns: usize, residuals: usize },
    /// An option, or a component of the guess, is out of its range.
    #[error("{name} is {found}, it must be {needed}")]
    Option { name: &'static str, found: f64, needed: &'static str },
    /// The residual cannot be evaluated at the guess; in the caller's words.
    #[error("the residual cannot be evaluated: {reason}")]
    Residual { reason: String },
    /// A residual is NaN or infinite at the guess.
    #[error("residual {index} is {found}")]
    NotFinite {
        /// Which one, counted from 0.
        index: usize,
        found: f64,
    },
    /// The integration inside the residual was a bad call.
    #[error(transparent)]
    Call(#[from] CallError),
    /// The integration inside the residual stopped before its end.
    #[error("the integration stopped at t = {t}: {cause}")]
    Stopped { t: f64, cause: StopCause },
    /// The residual stays above the tolerance.
    #[error("the residual is {residual:.1e} after {iterations} iterations, the tolerance is {limit:.0e}")]
    NotConverged {
        residual: f64,
        /// [`ShootOptions::tolerance`].
        limit: f64,
        iterations: usize,
    },
    /// The residual stays above the tolerance; the last Jacobian does not fix the unknowns.
    #[error("the residual is {residual}; the condition number of its Jacobian is {condition}, the limit is {limit}")]
    Singular { residual: f64, condition: f64, limit: f64 },
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

/// Residuals as a function of the unknowns; a closure has no derivatives of its own.
pub trait Residuals {
    /// Reads `c`, writes `r(c)`.
    ///
    /// # Errors
    /// Where it cannot be evaluated.
    fn residual(&mut self, unknowns: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError>;

    /// Reads `c`, writes `∂r_i/∂c_j`, row by row, and gives `true`; `false` where it is not known, so that
    /// differences are taken.
    ///
    /// # Errors
    /// Where it cannot be evaluated; differences are taken then.
    fn jacobian(&mut self, _unknowns: &[f64], _jacobian: &mut [f64]) -> Result<bool, BoundaryError> {
        Ok(false)
    }
}

impl<F: FnMut(&[f64], &mut [f64]) -> Result<(), BoundaryError>> Residuals for F {
    fn residual(&mut self, unknowns: &[f64], residual: &mut [f64]) -> Result<(), BoundaryError> {
        self(unknowns, residual)
    }
}

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
pub fn shoot(residual: &mut dyn Residuals, guess: &[f64], options: &ShootOptions) -> Result<Shot, BoundaryError> {
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
    residual: &mut dyn Residuals,
    residuals: usize,
    guess: &[f64],
    options: &ShootOptions,
) -> Result<Shot, BoundaryError> {
    minimise(residual, residuals, guess, options, [0.0, options.tolerance])
}

/// The best point of a minimisation that ends early where `|r| ≤ enough`; differences up to `noise` are none.
fn minimise(
    residual: &mut dyn Residuals,
    residuals: usize,
    guess: &[f64],
    options: &ShootOptions,
    [enough, noise]: [f64; 2],
) -> Result<Shot, BoundaryError> {
    check(residuals, guess, options)?;
    let target = Target::new(Search::new((residual, residuals), guess, options, [enough, noise])?);
    let minimiser = LevenbergMarquardt::new().with_patience(10 * options.max_iterations).with_ftol(options.least_gain);
    let (target, _report) = minimiser.minimize(target);
    Ok(target.found())
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
