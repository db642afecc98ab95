//! Formulations side by side.

use std::sync::Mutex;

use comparison::{Beside, hold};
use equations::Formulation;
use motion::{CHETAEV, Choice, VAKONOMIC, choices_among, over_threads};
use scene::Scene;

use crate::design::length_that_tells;
use crate::fit::{sought, with_intervals};
use crate::planned::MOST_NUMBERS;
use crate::profile::LAST;
use crate::question::{SLIP, has_constants, is_constant, is_law, problem_of};
use crate::search::{HOPELESS, begun, is_as_high};
use crate::settled::{explain, settle};
use crate::verdict::{beside, is_excluded, least};
use crate::{Film, Fit, FitError, Problem, Question, Row, Unknown, Verdict, creep, known, verdicts};

/// Further groups of starts for a formulation that would be excluded and is not poor, or where none fits.
const GROUPS: usize = 3;

/// Rounds in which standard deviations are estimated, and the part of themselves to which they are.
const ROUNDS: usize = 4;

/// A fit with what was fitted.
type Fitted = Result<(Problem, Fit), FitError>;
/// Chetaev's motion where it is known, with its problem, and a formulation that fits.
type Guides<'a> = (Option<(&'a Problem, &'a Choice, &'a Fit)>, Option<&'a (Problem, Fit)>);

/// Fits every formulation that is wanted and gives verdicts. One that cannot be fitted has the reason. Where
/// standard deviations are estimated, `films` have them afterwards: such that the best formulation leaves as
/// much.
///
/// # Errors
/// [`FitError::TooLong`]; [`FitError::Unknown`] for a number of another law; [`FitError::Contradicted`].
pub fn fit_formulations(
    scene: &Scene,
    films: &mut [Film],
    question: &Question,
    wanted: &[&'static Formulation],
) -> Result<Vec<Row>, FitError> {
    let is_estimated = films.iter().any(|film| film.columns.iter().any(|column| column.estimated));
    let mut rows = fit_given(scene, films, question, wanted)?;
    for _ in 0..if is_estimated { ROUNDS } else { 0 } {
        if !estimate_deviations(films, &rows) {
            break;
        }
        rows = fit_given(scene, films, question, wanted)?;
    }
    Ok(rows)
}

/// Sets standard deviations that are estimated by what the best of these fits leaves, those of columns of one
/// name as one; whether some changed.
fn estimate_deviations(films: &mut [Film], rows: &[Row]) -> bool {
    let Some(best) = least(rows.iter().filter_map(|row| row.fit.as_ref().ok())) else { return false };
    let free = best.freedom as f64 / best.residuals.len().max(1) as f64;
    let mut names: Vec<String> = films.iter().flat_map(|f| &f.columns).map(|c| c.name.clone()).collect();
    names.sort_unstable();
    names.dedup();
    let mut changed = false;
    for name in names {
        let own = |film: usize, column: usize| {
            let column = &films[film].columns[column];
            (column.name == name && column.estimated).then_some(column.sigma)
        };
        let errors: Vec<f64> = best.residuals.iter().filter_map(|r| Some(r.value * own(r.film, r.column)?)).collect();
        let sum: f64 = errors.iter().map(|e| e * e).sum();
        let sigma = (sum / (errors.len() as f64 * free)).sqrt();
        if !(sigma > 0.0 && sigma.is_finite()) {
            continue;
        }
        for column in films.iter_mut().flat_map(|f| &mut f.columns).filter(|c| c.name == name && c.estimated) {
            changed |= (column.sigma / sigma - 1.0).abs() > LAST;
            column.sigma = sigma;
        }
    }
    changed
}

fn fit_given(
    scene: &Scene,
    films: &[Film],
    question: &Question,
    wanted: &[&'static Formulation],
) -> Result<Vec<Row>, FitError> {
    let found: usize = films.iter().map(Film::count).sum();
    if found > MOST_NUMBERS {
        return Err(FitError::TooLong { found, limit: MOST_NUMBERS });
    }
    let (scene, law, unknowns) = question.prepared(scene)?;
    let question = &Question { unknowns: &unknowns, law: &law, ..question.clone() };
    let is_wanted = |f: &Formulation| match is_law(f) {
        true => question.law_of(f).next().is_some(),
        false => wanted.iter().any(|own| **own == *f),
    };
    // Chetaev's motion is where the search for that of another begins
    let choices = choices_among(&scene, |f| is_wanted(f) || *f == *CHETAEV);
    let labels: Vec<String> = choices.iter().map(|choice| choice.label.clone()).collect();
    let (laws, plain): (Vec<Choice>, Vec<Choice>) = choices.into_iter().partition(|c| is_law(c.formulation));
    let (families, single): (Vec<Choice>, Vec<Choice>) = plain.into_iter().partition(has_constants);
    let mut fits = fit_choices(&scene, single, films, question, 0, (None, None));
    let near = fits.iter().find(|(known, _)| *known.formulation == *CHETAEV);
    let near = near.and_then(|(choice, fit)| Some((choice.clone(), fit.as_ref().ok()?.clone())));
    let near = near.as_ref().map(|(choice, (problem, fit))| (problem, choice, fit));
    let fit_of = near.map(|(.., fit)| fit);
    let law = |choice: &Choice, near: Option<&Fit>| fit_law(&scene, choice, films, question, near);
    fits.extend(laws.into_iter().map(|choice| (choice.clone(), law(&choice, fit_of))));
    let fits_well = |(_, fit): &(Choice, Fitted)| fit.as_ref().is_ok_and(|(_, fit)| fit.faults().next().is_none());
    let fitting = fits.iter().find(|fit| fits_well(fit)).and_then(|(_, fit)| fit.clone().ok());
    fits.extend(fit_choices(&scene, families, films, question, 0, (near, fitting.as_ref())));
    fits.retain(|(choice, _)| is_wanted(choice.formulation));
    fits.sort_by_key(|(choice, _)| labels.iter().position(|label| *label == choice.label));
    // before nothing fits, laws not from Chetaev's numbers
    if !fits.iter().any(fits_well) {
        for (choice, fit) in fits.iter_mut().filter(|(choice, _)| is_law(choice.formulation)) {
            keep_less(fit, law(choice, None));
        }
    }
    // before nothing fits, or one is excluded whose residuals are not far off, other starts
    let least_of = |fit: &Fitted| fit.as_ref().map_or(f64::INFINITY, |(_, fit)| fit.chi_squared);
    let mut by_groups: Vec<Vec<f64>> = fits.iter().map(|(_, fit)| vec![least_of(fit)]).collect();
    for group in 1..=GROUPS {
        let fitted = fits.iter().filter_map(|(_, fit)| fit.as_ref().ok().map(|(_, fit)| fit));
        let (least, some) = (least(fitted).cloned(), fits.iter().any(fits_well));
        let is_doubtful = |(choice, fit): &(Choice, Fitted)| {
            let is_near = |fit: &Fit| {
                let is_poor = fit.chi_squared >= HOPELESS * (fit.freedom as f64).max(1.0);
                least.as_ref().is_some_and(|least| is_excluded(fit, least)) && !is_poor
            };
            has_constants(choice) && (!some || fit.as_ref().is_ok_and(|(_, fit)| is_near(fit)))
        };
        let places: Vec<usize> = (0..fits.len()).filter(|&i| is_doubtful(&fits[i])).collect();
        let again = places.iter().map(|&i| fits[i].0.clone()).collect();
        let again = fit_choices(&scene, again, films, question, group * question.starts, (near, None));
        for (place, (_, again)) in places.into_iter().zip(again) {
            let (fit, by_groups) = (&mut fits[place].1, &mut by_groups[place]);
            add(fit, again);
            by_groups.push(least_of(fit));
            fit.iter_mut().for_each(|(_, fit)| fit.by_half = by_groups[group / 2]);
        }
    }
    let ordered = in_order(&scene, &mut fits, question, near)?;
    let plain = |(choice, fit): &(Choice, Fitted)| {
        (choice.clone(), fit.as_ref().map(|(_, fit)| fit.clone()).map_err(FitError::clone))
    };
    let mut rows = verdicts(fits.iter().map(plain).collect());
    for (row, (_, own)) in rows.iter_mut().zip(&fits) {
        row.problem = own.as_ref().ok().map(|(problem, _)| problem.clone());
    }
    settle(&mut rows);
    explain(&scene, &mut rows, films, question);
    for row in &mut rows {
        // what is excluded has no intervals to look for, and slip has them from its bound
        let has_none = matches!(row.verdict, Verdict::Excluded { .. } | Verdict::Unsettled { .. });
        if let (false, Ok(fit), Some(problem)) = (has_none, &row.fit, &row.problem)
            && !fit.estimates.iter().any(|e| e.name == SLIP)
        {
            row.fit = Ok(with_intervals(problem, fit.clone()));
        }
        let asked = problem_of(&scene, &row.choice, films, question).ok();
        row.shown = asked.map(|problem| beside(problem.identifiability(&scene, &row.choice), row.fit.as_ref().ok()));
    }
    for (i, row) in rows.iter_mut().enumerate() {
        if ordered && *row.choice.formulation == *CHETAEV {
            row.notes.push("nested: each of its motions is vakonomic for some μ₀, which is proved".into());
        }
        let (Verdict::CannotTell { from, needs }, Ok((problem, fit))) = (&mut row.verdict, &fits[i].1) else {
            continue;
        };
        // no film tells it from what it contains
        let contains =
            |other: &Choice| ordered && *row.choice.formulation == *VAKONOMIC && *other.formulation == *CHETAEV;
        let other = |label: &String| fits.iter().find(|(own, _)| own.label == *label && !contains(own));
        let of = |label: &String| other(label).and_then(|(_, fit)| fit.as_ref().ok());
        *needs = from
            .iter()
            .map(|label| of(label).and_then(|(other, best)| length_that_tells((other, best), (problem, fit))))
            .collect();
    }
    Ok(rows)
}

/// The better of two fits from different starts, with the starts of both, and with those of both that led
/// there.
fn add(known: &mut Fitted, again: Fitted) {
    let of = |fitted: &Fitted| fitted.as_ref().ok().map(|(_, fit)| (fit.chi_squared, fit.starts, fit.reached));
    let both = of(known).zip(of(&again));
    keep_less(known, again);
    if let (Some(((a, starts, reached), (b, more, others))), Ok((_, fit))) = (both, known) {
        fit.starts = starts + more;
        fit.reached = usize::from(is_as_high(a, b)) * reached + usize::from(is_as_high(b, a)) * others;
    }
}

/// Families that are one have one least χ², and one that contains Chetaev's motions has none above Chetaev's:
/// where a search has missed that, it begins again at the other's motion. Whether the latter is proved, which
/// is asked for where Chetaev's formulation fits.
fn in_order(
    scene: &Scene,
    fits: &mut [(Choice, Fitted)],
    question: &Question,
    near: Option<(&Problem, &Choice, &Fit)>,
) -> Result<bool, FitError> {
    let is_of_law = |name: &str| question.law.iter().any(|u| u.name == name);
    let again = |problem: &Problem, start: &[f64]| {
        let mut problem = problem.clone();
        problem.begin_at(start);
        fit_one(problem, None, &is_of_law, 1, true)
    };
    let count = fits.len();
    for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
        let is_one = |a: usize, b: usize| *fits[a].0.formulation == *VAKONOMIC && fits[b].0.removal.is_some();
        if !(is_one(i, j) || is_one(j, i)) {
            continue;
        }
        let (Ok((of, best)), Ok((problem, fit))) = (&fits[i].1, &fits[j].1) else { continue };
        if !is_as_high(fit.chi_squared, best.chi_squared)
            && let Some(start) = known::same_motion(scene, (&fits[i].0, of, best), (&fits[j].0, problem))
        {
            let found = again(problem, &start);
            keep_less(&mut fits[j].1, found);
        }
    }
    let Some((own, chetaev, fit)) = near.filter(|(.., fit)| fit.faults().next().is_none()) else { return Ok(false) };
    let mut ordered = false;
    for (choice, fitted) in fits.iter_mut().filter(|(choice, _)| known::contains_chetaev(scene, choice)) {
        ordered = true;
        let Ok((problem, found)) = fitted else { continue };
        if !is_as_high(found.chi_squared, fit.chi_squared) {
            let starts = known::beside_chetaev(scene, choice, problem, (own, chetaev, &known::numbers(fit)));
            let found: Vec<Fitted> = starts.iter().map(|start| again(problem, start)).collect();
            found.into_iter().for_each(|found| keep_less(fitted, found));
        }
        if let Some((_, found)) = fitted.as_ref().ok().filter(|(_, found)| is_excluded(found, fit)) {
            hold(scene, [Beside::Contained(&choice.label, found.chi_squared - fit.chi_squared)])?;
        }
    }
    Ok(ordered)
}

/// The fit of less χ².
fn keep_less(known: &mut Fitted, again: Fitted) {
    let least = known.as_ref().map_or(f64::INFINITY, |(_, fit)| fit.chi_squared);
    if again.as_ref().is_ok_and(|(_, again)| again.chi_squared < least) {
        *known = again;
    }
}

/// Each of these fitted, from starts of the search that are counted from `first` on; over threads: what they
/// find does not depend on how many there are. Families begin beside Chetaev's motion as well, where that is
/// known, and their beginnings are held beside one that fits.
fn fit_choices(
    scene: &Scene,
    choices: Vec<Choice>,
    films: &[Film],
    question: &Question,
    first: usize,
    (near, beside): Guides,
) -> Vec<(Choice, Fitted)> {
    let problem = |choice: &Choice| {
        let mut problem = problem_of(scene, choice, films, question)?;
        problem.first = first;
        let near = near.filter(|_| first == 0 && has_constants(choice));
        if let Some((own, chetaev, fit)) = near {
            problem.known = known::beside_chetaev(scene, choice, &problem, (own, chetaev, &known::numbers(fit)));
        }
        problem.beside = beside.filter(|_| has_constants(choice)).map(|(own, fit)| {
            // a slip at its bound is no unknown of the problem
            let of = |all: Vec<f64>| all[..own.unknowns().len()].to_vec();
            Box::new((own.clone(), [of(fit.numbers()), of(fit.scales())]))
        });
        Ok::<_, FitError>(problem)
    };
    let problems: Vec<_> = choices.iter().map(|choice| Mutex::new(Some(problem(choice)))).collect();
    let is_of_law = |name: &str| question.law.iter().any(|u| u.name == name);
    let (starts, is_of_law): (usize, &(dyn Fn(&str) -> bool + Sync)) = (question.starts, &is_of_law);
    let fits = over_threads(question.threads, choices.len(), |i| {
        let problem = problems[i].lock().ok().and_then(|mut own| own.take()).expect("each is taken once")?;
        fit_one(problem, None, is_of_law, starts, false)
    });
    choices.into_iter().zip(fits).collect()
}

/// The law of first order fitted: with slip, constraints that are kept are its bound.
fn fit_law(scene: &Scene, choice: &Choice, films: &[Film], question: &Question, near: Option<&Fit>) -> Fitted {
    let is_of_law = |name: &str| question.law.iter().any(|u| u.name == name);
    let problem = problem_of(scene, choice, films, question)?;
    let Some(slip) = problem.unknowns().iter().position(|u| u.name == SLIP) else {
        return fit_one(problem, near, &is_of_law, question.starts, false);
    };
    let mut unmoved = scene.clone();
    let symbol = scene.system.graph.symbol(SLIP);
    unmoved.system.parameters.iter_mut().filter(|p| p.symbol == symbol).for_each(|p| p.value = 0.0);
    let law: Vec<Unknown> = question.law.iter().filter(|u| u.name != SLIP).cloned().collect();
    let kept = problem_of(&unmoved, choice, films, &Question { law: &law, ..question.clone() });
    let kept = kept.and_then(|problem| fit_one(problem, near, &is_of_law, question.starts, false));
    let kept = kept.map(|(problem, fit)| (problem.clone(), with_intervals(&problem, fit)));
    let fine = kept.as_ref().ok().map(|(_, fit)| fit).filter(|fit| fit.objections().next().is_none());
    let near = fine.or(near).cloned();
    let problem = creep::followed(&problem, slip);
    let creeping = fit_one(problem.clone(), near.as_ref(), &is_of_law, question.starts, false);
    let creeping = creeping.map(|(problem, fit)| with_intervals(&problem, fit));
    creep::joined(kept, (problem, slip), creeping)
}

fn fit_one(
    problem: Problem,
    near: Option<&Fit>,
    is_of_law: &dyn Fn(&str) -> bool,
    starts: usize,
    known: bool,
) -> Fitted {
    let mut problem = problem;
    let hidden =
        |name: &str| near.is_some_and(|near| near.estimates.iter().any(|e| e.name == name && e.error.is_infinite()));
    if let Some(near) = near {
        let known = |label: &str| near.estimates.iter().find(|e| e.name == label).map(|e| e.value);
        let start: Vec<f64> =
            problem.unknowns().iter().zip(problem.start()).map(|(u, x)| known(&u.label()).unwrap_or(*x)).collect();
        problem.begin_at(&start);
        // what Chetaev's law does not show is held at first
        let held: Vec<usize> = (0..start.len()).filter(|&i| hidden(&problem.unknowns()[i].name)).collect();
        problem.begin_at(&begun(&problem, &held));
    }
    let spread = |name: &str| is_constant(name) || is_of_law(name) || hidden(name);
    let found = sought(&problem, &spread, starts, known || near.is_some())?;
    Ok((problem, found))
}
