//! The bound of the slip, `f = −λ/N`, which its motions do not reach.
//!
//! Motions with slip have the time constant `m/N`: the smaller 1/N, the more steps they take. At `1/N = 0`
//! constraints hold exactly, and the equations are different. So the fit at the bound has a problem of its
//! own, and the profile of 1/N begins there.

use motion::shooting::Minimum;

use crate::distribution::{RISE, normal_tails, rise_at_bound};
use crate::profile::Profile;
use crate::search::{HALVINGS, NEAR_STEPS};
use crate::{Estimate, Fit, FitError, Problem, Unknown};

/// `problem` with a bound for its unknown `i`, 1/N: the least of its halves with which motions can be
/// followed.
pub(crate) fn followed(problem: &Problem, i: usize) -> Problem {
    let start = problem.start()[i];
    let mut tried = problem.limited(problem.start(), NEAR_STEPS);
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
    let least = problem.unknowns()[i].bound.unwrap_or(0.0);
    let at_bound = kept.as_ref().ok().map(|(_, kept)| kept.chi_squared);
    let creeping = creeping.map(|mut fit| {
        let (slip, rise) = (&mut fit.estimates[i], at_bound.map(|kept| kept - fit.chi_squared));
        // between 0 and the least that is followed, the end is at 0
        if slip.interval[0] <= least || rise.is_some_and(|rise| rise <= rise_at_bound()) {
            (slip.interval[0], slip.profiled) = (0.0, true);
        }
        slip.at_bound = rise.map_or(slip.at_bound, |rise| Some(0.5 * normal_tails(rise.max(0.0).sqrt())));
        fit
    });
    match (kept, creeping) {
        (Err(_), creeping) => creeping.map(|fit| (problem, fit)),
        (Ok((_, kept)), Ok(fit)) if kept.chi_squared > fit.chi_squared && fit.estimates[i].value > least => {
            Ok((problem, fit))
        }
        (Ok((own, mut kept)), _) => {
            kept.estimates.push(at_its_bound(&problem, i, &kept));
            Ok((own, kept))
        }
    }
}

/// The unknown `i` of `problem` where the least χ² is that of constraints that are kept: its interval ends
/// where χ² has risen by 3.84 above that; at the least 1/N that is followed where it has there.
fn at_its_bound(problem: &Problem, i: usize, kept: &Fit) -> Estimate {
    let of = |unknown: &Unknown| kept.estimates.iter().find(|e| e.name == unknown.label());
    let all = || problem.unknowns().iter().zip(problem.start());
    let mut theta: Vec<f64> = all().map(|(unknown, own)| of(unknown).map_or(*own, |e| e.value)).collect();
    let error = |e: &Estimate| Some(e.error).filter(|error| error.is_finite() && *error > 0.0);
    let mut errors: Vec<f64> = all().map(|(unknown, _)| of(unknown).and_then(error).unwrap_or(1.0)).collect();
    let least = problem.unknowns()[i].bound.unwrap_or(0.0);
    theta[i] = least;
    let derivatives = problem.clone().weighed(&theta, true);
    theta[i] = 0.0;
    let best = Minimum { value: kept.chi_squared, ..Minimum::start(0, theta) };
    let high = derivatives.map_or(f64::INFINITY, |(_, jacobian)| {
        errors[i] = jacobian.column(i).norm().recip().max(least / RISE.sqrt());
        let mut profile = Profile::new(problem, &jacobian, &best, &errors, i);
        match profile.rise(least) {
            rise if rise.is_infinite() => rise,
            rise if rise >= RISE => least,
            _ => profile.end(1.0, RISE, 0.0),
        }
    });
    let (error, interval) = (high / RISE.sqrt(), [0.0, high]);
    Estimate { error, interval, profiled: true, at_bound: Some(1.0), ..Estimate::hidden(&problem.unknowns()[i], 0.0) }
}
