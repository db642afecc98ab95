//! One formulation fitted to films: estimates with intervals, and tests on residuals.

use motion::shooting::{Minimum, least_from};
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::distribution::normal_tails;
use crate::profile::{NORMAL, Profile, SHOWN};
use crate::residual_tests::{ResidualTest, residual_tests};
use crate::search::{Found, Stage, least, scaled, search};
use crate::{Film, FitError, Problem, Residual, Unknown};

/// χ² by which a number of 95 % rises, and where it is at its bound: `½χ²₀ + ½χ²₁`.
pub(crate) const RISE: f64 = 3.841_458_820_694_124;
pub(crate) const RISE_AT_BOUND: f64 = 2.705_543_454_095_404;
/// A change of residuals, as the length of a vector, that is none.
const NOTHING: f64 = 1e-3;
/// χ² at the ends of an interval of standard errors may be off by this part for them to be taken.
const QUADRATIC: f64 = 0.05;
/// An unknown is held where χ² rises by no more than this.
const SAME_CHI_SQUARED: f64 = 0.01;
/// Times the steps of the best motion that one of a profile may take.
const PROFILE_STEPS: usize = 5;

/// An unknown as it is estimated.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Estimate {
    /// Its name, `x@2` for the second film's own.
    pub name: String,
    /// The estimate.
    pub value: f64,
    /// Standard error to first order; null where no film shows it.
    #[schemars(with = "Option<f64>")]
    pub error: f64,
    /// The interval that covers with 95 %; infinite, or to the bound, where χ² does not rise enough or
    /// motions cannot be followed.
    #[serde(flatten, serialize_with = "crate::json::ends")]
    #[schemars(with = "crate::json::Ends")]
    pub interval: [f64; 2],
    /// Whether the ends are by the profile, where standard errors would be wrong.
    pub profiled: bool,
    /// Where the least that it can be is within reach: the probability of an estimate as far from it.
    pub at_bound: Option<f64>,
}

impl Estimate {
    /// Of an unknown that no film shows.
    fn hidden(unknown: &Unknown, value: f64) -> Self {
        let interval = [unknown.bound.unwrap_or(f64::NEG_INFINITY), f64::INFINITY];
        let error = f64::INFINITY;
        Estimate { name: unknown.label(), value, error, interval, profiled: false, at_bound: None }
    }
}

/// A formulation fitted to films.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Fit {
    /// The estimates.
    pub estimates: Vec<Estimate>,
    /// The sum of squares at the minimum, priors included.
    pub chi_squared: f64,
    /// Numbers of the films and priors, without unknowns.
    pub freedom: usize,
    /// `χ² + k ln n`.
    pub bic: f64,
    /// Combinations of unknowns that no film shows.
    pub hidden: Vec<String>,
    /// What residuals say: first to be read.
    pub tests: Vec<ResidualTest>,
    /// χ² of every minimum that was seen, the least first.
    pub minima: Vec<f64>,
    /// Starts of the search.
    pub starts: usize,
    /// How many of these led to the least minimum.
    pub reached: usize,
    /// The least χ² that the first half of the starts leads to; infinite where they lead nowhere.
    #[schemars(with = "Option<f64>")]
    pub by_half: f64,
    /// The residuals.
    #[serde(skip)]
    pub residuals: Vec<Residual>,
}

impl Fit {
    /// The tests that object.
    pub fn objections(&self) -> impl Iterator<Item = &ResidualTest> {
        self.tests.iter().filter(|test| test.objects)
    }

    /// Those of the objections after which nothing is excluded. That χ² is too small is none: standard
    /// deviations that are too large make every exclusion weaker.
    pub fn faults(&self) -> impl Iterator<Item = &ResidualTest> {
        self.objections().filter(|test| !test.is_too_small())
    }
}

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
fn shown(problem: &Problem, theta: &[f64], jacobian: &DMatrix<f64>) -> Shown {
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

/// Fits `problem` as [`search()`] does. An unknown that changes nothing at the minimum is held where the
/// search began.
///
/// # Errors
/// [`FitError::NoMotion`], and [`FitError::ShowsNothing`] where all unknowns change nothing.
pub fn fit(problem: &Problem, spread: &dyn Fn(&str) -> bool, starts: usize, known: bool) -> Result<Fit, FitError> {
    let half = starts.div_ceil(2);
    let Found { best, minima, starts } = search(problem, spread, starts, known)?;
    let best = off_stationary(problem, best);
    let whole = best.clone();
    let (held, less, best) = without_hidden(problem, &best)?;
    let no_motion = |reason| FitError::NoMotion { starts, reason };
    let (_, jacobian) = less.clone().weighed(&best.unknowns, true).map_err(no_motion)?;
    let Shown { errors, hidden } = shown(&less, &best.unknowns, &jacobian);
    let by_half = if best.first < half { best.value } else { least_from(half, &minima) };
    let residuals = less.clone().residuals(&best.unknowns).map_err(no_motion)?;
    let films: Vec<&Film> = problem.films().collect();
    let (count, unknowns) = (problem.count(), errors.len());
    let fitted = unknowns - hidden.len();
    let tests = residual_tests(&films, &residuals, fitted.saturating_sub(priors(problem)), problem.is_robust());
    // what does not fit has no intervals to look for
    let profiles = !tests.iter().any(|test| test.objects && !test.is_too_small());
    let near = less.limited(&best.unknowns, PROFILE_STEPS);
    let profile = |i| Profile::new(&near, &jacobian, &best, &errors, i);
    let mut estimates: Vec<Estimate> =
        (0..unknowns).map(|i| estimate(&near, &best, &errors, i, profiles.then(|| profile(i)))).collect();
    let mut names = Vec::new();
    for i in held {
        let unknown = &problem.unknowns()[i];
        let estimate = match moving(problem, &whole, i).filter(|_| profiles) {
            Some(step) => stationary(problem, &whole, i, step),
            None => {
                names.push(unknown.label());
                Estimate::hidden(unknown, problem.start()[i])
            }
        };
        estimates.insert(i, estimate);
    }
    Ok(Fit {
        estimates,
        chi_squared: best.value,
        freedom: count - fitted,
        bic: best.value + fitted as f64 * (count as f64).ln(),
        hidden: names.into_iter().chain(hidden).collect(),
        tests,
        minima: minima.into_iter().map(|minimum| minimum.value).collect(),
        starts,
        reached: best.reached,
        by_half,
        residuals,
    })
}

/// Parts of the size of an unknown by which it is moved for a second look.
const LOOKS: [f64; 4] = [1e-2, 0.03, 0.1, 0.5];

/// The least of these changes of an unknown, whose derivative is nothing, that moves residuals all the same:
/// they are stationary there.
fn moving(problem: &Problem, best: &Minimum, i: usize) -> Option<f64> {
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
fn off_stationary(problem: &Problem, best: Minimum) -> Minimum {
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
            if let Some(found) = found.ok().filter(|found| found.value < least_known.value - SAME_CHI_SQUARED) {
                least_known = Minimum { reached: best.reached, first: best.first, ..found };
            }
        }
    }
    least_known
}

/// An unknown at which residuals are stationary: its interval is by the profile alone, and no error is of
/// first order.
fn stationary(problem: &Problem, best: &Minimum, i: usize, step: f64) -> Estimate {
    let unknown = &problem.unknowns()[i];
    let bound = unknown.bound.unwrap_or(f64::NEG_INFINITY);
    let Ok((_, jacobian)) = problem.clone().weighed(&best.unknowns, true) else {
        return Estimate::hidden(unknown, best.unknowns[i]);
    };
    let lengths = jacobian.column_iter().map(|column| column.norm());
    let mut errors: Vec<f64> = lengths.map(|l| if l > 0.0 { l.recip() } else { 1.0 }).collect();
    errors[i] = step;
    let near = problem.limited(&best.unknowns, PROFILE_STEPS);
    let mut profile = Profile::new(&near, &jacobian, best, &errors, i);
    let [low, high] = [-1.0, 1.0].map(|side| profile.end(side, RISE, bound));
    let error = 0.5 * (high - low) / NORMAL;
    Estimate {
        name: unknown.label(),
        value: best.unknowns[i],
        error,
        interval: [low, high],
        profiled: true,
        at_bound: None,
    }
}

/// How χ² rises above its least where the unknown of this name has these values and the others are fitted
/// again; infinite where no motion is found. None where `fit` is not one of `problem` or has no such unknown.
pub fn profile(problem: &Problem, fit: &Fit, name: &str, at: &[f64]) -> Option<Vec<f64>> {
    let i = problem.unknowns().iter().position(|unknown| unknown.label() == name)?;
    let own = fit.estimates.get(..problem.unknowns().len())?;
    let theta: Vec<f64> = own.iter().map(|e| e.value).collect();
    let errors: Vec<f64> = own.iter().map(|e| e.error).collect();
    let (_, jacobian) = problem.clone().weighed(&theta, true).ok()?;
    let best = Minimum { value: fit.chi_squared, ..Minimum::start(0, theta) };
    let mut profile = Profile::new(problem, &jacobian, &best, &errors, i);
    // outwards on either side
    let mut order: Vec<usize> = (0..at.len()).collect();
    order.sort_by(|a, b| (at[*a] - best.unknowns[i]).abs().total_cmp(&(at[*b] - best.unknowns[i]).abs()));
    let mut rises = vec![0.0; at.len()];
    order.into_iter().for_each(|place| rises[place] = profile.rise(at[place]));
    Some(rises)
}

/// The unknowns that change nothing at the minimum, ascending, the problem with these where the search began,
/// and its minimum.
fn without_hidden(problem: &Problem, best: &Minimum) -> Result<(Vec<usize>, Problem, Minimum), FitError> {
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
    if held.is_empty() {
        return Ok((held, shown, best.clone()));
    }
    scale.iter_mut().for_each(|length| *length = 1.0 / *length);
    let found = least(&shown, &theta, &scale, Stage::Whole).map_err(no_motion)?;
    if found.value > best.value + SAME_CHI_SQUARED {
        return Ok((Vec::new(), problem.clone(), best.clone()));
    }
    Ok((held, shown, Minimum { reached: best.reached, first: best.first, ..found }))
}

fn priors(problem: &Problem) -> usize {
    problem.unknowns().iter().filter(|u| u.prior.is_some()).count()
}

/// The interval of unknown `i`; by standard errors alone without a profile.
fn estimate(problem: &Problem, best: &Minimum, errors: &[f64], i: usize, profile: Option<Profile>) -> Estimate {
    let unknown = &problem.unknowns()[i];
    let (value, error) = (best.unknowns[i], errors[i]);
    let bound = unknown.bound.unwrap_or(f64::NEG_INFINITY);
    if error.is_infinite() {
        return Estimate::hidden(unknown, value);
    }
    let (mut profile, mut profiled) = (profile, false);
    let mut end = |side: f64| -> f64 {
        let at = value + side * NORMAL * error;
        let Some(profile) = &mut profile else { return at.max(bound) };
        if side < 0.0 && at <= bound {
            let rise = profile.rise(bound);
            if value <= bound || rise <= RISE_AT_BOUND || rise.is_infinite() {
                return bound;
            }
            profiled = true;
            return profile.end(side, RISE, bound);
        }
        let rise = profile.rise(at);
        if (rise - RISE).abs() <= QUADRATIC * RISE {
            return at;
        }
        profiled = true;
        profile.end(side, RISE, bound)
    };
    let interval = [end(-1.0), end(1.0)];
    let at_bound = unknown.bound.filter(|_| interval[0] <= bound || value - 4.0 * error < bound).and_then(|bound| {
        let rise = match &mut profile {
            Some(profile) if value > bound => profile.rise(bound),
            None if value > bound => ((value - bound) / error).powi(2),
            _ => 0.0,
        };
        if rise.is_infinite() {
            return None;
        }
        Some(if rise <= 0.0 { 1.0 } else { 0.5 * normal_tails(rise.sqrt()) })
    });
    Estimate { name: unknown.label(), value, error, interval, profiled, at_bound }
}
