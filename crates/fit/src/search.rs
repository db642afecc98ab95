//! The minimum of the squares: from several starts, over beginnings of the films that become longer.
//!
//! Single shooting over a whole film has many minima where motions depend strongly on their start. Over the
//! first samples there are few: each start of the search is fitted to these, then to half as many again, and
//! so on. While a beginning shows little, unknowns stay near where they were: each start counts as a
//! measurement whose deviation is the change that would move the film by its own extent.

use integrate::{BoundaryError, Residuals, ShootOptions};
use nalgebra::DMatrix;

use crate::{FitError, Problem};

/// Samples of the first beginning, and the factor from one to the next.
const FIRST: usize = 20;
const LONGER: f64 = 1.5;
/// Starts that are followed from one beginning to the next.
const FOLLOWED: usize = 4;
/// Least gain, as a part of χ², for which an iteration goes on, by [`Stage`].
const GAINS: [f64; 4] = [1e-2, 1e-4, 1e-10, 1e-6];
/// Iterations by [`Stage`].
const ITERATIONS: [usize; 4] = [10, 20, 50, 12];
/// Starts for the whole film are up to this many times halfway to the first one.
const NEARER: i32 = 8;
/// Starts that are fitted to the whole film at once beside the first one.
const SCREENED: usize = 2;
/// Times the steps of the first motion that one may take.
const STEPS: usize = 40;
/// Halvings of the way back to the start, where unknowns have gone where a longer motion cannot follow.
const HALVINGS: i32 = 10;
/// A beginning is fitted where χ² is within this many standard deviations; then a start is given up whose χ²
/// is this much above.
const FITS: f64 = 4.0;
const HOPELESS: f64 = 100.0;
/// Two minima are one where χ² differs by no more than this, beside this part of it.
const SAME: [f64; 2] = [0.1, 1e-3];

/// A local minimum.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// The unknowns.
    pub theta: Vec<f64>,
    /// The sum of squares there, priors included.
    pub chi_squared: f64,
}

/// What a search saw.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The least minimum.
    pub best: Minimum,
    /// χ² of every minimum that was seen over the whole film, the least first.
    pub minima: Vec<f64>,
    /// Starts that were tried.
    pub starts: usize,
}

/// The least minimum from several starts: the first is [`Problem::start`]; in the others unknowns for which
/// `spread` says so are moved, by parts of their scales that no period fits. Beginnings are left out where
/// the first start is `known` to come close.
///
/// # Errors
/// [`FitError::NoMotion`].
pub fn search(problem: &Problem, spread: &dyn Fn(&str) -> bool, starts: usize, known: bool) -> Result<Found, FitError> {
    let starts = starts.max(1);
    let problem = &problem.limited(problem.start(), STEPS);
    let short = problem.beginning(FIRST.max(2 * problem.unknowns().len()))?;
    let (scale, mut reason) = scales(&mut short.clone());
    let mut begun = screened(problem, spread, starts);
    if !known {
        let starts = (0..starts).map(|number| moved(problem, &scale, spread, number));
        begun.extend(followed(problem, short, &scale, starts.collect(), &mut reason)?);
    }
    let mut rough = Vec::new();
    for start in &begun {
        match least(problem, start, &scale, Stage::Rough) {
            Ok(minimum) => rough.push(minimum),
            Err(error) => reason = reason.or(Some(error)),
        }
    }
    distinct(&mut rough, &scale);
    let close = 1.5 * rough.first().map_or(f64::INFINITY, |m| m.chi_squared) + HOPELESS;
    let fine = |minimum: Minimum| match minimum.chi_squared < close {
        true => least(problem, &minimum.theta, &scale, Stage::Whole).unwrap_or(minimum),
        false => minimum,
    };
    let mut minima: Vec<Minimum> = rough.into_iter().map(fine).collect();
    distinct(&mut minima, &scale);
    minima.dedup_by(|b, a| b.chi_squared - a.chi_squared <= SAME[0] + SAME[1] * a.chi_squared);
    let no_motion = || FitError::NoMotion { starts, reason: reason.unwrap_or_else(|| "no minimum".into()) };
    let best = minima.first().cloned().ok_or_else(no_motion)?;
    Ok(Found { best, minima: minima.iter().map(|m| m.chi_squared).collect(), starts })
}

/// Minima over beginnings that become longer, from these starts: where the search over the whole film begins.
fn followed(
    problem: &Problem,
    short: Problem,
    scale: &[f64],
    starts: Vec<Vec<f64>>,
    reason: &mut Option<String>,
) -> Result<Vec<Vec<f64>>, FitError> {
    let (mut part, mut starts) = (short, starts);
    loop {
        let mut found = Vec::new();
        for start in &starts {
            let start = within(&part, problem.start(), start);
            match least(&part, &start, scale, Stage::Beginning) {
                Ok(minimum) => found.push(minimum),
                Err(error) => *reason = reason.take().or(Some(error)),
            }
        }
        distinct(&mut found, scale);
        found.truncate(FOLLOWED);
        // beside one that fits no other can be the least
        let count = part.count() as f64;
        if let Some(least) = found.first().map(|m| m.chi_squared).filter(|x| *x < count + FITS * (2.0 * count).sqrt()) {
            found.retain(|m| m.chi_squared < least + HOPELESS);
        }
        starts = found.into_iter().map(|m| m.theta).collect();
        if part.samples() >= problem.samples() {
            return Ok(starts);
        }
        let samples = (part.samples() as f64 * LONGER) as usize;
        part = problem.beginning(samples.min(problem.samples()))?;
    }
}

/// A start of the search: the minimum near its own with these unknowns held, ascending, or else its own.
pub(crate) fn begun(problem: &Problem, held: &[usize]) -> Vec<f64> {
    let mut start = problem.start().to_vec();
    let mut less = problem.clone();
    for &i in held.iter().rev() {
        less = less.without(i, start[i]);
    }
    if less.unknowns().is_empty() {
        return start;
    }
    let (scale, _) = scales(&mut less.clone());
    if let Ok(found) = least(&less, less.start(), &scale, Stage::Whole) {
        let seen = (0..start.len()).filter(|i| !held.contains(i)).collect::<Vec<_>>();
        seen.into_iter().zip(found.theta).for_each(|(i, x)| start[i] = x);
    }
    start
}

/// The change of each unknown that would move the residuals by their extent, as it seems at the start.
fn scales(problem: &mut Problem) -> (Vec<f64>, Option<String>) {
    let start = problem.start().to_vec();
    let plain = |i: usize| if start[i] == 0.0 { 1.0 } else { start[i].abs() };
    match problem.weighed(&start, true) {
        Ok((_, jacobian)) => {
            let extent = problem.extent();
            let scale = |i: usize| {
                let length = jacobian.column(i).norm();
                if length > 0.0 && length.is_finite() { extent / length } else { plain(i) }
            };
            ((0..start.len()).map(scale).collect(), None)
        }
        Err(reason) => ((0..start.len()).map(plain).collect(), Some(reason)),
    }
}

/// Start `number` of the search.
fn moved(problem: &Problem, scale: &[f64], spread: &dyn Fn(&str) -> bool, number: usize) -> Vec<f64> {
    let which: Vec<bool> = problem.unknowns().iter().map(|u| spread(&u.name)).collect();
    let mut parts = evenly(which.iter().filter(|w| **w).count(), number).into_iter();
    let mut along = |i: usize| {
        let start = problem.start()[i];
        if !which[i] || number == 0 {
            return start;
        }
        let x = start + scale[i] * (2.0 * parts.next().expect("one per unknown that is moved") - 1.0);
        problem.unknowns()[i].bound.map_or(x, |bound| bound + (x - bound).abs())
    };
    (0..scale.len()).map(&mut along).collect()
}

/// Point `number` of a sequence that fills a cube of k axes evenly: multiples of powers of the root of
/// `x^(k+1) = x + 1` (Roberts 2018). The first is its centre.
pub(crate) fn evenly(k: usize, number: usize) -> Vec<f64> {
    let root = (0..60).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (k as f64 + 1.0)));
    (1..=k as i32).map(|axis| (0.5 + number as f64 * root.powi(-axis)).fract()).collect()
}

/// The least first, each once.
fn distinct(minima: &mut Vec<Minimum>, scale: &[f64]) {
    minima.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    let near = |a: &Minimum, b: &Minimum| {
        let distances = a.theta.iter().zip(&b.theta).zip(scale).map(|((a, b), s)| ((a - b) / s).abs());
        distances.fold(0.0, f64::max) < 1e-3
    };
    let mut kept: Vec<Minimum> = Vec::new();
    for minimum in minima.drain(..) {
        if !kept.iter().any(|other| near(other, &minimum)) {
            kept.push(minimum);
        }
    }
    *minima = kept;
}

/// Starts for the whole film at once: the first one, and those of the others that come closest to it.
fn screened(problem: &Problem, spread: &dyn Fn(&str) -> bool, starts: usize) -> Vec<Vec<f64>> {
    let mut evaluated = problem.clone();
    let (scale, _) = scales(&mut evaluated);
    let mut others: Vec<(f64, Vec<f64>)> = Vec::new();
    for number in 1..starts {
        // far ones and near ones: nothing is linear as far as the extent of the film
        let nearer: Vec<f64> = scale.iter().map(|s| s * 0.5_f64.powi(number as i32 % NEARER)).collect();
        let start = moved(problem, &nearer, spread, number);
        if let Ok((values, _)) = evaluated.weighed(&start, false) {
            others.push((values.norm_squared(), start));
        }
    }
    others.sort_by(|a, b| a.0.total_cmp(&b.0));
    let others = others.into_iter().map(|(_, start)| start).take(SCREENED);
    [problem.start().to_vec()].into_iter().chain(others).collect()
}

/// Where motions reach the ends of their films: `theta`, or the first point halfway back to `origin`.
fn within(problem: &Problem, origin: &[f64], theta: &[f64]) -> Vec<f64> {
    let mut problem = problem.clone();
    let at = |halvings: i32| -> Vec<f64> {
        let part = 0.5_f64.powi(halvings);
        origin.iter().zip(theta).map(|(o, x)| o + part * (x - o)).collect()
    };
    (0..HALVINGS).map(at).find(|theta| problem.weighed(theta, false).is_ok()).unwrap_or_else(|| origin.to_vec())
}

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
}

/// The minimum near `start`, no unknown below its bound: one that would be is at it.
pub(crate) fn least(problem: &Problem, start: &[f64], scale: &[f64], stage: Stage) -> Result<Minimum, String> {
    let mut found = match start {
        [] => {
            let (values, _) = problem.clone().weighed(&[], false)?;
            return Ok(Minimum { theta: Vec::new(), chi_squared: values.norm_squared() });
        }
        _ => minimise(&mut problem.clone(), start, scale, stage)?,
    };
    let bounds = problem.unknowns().iter().map(|unknown| unknown.bound);
    let mut each = bounds.zip(&found.theta).enumerate();
    let below = each.find_map(|(i, (bound, x))| bound.filter(|bound| x < bound).map(|bound| (i, bound)));
    if let Some((i, bound)) = below {
        let mut scale = scale.to_vec();
        found.theta.remove(i);
        scale.remove(i);
        found = least(&problem.without(i, bound), &found.theta, &scale, stage)?;
        found.theta.insert(i, bound);
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
    Ok(Minimum { theta, chi_squared: values.norm_squared() })
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
