//! Whether an exclusion is settled, and whether plain explanations do as well.

use scene::Scene;

use crate::explain::explanations;
use crate::question::{has_constants, is_constant, is_law};
use crate::search::{LOOKS, SEVERAL, Stage, least, search};
use crate::verdict::{above, sigmas, threshold};
use crate::{Film, Fit, Problem, Question, Row, Verdict};

/// Numbers per unknown of the first beginning of which an exclusion is asked for that no whole film settles,
/// and the factor from one to the next.
const FIRST: usize = 2;
const LONGER: f64 = 1.6;

/// An exclusion rests on a least χ² that several starts reach: of the whole films, or of their beginnings,
/// which have no more minima than tell. Elsewhere the search is not settled.
pub(crate) fn settle(rows: &mut [Row], question: &Question) {
    let fitted = rows.iter().filter_map(|row| Some((row.fit.as_ref().ok()?, row.problem.as_ref()?)));
    let best = fitted.min_by(|a, b| a.0.chi_squared.total_cmp(&b.0.chi_squared));
    let Some((best, of_best)) = best.map(|(fit, problem)| (fit.clone(), problem.clone())) else { return };
    let spread = |name: &str| is_constant(name) || question.law.iter().any(|u| u.name == name);
    for row in rows.iter_mut() {
        let (Verdict::Excluded { sigmas }, Ok(fit), Some(problem)) = (&row.verdict, &row.fit, &row.problem) else {
            continue;
        };
        let is_settled = fit.reached >= SEVERAL && fit.excluded_by.is_none();
        if is_settled || !has_constants(&row.choice) && !is_law(row.choice.formulation) {
            continue;
        }
        let (sigmas, more) = (*sigmas, above(fit, &best).1);
        let settled = || by_beginning((&of_best, &best), problem, (more, problem.samples()), &spread, question.starts);
        match fit.excluded_by.or_else(settled) {
            Some((samples, sigmas)) => {
                row.notes.push(format!(
                    "excluded by the first {samples} samples; of the whole films few starts reach the least χ²"
                ));
                row.verdict = Verdict::Excluded { sigmas };
            }
            None => row.verdict = Verdict::Unsettled { sigmas },
        }
    }
}

/// The shortest beginning of the films that excludes `problem`, by a least χ² that several starts reach: its
/// samples, fewer than `most`, and the significance, the best having so many unknowns `more`.
fn by_beginning(
    (best, fit): (&Problem, &Fit),
    problem: &Problem,
    (more, most): (usize, usize),
    spread: &dyn Fn(&str) -> bool,
    starts: usize,
) -> Option<(usize, f64)> {
    let theta: Vec<f64> = fit.estimates.iter().map(|e| e.value).take(best.unknowns().len()).collect();
    let scale: Vec<f64> = fit.estimates.iter().map(|e| if e.error.is_finite() { e.error } else { 1.0 }).collect();
    let columns = problem.films().map(|film| film.columns.len()).min().unwrap_or(1);
    let films = problem.films().count();
    let mut samples = (FIRST * problem.unknowns().len()).div_ceil(columns * films) + 1;
    while samples < most {
        let of_best = least(&best.beginning(samples).ok()?, &theta, &scale[..theta.len()], Stage::Profile).ok()?;
        let beginning = problem.beginning(samples).ok()?.alone();
        let found = search(&beginning, spread, starts, false).ok()?.best;
        let above = found.value - of_best.value;
        if above >= threshold(more) + LOOKS && found.reached >= SEVERAL {
            return Some((samples, sigmas(above, more)));
        }
        samples = (samples as f64 * LONGER) as usize;
    }
    None
}

/// What a plain explanation brings as near as the best fits is not excluded, and does not leave the best as
/// the only one.
pub(crate) fn explain(scene: &Scene, rows: &mut [Row], films: &[Film], question: &Question) {
    // where nothing fits: what would make it noise
    for row in rows.iter_mut().filter(|row| row.verdict == Verdict::None) {
        let (Ok(fit), Some(problem)) = (&row.fit, &row.problem) else { continue };
        let noise = Fit { chi_squared: fit.freedom as f64, ..fit.clone() };
        let found = explanations(scene, &row.choice, films, question, (problem, fit), &noise);
        row.notes.extend(found.iter().map(|found| format!("it may fit {}", found.words())));
    }
    let supported = |row: &Row| row.verdict == Verdict::Supported;
    let Some(best) = rows.iter().find(|row| supported(row)).cloned() else { return };
    let Ok(least) = &best.fit else { return };
    let mut as_well = Vec::new();
    for row in rows.iter_mut() {
        let (Verdict::Excluded { .. }, Ok(fit), Some(problem)) = (&row.verdict, &row.fit, &row.problem) else {
            continue;
        };
        for found in explanations(scene, &row.choice, films, question, (problem, fit), least) {
            as_well.push(format!("{} with {}", row.choice.label, found.name));
            row.notes.push(found.words());
            row.verdict = Verdict::Explained { with: Some(found.name), from: vec![best.choice.label.clone()] };
        }
    }
    if !as_well.is_empty() {
        let supported = rows.iter_mut().filter(|row| supported(row));
        supported.for_each(|row| row.verdict = Verdict::Explained { with: None, from: as_well.clone() });
    }
}
