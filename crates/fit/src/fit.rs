//! One formulation fitted to films: estimates with intervals, and what residuals say.

use nalgebra::DVector;

use crate::distribution::normal_tails;
use crate::residual_tests::{ResidualTest, residual_tests};
use crate::search::{Found, Minimum, Stage, least, scaled, search};
use crate::{Film, FitError, Problem, Residual, Unknown};

/// χ² by which a number of 95 % rises, and where it is at its bound: `½χ²₀ + ½χ²₁`.
const RISE: f64 = 3.841_458_820_694_124;
const RISE_AT_BOUND: f64 = 2.705_543_454_095_404;
/// Standard deviations of 95 %.
const NORMAL: f64 = 1.959_963_984_540_054;
/// Smallest singular value over the largest, of a Jacobian with columns of length one, below which unknowns
/// are not shown: what is left of derivatives that carry errors of 1e-9.
const SHOWN: f64 = 1e-7;
/// A change of residuals, as the length of a vector, that is none.
const NOTHING: f64 = 1e-3;
/// χ² at the ends of an interval of standard errors may be off by this part for them to be taken.
const QUADRATIC: f64 = 0.05;
/// An unknown is held where χ² rises by no more than this.
const SAME_CHI_SQUARED: f64 = 0.01;
/// Times the steps of the best motion that one of a profile may take.
const PROFILE_STEPS: usize = 5;
/// Steps outwards and steps in all to the end of a profile, and the part of the rise that they come to.
const OUTWARDS: usize = 5;
const STEPS: usize = 15;
const CLOSE: f64 = 0.02;

/// An unknown as it is estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Its name, `x@2` for the second film's own.
    pub name: String,
    /// The estimate.
    pub value: f64,
    /// Standard error to first order.
    pub error: f64,
    /// The interval that covers with 95 %; infinite, or to the bound, where χ² does not rise enough or
    /// motions cannot be followed.
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
#[derive(Clone, Debug, PartialEq)]
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
    /// The residuals.
    pub residuals: Vec<Residual>,
}

impl Fit {
    /// The tests that object.
    pub fn objections(&self) -> impl Iterator<Item = &ResidualTest> {
        self.tests.iter().filter(|test| test.objects)
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
    let (matrix, lengths) = scaled(&jacobian);
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
    Ok(Shown { errors, hidden: hidden.iter().map(|along| combination(problem, along, &lengths)).collect() })
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
    let Found { best, minima, starts } = search(problem, spread, starts, known)?;
    let (held, shown, best) = without_hidden(problem, &best)?;
    let Shown { errors, hidden } = standard_errors(&shown, &best.theta)?;
    let no_motion = |reason| FitError::NoMotion { starts, reason };
    let residuals = shown.clone().residuals(&best.theta).map_err(no_motion)?;
    let films: Vec<&Film> = problem.films().collect();
    let (count, unknowns) = (problem.count(), errors.len());
    let fitted = unknowns - hidden.len();
    let tests = residual_tests(&films, &residuals, fitted.saturating_sub(priors(problem)), problem.is_robust());
    // what does not fit has no intervals to look for
    let profiles = !tests.iter().any(|test| test.objects);
    let near = shown.limited(&best.theta, PROFILE_STEPS);
    let mut estimates: Vec<Estimate> = (0..unknowns).map(|i| estimate(&near, &best, &errors, i, profiles)).collect();
    let mut names = Vec::new();
    for i in held {
        let unknown = &problem.unknowns()[i];
        names.push(unknown.label());
        estimates.insert(i, Estimate::hidden(unknown, problem.start()[i]));
    }
    Ok(Fit {
        estimates,
        chi_squared: best.chi_squared,
        freedom: count - fitted,
        bic: best.chi_squared + fitted as f64 * (count as f64).ln(),
        hidden: names.into_iter().chain(hidden).collect(),
        tests,
        minima,
        starts,
        residuals,
    })
}

/// The unknowns that change nothing at the minimum, ascending, the problem with these where the search began,
/// and its minimum.
fn without_hidden(problem: &Problem, best: &Minimum) -> Result<(Vec<usize>, Problem, Minimum), FitError> {
    let no_motion = |reason| FitError::NoMotion { starts: 1, reason };
    let (_, jacobian) = problem.clone().weighed(&best.theta, true).map_err(no_motion)?;
    let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let held = alone(problem, &best.theta, &lengths);
    if held.len() == lengths.len() {
        return Err(FitError::ShowsNothing);
    }
    let (mut shown, mut theta, mut scale) = (problem.clone(), best.theta.clone(), lengths);
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
    if found.chi_squared > best.chi_squared + SAME_CHI_SQUARED {
        return Ok((Vec::new(), problem.clone(), best.clone()));
    }
    Ok((held, shown, found))
}

fn priors(problem: &Problem) -> usize {
    problem.unknowns().iter().filter(|u| u.prior.is_some()).count()
}

/// The interval of unknown `i`; by standard errors alone unless profiles are asked for.
fn estimate(problem: &Problem, best: &Minimum, errors: &[f64], i: usize, profiles: bool) -> Estimate {
    let unknown = &problem.unknowns()[i];
    let (value, error) = (best.theta[i], errors[i]);
    let bound = unknown.bound.unwrap_or(f64::NEG_INFINITY);
    if error.is_infinite() {
        return Estimate::hidden(unknown, value);
    }
    let mut profile = Profile::new(problem, best, errors, i);
    let mut profiled = false;
    let mut end = |side: f64| -> f64 {
        let at = value + side * NORMAL * error;
        if !profiles {
            return at.max(bound);
        }
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
        let rise = if value <= bound { 0.0 } else { profile.rise(bound) };
        if rise.is_infinite() {
            return None;
        }
        Some(if rise <= 0.0 { 1.0 } else { 0.5 * normal_tails(rise.sqrt()) })
    });
    Estimate { name: unknown.label(), value, error, interval, profiled, at_bound }
}

/// How χ² rises where one unknown is held and the others are fitted.
struct Profile<'a> {
    problem: &'a Problem,
    best: &'a Minimum,
    errors: &'a [f64],
    i: usize,
    /// Points that were looked at: the unknown, the others there, the rise.
    known: Vec<(f64, Vec<f64>, f64)>,
}

impl<'a> Profile<'a> {
    fn new(problem: &'a Problem, best: &'a Minimum, errors: &'a [f64], i: usize) -> Self {
        let mut others = best.theta.clone();
        others.remove(i);
        Profile { problem, best, errors, i, known: vec![(best.theta[i], others, 0.0)] }
    }

    /// The rise at `x`; infinite where there is no motion.
    fn rise(&mut self, x: f64) -> f64 {
        if let Some((_, _, rise)) = self.known.iter().find(|(known, _, _)| *known == x) {
            return *rise;
        }
        let nearest = self.known.iter().min_by(|a, b| (a.0 - x).abs().total_cmp(&(b.0 - x).abs()));
        let start = nearest.map(|(_, others, _)| others.clone()).unwrap_or_default();
        let mut scale = self.errors.to_vec();
        scale.remove(self.i);
        scale.iter_mut().filter(|x| x.is_infinite()).for_each(|x| *x = 1.0);
        let found = least(&self.problem.without(self.i, x), &start, &scale, Stage::Profile);
        match found {
            Ok(Minimum { theta, chi_squared }) => {
                let rise = chi_squared - self.best.chi_squared;
                self.known.push((x, theta, rise));
                rise
            }
            Err(_) => f64::INFINITY,
        }
    }

    /// Where χ² has risen by `rise` on this side, not beyond `bound`; open where that cannot be found: by
    /// secants of the root of the rise, which is a straight line where χ² is quadratic.
    fn end(&mut self, side: f64, rise: f64, bound: f64) -> f64 {
        let value = self.best.theta[self.i];
        let (mut inside, mut outside) = ((value, 0.0), None);
        let mut x = value + side * NORMAL * self.errors[self.i];
        for step in 0..STEPS {
            x = x.max(bound);
            let found = self.rise(x).max(0.0);
            // beyond where motions can be followed it is open
            if found.is_infinite() {
                return if side < 0.0 { bound } else { f64::INFINITY };
            }
            if (found - rise).abs() <= CLOSE * rise {
                return x;
            }
            if found < rise {
                if x <= bound {
                    return bound;
                }
                if outside.is_none() && step >= OUTWARDS {
                    return if side < 0.0 { bound } else { f64::INFINITY };
                }
                inside = (x, found.sqrt());
            } else {
                outside = Some((x, found.sqrt()));
            }
            let goal = rise.sqrt();
            x = match outside {
                None => value + (inside.0 - value) * (goal / inside.1).clamp(1.2, 3.0),
                Some((x, root)) => {
                    let part = (goal - inside.1) / (root - inside.1);
                    inside.0 + (x - inside.0) * part.clamp(0.1, 0.9)
                }
            };
        }
        x
    }
}
