//! Fits of the first-order law with slip, `f = −λ/N`, whose bound 1/N = 0 its motions do not reach.
//!
//! Motions with slip have the time constant `m/N`: the smaller 1/N, the more steps they take. At `1/N = 0`
//! constraints hold exactly, and the equations are different. So there are two fits: one with exact
//! constraints, the limit of motions with slip, and one with 1/N above the least value that can be
//! integrated.

use crate::distribution::normal_tails;
use crate::fit::{RISE, RISE_AT_BOUND};
use crate::profile::NORMAL;
use crate::search::{Stage, least};
use crate::{Estimate, Fit, FitError, Problem};

/// Maximum number of halvings of the initial 1/N down to the least one, and factor by which motions may take
/// more steps than there.
const HALVINGS: i32 = 8;
const STEPS: usize = 16;
/// Relative accuracy of an end of the interval.
const CLOSE: f64 = 0.02;
/// Maximum number of doublings in the search for it.
const OUTWARDS: usize = 20;

/// `problem` with a bound for its unknown `i`, 1/N: the least with which motions can be followed.
pub(crate) fn followed(problem: &Problem, i: usize) -> Problem {
    let start = problem.start()[i];
    let mut tried = problem.limited(problem.start(), STEPS);
    let mut reaches = |slip: f64| {
        let mut theta = problem.start().to_vec();
        theta[i] = slip;
        tried.weighed(&theta, false).is_ok()
    };
    let slips = (0..=HALVINGS).map(|k| start * 0.5_f64.powi(k));
    problem.bounded(i, slips.take_while(|slip| reaches(*slip)).last().unwrap_or(start))
}

/// The better of two fits: with constraints that are kept, and with the unknown `i`, 1/N, of `creeping`.
pub(crate) fn joined(
    kept: Result<(Problem, Fit), FitError>,
    (problem, i): (Problem, usize),
    creeping: Result<Fit, FitError>,
) -> Result<(Problem, Fit), FitError> {
    let (own, kept) = match kept {
        Ok(kept) => kept,
        Err(_) => {
            let mut fit = creeping?;
            let slip = &mut fit.estimates[i].interval[0];
            *slip = if *slip <= problem.unknowns()[i].bound.unwrap_or(0.0) { 0.0 } else { *slip };
            return Ok((problem, fit));
        }
    };
    let least = problem.unknowns()[i].bound.unwrap_or(0.0);
    if let Ok(mut fit) = creeping {
        let rise = kept.chi_squared - fit.chi_squared;
        let slip = &mut fit.estimates[i];
        if rise > 0.0 && slip.value > least {
            // between 0 and the least that is followed, the end is at 0
            if rise <= RISE_AT_BOUND || slip.interval[0] <= least {
                (slip.interval[0], slip.profiled) = (0.0, true);
            }
            slip.at_bound = Some(0.5 * normal_tails(rise.sqrt()));
            return Ok((problem, fit));
        }
    }
    let high = end(&problem, i, &kept);
    let slip = Estimate {
        name: problem.unknowns()[i].label(),
        value: 0.0,
        error: high / NORMAL,
        interval: [0.0, high],
        profiled: true,
        at_bound: Some(1.0),
    };
    let estimates = kept.estimates.iter().cloned().chain([slip]).collect();
    Ok((own, Fit { estimates, ..kept }))
}

/// Where χ² has risen by 3.84 above that of constraints that are kept; the least 1/N that is followed where
/// it is less, infinite where it is not found.
fn end(problem: &Problem, i: usize, kept: &Fit) -> f64 {
    let mut others: Vec<f64> = problem.start().to_vec();
    for (place, unknown) in problem.unknowns().iter().enumerate() {
        if let Some(known) = kept.estimates.iter().find(|e| e.name == unknown.label()) {
            others[place] = known.value;
        }
    }
    others.remove(i);
    let known = |j: usize| kept.estimates.get(j).map(|e| e.error).filter(|error| error.is_finite() && *error > 0.0);
    let scale: Vec<f64> = (0..others.len()).map(|j| known(j).unwrap_or(1.0)).collect();
    let mut rises = |slip: f64| {
        let found = least(&problem.without(i, slip), &others, &scale, Stage::Profile).ok()?;
        others = found.unknowns;
        Some(found.value - kept.chi_squared > RISE)
    };
    let (mut low, mut high) = (0.0, problem.unknowns()[i].bound.unwrap_or(0.0));
    for _ in 0..OUTWARDS {
        match rises(high) {
            Some(true) => break,
            Some(false) => (low, high) = (high, 2.0 * high),
            None => return f64::INFINITY,
        }
    }
    if low == 0.0 {
        return high;
    }
    while high - low > CLOSE * high {
        let middle = 0.5 * (low + high);
        match rises(middle) {
            Some(false) => low = middle,
            _ => high = middle,
        }
    }
    high
}
