//! The shortest film that separates two formulations.

use crate::search::{Stage, least};
use crate::{EXCLUDED, Fit, Problem};

/// Lengths that are tried, over that of the film.
const LENGTHS: [f64; 6] = [1.5, 2.0, 3.0, 4.0, 6.0, 8.0];

/// How many times as long a film has to be, where `truth` is the formulation and its best fit are the
/// numbers, until χ² of `rival` is [`EXCLUDED`] at least, without noise; of a few lengths.
pub(crate) fn length_that_tells(truth: (&Problem, &Fit), rival: (&Problem, &Fit)) -> Option<f64> {
    // a slip at its bound is no unknown of the problem: it is the last estimate
    let own = |(problem, fit): (&Problem, &Fit)| fit.estimates[..problem.unknowns().len()].to_vec();
    let numbers = |of: (&Problem, &Fit)| own(of).iter().map(|e| e.value).collect::<Vec<_>>();
    let (at, mut start) = (numbers(truth), numbers(rival));
    let scale: Vec<f64> = own(rival).iter().map(|e| if e.error.is_finite() { e.error } else { 1.0 }).collect();
    for longer in LENGTHS {
        let films = truth.0.foreseen(&at, longer).ok()?;
        let found = least(&rival.0.of_films(films).ok()?, &start, &scale, Stage::Profile).ok()?;
        if found.value >= EXCLUDED {
            return Some(longer);
        }
        start = found.unknowns;
    }
    None
}
