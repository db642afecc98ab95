//! The minimum of the squares: from several starts, over beginnings of the films that become longer.
//!
//! Single shooting over a whole film has many minima where motions depend strongly on their start. Over the
//! first samples there are few: each start of the search is fitted to these, then to half as many again, and
//! so on. While a beginning shows little, unknowns stay near where they were: each start counts as a
//! measurement whose deviation is the change that would move the film by its own extent.

use motion::shooting::{Minimum, spread};
use symbolic::limits::NOTHING;

use crate::distribution::{EXCLUDED, sigmas};
use crate::least::{Stage, least};
use crate::minimum::{distinct, spread_out};
use crate::problem::Beside;
use crate::residual_tests::residual_tests;
use crate::{FitError, Problem, Residual};

/// Samples of the first beginning, and the factor from one to the next.
const FIRST: usize = 20;
const LONGER: f64 = 1.5;
/// Starts that are followed from one beginning to the next, by its number: short ones tell little of them.
const FOLLOWED: [usize; 4] = [12, 10, 8, 4];
/// Starts beside one that is known and fits.
const FEW: usize = 4;
/// Times the steps of the first motion that one may take.
const STEPS: usize = 40;
/// The same beside a minimum, over the whole film.
pub(crate) const NEAR_STEPS: usize = 16;
/// How often the way back to a start is halved: where unknowns have gone where a longer motion cannot follow,
/// where starts are for a whole film, where a bound is looked for.
pub(crate) const HALVINGS: i32 = 8;
/// A beginning is fitted where χ² is within this many standard deviations; then a start is given up whose χ²
/// is this much above, and digits
/// of χ² are not looked for where it is so many times the number of residuals.
const FITS: f64 = 4.0;
pub(crate) const HOPELESS: f64 = 100.0;
/// Minima up to this many times the least are looked at to the last digit; where residuals are large.
const CLOSE: [f64; 2] = [1.5, 1.05];
/// Two minima count as one where χ² differs by at most the first number plus the second, as a fraction of χ².
const SAME: [f64; 2] = [0.1, 1e-3];

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The least minimum.
    pub best: Minimum,
    /// Every minimum that was seen over the whole film, the least first.
    pub minima: Vec<Minimum>,
    /// Number of starts that were followed: fewer than asked for if some coincide.
    pub starts: usize,
    /// The part of the films that excludes the formulation.
    pub excluded_by: Option<Excluding>,
}

/// A part of the films in words, and the significance at which it excludes a formulation.
pub type Excluding = (String, f64);

/// The least minimum from several starts: the first is [`Problem::start`]; in the others unknowns for which
/// `moves` says so are moved, by parts of their scales that no period fits; further ones are known before:
/// each goes by way of beginnings and, unless it is far off, at once. Beginnings are left out where the first
/// start is `known` to come close. Starts for the whole film at once are left out where beginnings of several
/// lead to residuals of noise. Once a beginning excludes the formulation, or a film alone, one start is
/// followed.
///
/// # Errors
/// [`FitError::NoMotion`].
pub fn search(problem: &Problem, moves: &dyn Fn(&str) -> bool, starts: usize, known: bool) -> Result<Found, FitError> {
    // where nothing is moved all starts are one
    let starts = if problem.unknowns().iter().any(|u| moves(&u.name)) { starts.max(1) } else { 1 };
    let mut whole = problem.limited(problem.start(), STEPS);
    let (beside, whole) = (whole.beside.take(), &whole);
    let problem = &whole.coarse();
    let short = problem.beginning(FIRST.max(2 * problem.unknowns().len()))?;
    let (scale, mut reason) = scales(&mut short.clone());
    // what is beside another that fits, and is excluded by that, is not the least of what fits
    let least_beside = beside.as_deref().and_then(|(best, own)| best.clone().weighed(&own[0], false).ok());
    let excluded_from = least_beside.map_or(f64::INFINITY, |(values, _)| values.norm_squared() + EXCLUDED);
    let is_enough = |minima: &[Minimum]| minima.first().is_some_and(|m| m.value < excluded_from && fits(problem, m));
    // what leads from one motion to one minimum is one start, and counts by way of beginnings
    let before =
        |(i, known): (usize, &Vec<f64>)| Minimum { reached: usize::from(i == 0), ..Minimum::start(0, known.clone()) };
    let known_before: Vec<Minimum> = problem.known.iter().enumerate().map(before).collect();
    let mut evaluated = problem.clone();
    let mut near = |start: &&Minimum| {
        let found = evaluated.weighed(&start.unknowns, false);
        known || found.is_ok_and(|(values, _)| !is_poor(problem, values.norm_squared()))
    };
    let at_once = known_before.iter().filter(&mut near);
    let at_once = at_once.map(|start| Minimum { reached: usize::from(known), ..start.clone() }).collect();
    let mut minima = refined(problem, at_once, &scale, Stage::Rough, &mut reason);
    let films = if known || problem.films().count() == 1 { 0 } else { problem.films().count().min(ALONE) };
    let alone = |number| excluded_alone(problem, beside.as_deref()?, (moves, starts), number);
    let mut excluded_by = (0..films).find_map(alone);
    let mut tried = known_before.len();
    // beside what is known to fit others are few
    let starts = if is_enough(&minima) { starts.min(FEW) } else { starts };
    if !known {
        let begun = (0..starts).map(|number| moved(problem, &scale, moves, number));
        let begun: Vec<Minimum> = begun.chain(known_before).collect();
        tried += begun.len();
        let led;
        (led, excluded_by) = followed(problem, short, &scale, begun, (beside.as_deref(), excluded_by), &mut reason)?;
        minima.extend(refined(problem, led, &scale, Stage::Rough, &mut reason));
        distinct(&mut minima, &scale);
    }
    if starts == 1 || excluded_by.is_none() && !is_enough(&minima) {
        let mut begun = screened(problem, moves, starts);
        if starts > 1 && !known {
            begun.extend(absent(problem));
        }
        tried += begun.len();
        minima.extend(refined(problem, begun, &scale, Stage::Rough, &mut reason));
    }
    distinct(&mut minima, &scale);
    let least = minima.first().map_or(f64::INFINITY, |m| m.value);
    let close = if is_poor(problem, least) { CLOSE[1] * least } else { CLOSE[0] * least + HOPELESS };
    let hopeless = minima.split_off(minima.partition_point(|m| m.value < close));
    let mut minima = refined(whole, minima, &scale, Stage::Whole, &mut reason);
    minima.extend(hopeless);
    distinct(&mut minima, &scale);
    as_high(&mut minima);
    let no_motion = || FitError::NoMotion { starts: tried, reason: reason.unwrap_or_else(|| "no minimum".into()) };
    let mut best = minima.first().cloned().ok_or_else(no_motion)?;
    best.reached = best.reached.max(1);
    Ok(Found { best, minima, starts: tried, excluded_by })
}

/// Whether χ² is no further above another than noise can tell.
pub(crate) fn is_as_high(value: f64, least: f64) -> bool {
    value - least <= SAME[0] + SAME[1] * least
}

/// Minima as high as another count as one.
fn as_high(minima: &mut Vec<Minimum>) {
    minima.dedup_by(|b, a| {
        let same = is_as_high(b.value, a.value);
        if same {
            (a.reached, a.first) = (a.reached + b.reached, a.first.min(b.first));
        }
        same
    });
}

/// The minima near others, the least first; those not found are left out, except for the last stage.
fn refined(
    problem: &Problem,
    rough: Vec<Minimum>,
    scale: &[f64],
    stage: Stage,
    reason: &mut Option<String>,
) -> Vec<Minimum> {
    let mut found: Vec<Minimum> = Vec::new();
    for begun in rough {
        // beside one that fits
        let enough = found.iter().any(|m| is_noise(problem, m.value) && m.value + HOPELESS < begun.value);
        if stage == Stage::Rough && begun.value.is_finite() && enough {
            found.push(begun);
            continue;
        }
        let near = match stage {
            Stage::Beginning => None,
            _ => Some(problem.limited(&begun.unknowns, NEAR_STEPS)),
        };
        let poor = stage == Stage::Whole && is_poor(problem, begun.value);
        let stage = if poor { Stage::Poor } else { stage };
        let mut best = least(near.as_ref().unwrap_or(problem), &begun.unknowns, scale, stage);
        if let Some(m) = best.as_ref().ok().filter(|m| poor && !is_poor(problem, m.value)) {
            best = least(near.as_ref().unwrap_or(problem), &m.unknowns, scale, Stage::Whole);
        }
        match best {
            Ok(minimum) => found.push(Minimum { reached: begun.reached, first: begun.first, ..minimum }),
            Err(_) if stage != Stage::Beginning && begun.value.is_finite() => found.push(begun),
            Err(error) => *reason = reason.take().or(Some(error)),
        }
    }
    distinct(&mut found, scale);
    found
}

/// Whether χ² is that of noise, and no test on residuals objects.
fn fits(problem: &Problem, found: &Minimum) -> bool {
    let unknowns = problem.unknowns().len();
    let films: Vec<_> = problem.films().collect();
    let content = |residuals: Vec<Residual>| {
        let tests = residual_tests(&films, &residuals, unknowns, problem.is_robust());
        !tests.iter().any(|test| test.objects)
    };
    is_noise(problem, found.value) && problem.clone().residuals(&found.unknowns).is_ok_and(content)
}

/// Whether residuals are many deviations.
fn is_poor(problem: &Problem, chi_squared: f64) -> bool {
    chi_squared > HOPELESS * problem.count() as f64
}

/// Whether this χ² is not further above the number of residuals than noise can be.
fn is_noise(problem: &Problem, chi_squared: f64) -> bool {
    let count = problem.count() as f64;
    chi_squared < count + FITS * (2.0 * count).sqrt()
}

/// Minima over beginnings that become longer, from these starts: where the search over the whole film begins;
/// and by which of them the formulation is excluded, if it is not yet.
fn followed(
    problem: &Problem,
    short: Problem,
    scale: &[f64],
    starts: Vec<Minimum>,
    (beside, excluded_by): (Option<&Beside>, Option<Excluding>),
    reason: &mut Option<String>,
) -> Result<(Vec<Minimum>, Option<Excluding>), FitError> {
    let (mut part, mut starts, mut excluded_by) = (short, starts, excluded_by);
    let origin = Some(problem.start()).filter(|_| reason.is_none());
    for number in 0.. {
        if excluded_by.is_some() {
            starts.truncate(1);
        }
        for start in &mut starts {
            start.unknowns = within(&part, origin, &start.unknowns);
        }
        let mut found = refined(&part, starts, scale, Stage::Beginning, reason);
        // beside one that fits no other can be the least
        if let Some(least) = found.first().map(|m| m.value).filter(|x| is_noise(&part, *x)) {
            found.retain(|m| m.value < least + HOPELESS);
        }
        starts = spread_out(&|x| is_noise(&part, x), found, scale, FOLLOWED[number.min(FOLLOWED.len() - 1)]);
        if part.samples() >= problem.samples() {
            break;
        }
        if let Some(beside) = beside.filter(|_| excluded_by.is_none()) {
            let words = || format!("the first {} samples", part.samples());
            let limit = excluded_by_one(problem);
            excluded_by = excluded(&part, &mut starts, scale, beside, limit).map(|sigmas| (words(), sigmas));
        }
        let samples = (part.samples() as f64 * LONGER) as usize;
        part = problem.beginning(samples.min(problem.samples()))?;
    }
    Ok((starts, excluded_by))
}

/// Starts that have to lead to the least χ² of a formulation before it is excluded, and that are fitted to
/// the whole film at once beside the first one.
pub(crate) const SEVERAL: usize = 2;
/// Films that are looked at alone.
const ALONE: usize = 3;

/// What χ² of one of `n` parts has to be above the least for the level of [`EXCLUDED`] among all: `2 ln n`
/// more, as tails fall with `exp(−χ²/2)`. Parts are the beginnings of all films, and of each of [`ALONE`].
fn excluded_by_one(problem: &Problem) -> f64 {
    let beginnings = 1.0 + (problem.samples() as f64 / FIRST as f64).max(1.0).ln() / LONGER.ln();
    EXCLUDED + 2.0 * (beginnings * (1 + ALONE) as f64).ln()
}

/// Film `number`, if that excludes the formulation alone: unknowns of its own are few, and several starts
/// lead to one minimum.
fn excluded_alone(
    problem: &Problem,
    (best, own): &Beside,
    (moves, starts): (&dyn Fn(&str) -> bool, usize),
    number: usize,
) -> Option<Excluding> {
    let ((mut part, _), (best, places)) = (problem.only(number), best.only(number));
    let own = own.each_ref().map(|all| places.iter().map(|&i| all[i]).collect::<Vec<f64>>());
    let beside = part.beside.insert(Box::new((best, own)));
    let best = least(&beside.0, &beside.1[0], &beside.1[1], Stage::Profile).ok()?.value;
    let found = search(&part, moves, starts, false).ok()?;
    let above =
        Some(found.best.value - best).filter(|x| *x >= excluded_by_one(problem) && found.best.reached >= SEVERAL);
    let by_all = above.map(|above| sigmas(above, 1));
    let by = found.excluded_by.map(|(_, sigmas)| sigmas).or(by_all)?;
    Some((format!("film {} alone", number + 1), by))
}

/// The significance at which this beginning excludes its formulation, if it does: by a least χ² over this
/// limit that several starts reach. Where it may, `starts` become the minima.
fn excluded(part: &Problem, starts: &mut Vec<Minimum>, scale: &[f64], (best, own): &Beside, limit: f64) -> Option<f64> {
    let best = least(&best.beginning(part.samples()).ok()?, &own[0], &own[1], Stage::Profile).ok()?.value;
    let enough = |found: &[Minimum]| Some(found.first()?.value - best).filter(|above| *above >= limit);
    enough(starts)?;
    *starts = refined(part, std::mem::take(starts), scale, Stage::Whole, &mut None);
    let mut as_one = starts.clone();
    as_high(&mut as_one);
    enough(&as_one).filter(|_| as_one[0].reached >= SEVERAL).map(|above| sigmas(above, 1))
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
        seen.into_iter().zip(found.unknowns).for_each(|(i, x)| start[i] = x);
    }
    start
}

/// The minima with one parameter at 0 each: formulations agree where a parameter is none of theirs.
fn absent(problem: &Problem) -> Vec<Minimum> {
    let without = |i: usize| {
        let mut least = search(&problem.without(i, 0.0), &|_| false, 1, false).ok()?.best.unknowns;
        least.insert(i, 0.0);
        Some(Minimum::start(0, least))
    };
    // what a prior or a bound keeps from 0 stays
    let may_vanish = |i: &usize| {
        let is_free = problem.unknowns()[*i].bound.is_none_or(|bound| bound <= 0.0);
        is_free && problem.doubt(*i) > 0.0 && problem.doubt(*i) >= problem.start()[*i].abs()
    };
    let all = if problem.first == 0 { 0..problem.start().len() } else { 0..0 };
    all.filter(may_vanish).filter_map(without).collect()
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
                // what only round-off moves has no scale of its own
                let is_moved = length * plain(i) > NOTHING * extent && length.is_finite();
                if is_moved { extent / length } else { plain(i) }
            };
            ((0..start.len()).map(scale).collect(), None)
        }
        Err(reason) => ((0..start.len()).map(plain).collect(), Some(reason)),
    }
}

/// Start `number` of the search; in every other one parameters are others as well: formulations agree where a
/// parameter is none of theirs.
fn moved(problem: &Problem, scale: &[f64], moves: &dyn Fn(&str) -> bool, own: usize) -> Minimum {
    let number = problem.first + own;
    let width = |i: usize| match moves(&problem.unknowns()[i].name) {
        true => scale[i],
        false if number % 2 == 1 => problem.doubt(i),
        false => 0.0,
    };
    let widths: Vec<f64> = (0..scale.len()).map(width).collect();
    let mut parts = spread(number, widths.iter().filter(|w| **w > 0.0).count()).into_iter();
    let mut along = |i: usize| {
        let start = problem.start()[i];
        if widths[i] <= 0.0 || number == 0 {
            return start;
        }
        let x = start + widths[i] * parts.next().expect("one per unknown that is moved");
        problem.unknowns()[i].bound.map_or(x, |bound| bound + (x - bound).abs())
    };
    Minimum::start(own, (0..scale.len()).map(&mut along).collect())
}

/// Starts for the whole film at once: the first one, and those of the others that come closest to it.
fn screened(problem: &Problem, moves: &dyn Fn(&str) -> bool, starts: usize) -> Vec<Minimum> {
    let mut evaluated = problem.clone();
    let (scale, _) = scales(&mut evaluated);
    let mut others: Vec<Minimum> = Vec::new();
    for number in 1..starts {
        // far ones and near ones: nothing is linear as far as the extent of the film
        let nearer: Vec<f64> = scale.iter().map(|s| s * 0.5_f64.powi(number as i32 % HALVINGS)).collect();
        let start = moved(problem, &nearer, moves, number);
        if let Ok((values, _)) = evaluated.weighed(&start.unknowns, false) {
            others.push(Minimum { value: values.norm_squared(), ..start });
        }
    }
    others.sort_by(|a, b| a.value.total_cmp(&b.value));
    others.truncate(SEVERAL);
    [Minimum::start(0, problem.start().to_vec())].into_iter().chain(others).collect()
}

/// Where motions reach the ends of their films: `theta`, or the first point halfway back to an `origin` whose
/// motion reaches the end of a first beginning.
fn within(problem: &Problem, origin: Option<&[f64]>, theta: &[f64]) -> Vec<f64> {
    let Some(origin) = origin.filter(|origin| *origin != theta) else { return theta.to_vec() };
    let mut problem = problem.clone();
    let at = |halvings: i32| -> Vec<f64> {
        let part = 0.5_f64.powi(halvings);
        origin.iter().zip(theta).map(|(o, x)| o + part * (x - o)).collect()
    };
    (0..HALVINGS).map(at).find(|theta| problem.weighed(theta, false).is_ok()).unwrap_or_else(|| origin.to_vec())
}
