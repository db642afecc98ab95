//! Formulations side by side.

use std::sync::Mutex;

use deltaq::{CHETAEV, Choice, choices_among, over_threads};
use equations::Formulation;
use scene::Scene;

use crate::creep;
use crate::length::length_that_tells;
use crate::question::{SLIP, has_constants, is_constant, is_law, problem_of};
use crate::search::{POOR, begun};
use crate::{EXCLUDED, Film, Fit, FitError, Problem, Question, Row, Unknown, Verdict, fit, verdicts};

/// Most numbers of all films: with them a fit takes minutes.
const MOST_NUMBERS: usize = 300_000;

/// Times as many starts of a search for constants, where no formulation fits.
const MORE_STARTS: usize = 4;

/// Further groups of starts for a formulation that would be excluded and is not poor.
const GROUPS: usize = 3;

/// A fit with what was fitted.
type Fitted = Result<(Problem, Fit), FitError>;

/// Fits every formulation that is wanted and gives verdicts. One that cannot be fitted has the reason.
///
/// # Errors
/// [`FitError::TooLong`]; [`FitError::Unknown`] for a number of another law.
pub fn fit_formulations(
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
    let asked = |f: &Formulation| match is_law(f) {
        true => question.law_of(f).next().is_some(),
        false => wanted.iter().any(|own| **own == *f),
    };
    let choices = choices_among(&scene, asked);
    // a law that contains Chetaev's begins there
    let (laws, plain): (Vec<Choice>, Vec<Choice>) = choices.into_iter().partition(|c| is_law(c.formulation));
    let mut fits = fit_choices(&scene, plain, films, question, 0);
    let near = fits.iter().find(|(known, _)| known.formulation == CHETAEV);
    let near = near.and_then(|(_, fit)| fit.as_ref().ok()).map(|(_, fit)| fit.clone());
    let law = |choice: &Choice, near: Option<&Fit>| fit_law(&scene, choice, films, question, near);
    fits.extend(laws.into_iter().map(|choice| (choice.clone(), law(&choice, near.as_ref()))));
    // before nothing fits, more starts, and those of laws not from Chetaev's numbers
    let fits_well = |(_, fit): &(Choice, Fitted)| fit.as_ref().is_ok_and(|(_, fit)| fit.objections().next().is_none());
    if !fits.iter().any(fits_well) {
        let more = Question { starts: MORE_STARTS * question.starts, ..question.clone() };
        let again = fits.iter().map(|(choice, _)| choice).filter(|choice| has_constants(choice)).cloned().collect();
        let again = fit_choices(&scene, again, films, &more, 0);
        for ((_, fit), (_, again)) in fits.iter_mut().filter(|(choice, _)| has_constants(choice)).zip(again) {
            keep_less(fit, again);
        }
        for (choice, fit) in fits.iter_mut().filter(|(choice, _)| is_law(choice.formulation)) {
            keep_less(fit, law(choice, None));
        }
    }
    // before one is excluded whose residuals are not far off, other starts
    for group in 1..=GROUPS {
        let found = fits.iter().filter_map(|(_, fit)| fit.as_ref().ok()).map(|(_, fit)| fit.chi_squared);
        let least = found.fold(f64::INFINITY, f64::min);
        let is_doubtful = |(choice, fit): &(Choice, Fitted)| {
            let is_near = |fit: &Fit| {
                fit.chi_squared >= least + EXCLUDED && fit.chi_squared < POOR * (fit.freedom as f64).max(1.0)
            };
            has_constants(choice) && fit.as_ref().is_ok_and(|(_, fit)| is_near(fit))
        };
        let places: Vec<usize> = (0..fits.len()).filter(|&i| is_doubtful(&fits[i])).collect();
        let again = places.iter().map(|&i| fits[i].0.clone()).collect();
        let again = fit_choices(&scene, again, films, question, group * question.starts);
        for (place, (_, again)) in places.into_iter().zip(again) {
            let starts = [&fits[place].1, &again].map(|fit| fit.as_ref().map_or(0, |(_, fit)| fit.starts));
            keep_less(&mut fits[place].1, again);
            fits[place].1.iter_mut().for_each(|(_, fit)| fit.starts = starts[0] + starts[1]);
        }
    }
    let plain = |(choice, fit): &(Choice, Fitted)| {
        (choice.clone(), fit.as_ref().map(|(_, fit)| fit.clone()).map_err(FitError::clone))
    };
    let mut rows = verdicts(fits.iter().map(plain).collect());
    let labels: Vec<String> = rows.iter().map(|row| row.choice.label.clone()).collect();
    for (row, (_, own)) in rows.iter_mut().zip(&fits) {
        let asked = problem_of(&scene, &row.choice, films, question).ok();
        row.shown = asked.map(|problem| problem.identifiability(&scene, &row.choice));
        row.problem = own.as_ref().ok().map(|(problem, _)| problem.clone());
        let (Verdict::CannotTell { from, needs }, Ok((problem, fit))) = (&mut row.verdict, own) else { continue };
        let of = |label: &String| labels.iter().position(|own| own == label).and_then(|i| fits[i].1.as_ref().ok());
        *needs = from
            .iter()
            .map(|label| of(label).and_then(|(other, best)| length_that_tells((other, best), (problem, fit))))
            .collect();
    }
    Ok(rows)
}

/// The fit of less χ².
fn keep_less(known: &mut Fitted, again: Fitted) {
    let least = known.as_ref().map_or(f64::INFINITY, |(_, fit)| fit.chi_squared);
    if again.as_ref().is_ok_and(|(_, again)| again.chi_squared < least) {
        *known = again;
    }
}

/// Each of these fitted, from starts of the search that are counted from `first` on; over threads: what they
/// find does not depend on how many there are.
fn fit_choices(
    scene: &Scene,
    choices: Vec<Choice>,
    films: &[Film],
    question: &Question,
    first: usize,
) -> Vec<(Choice, Fitted)> {
    let problem = |choice: &Choice| {
        let mut problem = problem_of(scene, choice, films, question)?;
        problem.first = first;
        Ok::<_, FitError>(problem)
    };
    let problems: Vec<_> = choices.iter().map(|choice| Mutex::new(Some(problem(choice)))).collect();
    let is_of_law = |name: &str| question.law.iter().any(|u| u.name == name);
    let (starts, is_of_law): (usize, &(dyn Fn(&str) -> bool + Sync)) = (question.starts, &is_of_law);
    let fits = over_threads(question.threads, choices.len(), |i| {
        let problem = problems[i].lock().ok().and_then(|mut own| own.take()).expect("each is taken once")?;
        fit_one(problem, None, is_of_law, starts)
    });
    choices.into_iter().zip(fits).collect()
}

/// The law of first order fitted: with slip, constraints that are kept are its bound.
fn fit_law(scene: &Scene, choice: &Choice, films: &[Film], question: &Question, near: Option<&Fit>) -> Fitted {
    let is_of_law = |name: &str| question.law.iter().any(|u| u.name == name);
    let problem = problem_of(scene, choice, films, question)?;
    let Some(slip) = problem.unknowns().iter().position(|u| u.name == SLIP) else {
        return fit_one(problem, near, &is_of_law, question.starts);
    };
    let mut unmoved = scene.clone();
    let symbol = scene.system.graph.symbol(SLIP);
    unmoved.system.parameters.iter_mut().filter(|p| p.symbol == symbol).for_each(|p| p.value = 0.0);
    let law: Vec<Unknown> = question.law.iter().filter(|u| u.name != SLIP).cloned().collect();
    let kept = problem_of(&unmoved, choice, films, &Question { law: &law, ..question.clone() });
    let kept = kept.and_then(|problem| fit_one(problem, near, &is_of_law, question.starts));
    let fine = kept.as_ref().ok().map(|(_, fit)| fit).filter(|fit| fit.objections().next().is_none());
    let near = fine.or(near).cloned();
    let problem = creep::followed(&problem, slip);
    let creeping = fit_one(problem.clone(), near.as_ref(), &is_of_law, question.starts);
    creep::joined(kept, (problem, slip), creeping.map(|(_, fit)| fit))
}

fn fit_one(problem: Problem, near: Option<&Fit>, is_of_law: &dyn Fn(&str) -> bool, starts: usize) -> Fitted {
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
    let found = fit(&problem, &spread, starts, near.is_some())?;
    Ok((problem, found))
}
