//! One formulation fitted to films: estimates with intervals, and tests on residuals.

use motion::shooting::{Minimum, least_from};
use schemars::JsonSchema;
use serde::Serialize;

use crate::distribution::{RISE, normal_tails, rise_at_bound};
use crate::profile::{LAST, Profile};
use crate::residual_tests::{ResidualTest, residual_tests};
use crate::search::{Excluding, Found, NEAR_STEPS, search};
use crate::shown::{Near, Shown, moving, off_stationary, shown};
use crate::{Film, FitError, Problem, Residual, Unknown};

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
    pub(crate) fn hidden(unknown: &Unknown, value: f64) -> Self {
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
    /// The beginning of the films that excludes the formulation.
    #[serde(skip)]
    pub excluded_by: Option<Excluding>,
    /// The residuals.
    #[serde(skip)]
    pub residuals: Vec<Residual>,
}

impl Fit {
    /// The estimates' values.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        self.estimates.iter().map(|e| e.value).collect()
    }

    /// Their errors, 1 where films show nothing.
    pub(crate) fn scales(&self) -> Vec<f64> {
        self.estimates.iter().map(|e| if e.error.is_finite() { e.error } else { 1.0 }).collect()
    }

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

/// Fits `problem` as [`search()`] does. An unknown that changes nothing at the minimum is held where the
/// search began.
///
/// # Errors
/// [`FitError::NoMotion`], and [`FitError::ShowsNothing`] where all unknowns change nothing.
pub fn fit(problem: &Problem, spread: &dyn Fn(&str) -> bool, starts: usize, known: bool) -> Result<Fit, FitError> {
    sought(problem, spread, starts, known).map(|fit| with_intervals(problem, fit))
}

/// The same, with intervals by standard errors alone.
pub(crate) fn sought(
    problem: &Problem,
    spread: &dyn Fn(&str) -> bool,
    starts: usize,
    known: bool,
) -> Result<Fit, FitError> {
    let half = starts.div_ceil(2);
    let Found { best, minima, starts, excluded_by } = search(problem, spread, starts, known)?;
    let no_motion = |reason| FitError::NoMotion { starts, reason };
    let whole = off_stationary(problem, best);
    let Near { held, less, best, jacobian } = Near::new(problem, &whole)?;
    let Shown { errors, hidden } = shown(&less, &best.unknowns, &jacobian);
    let by_half = if best.first < half { best.value } else { least_from(half, &minima) };
    let residuals = less.clone().residuals(&best.unknowns).map_err(no_motion)?;
    let films: Vec<&Film> = problem.films().collect();
    let (count, unknowns) = (problem.count(), errors.len());
    let fitted = unknowns - hidden.len();
    let tests = residual_tests(&films, &residuals, fitted.saturating_sub(priors(problem)), problem.is_robust());
    let mut estimates: Vec<Estimate> = (0..unknowns).map(|i| estimate(&less, &best, &errors, i, None)).collect();
    let mut names = Vec::new();
    for i in held {
        let unknown = &problem.unknowns()[i];
        let value = match moving(problem, &whole, i) {
            Some(_) => whole.unknowns[i],
            None => {
                names.push(unknown.label());
                problem.start()[i]
            }
        };
        estimates.insert(i, Estimate::hidden(unknown, value));
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
        excluded_by,
        residuals,
    })
}

/// With intervals by the profile where standard errors are wrong; what does not fit has none to look for.
pub(crate) fn with_intervals(problem: &Problem, fit: Fit) -> Fit {
    let mut fit = fit;
    if fit.faults().next().is_some() {
        return fit;
    }
    let whole = Minimum { value: fit.chi_squared, ..Minimum::start(0, fit.numbers()) };
    let Ok(Near { held, less, best, jacobian }) = Near::new(problem, &whole) else { return fit };
    let mut near = less.coarse().limited(&best.unknowns, NEAR_STEPS);
    let Ok((values, _)) = near.weighed(&best.unknowns, false) else { return fit };
    let best = Minimum { value: values.norm_squared(), ..best };
    let errors = shown(&less, &best.unknowns, &jacobian).errors;
    let shown = (0..problem.unknowns().len()).filter(|i| !held.contains(i));
    for (i, place) in shown.enumerate() {
        let profile = Profile::new(&near, &jacobian, &best, &errors, i);
        fit.estimates[place] = estimate(&near, &best, &errors, i, Some(profile));
    }
    for i in held {
        if let Some(step) = moving(problem, &whole, i) {
            fit.estimates[i] = stationary(problem, &whole, i, step);
        }
    }
    fit
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
    let near = problem.limited(&best.unknowns, NEAR_STEPS);
    let mut profile = Profile::new(&near, &jacobian, best, &errors, i);
    let interval = [-1.0, 1.0].map(|side| profile.end(side, RISE, bound));
    let error = 0.5 * (interval[1] - interval[0]) / RISE.sqrt();
    Estimate { error, interval, profiled: true, ..Estimate::hidden(unknown, best.unknowns[i]) }
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
        let at = value + side * RISE.sqrt() * error;
        let Some(profile) = &mut profile else { return at.max(bound) };
        if side < 0.0 && at <= bound {
            let rise = profile.rise(bound);
            if value <= bound || rise <= rise_at_bound() || rise.is_infinite() {
                return bound;
            }
            profiled = true;
            return profile.end(side, RISE, bound);
        }
        let rise = profile.rise(at);
        if (rise - RISE).abs() <= LAST * RISE {
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
