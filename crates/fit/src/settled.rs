//! Whether an exclusion is settled, and whether plain explanations do as well.

use scene::Scene;

use crate::explain::explanations;
use crate::question::{has_constants, is_law};
use crate::search::{SEVERAL, is_as_high};
use crate::{Film, Fit, Question, Row, Verdict};

/// An exclusion rests on a least χ² that several starts reach: of the whole films, where half of all starts
/// lead as low, or of their beginnings, which have no more minima than tell. Elsewhere the search is not
/// settled.
pub(crate) fn settle(rows: &mut [Row]) {
    for row in rows.iter_mut() {
        let (&Verdict::Excluded { sigmas }, Ok(fit)) = (&row.verdict, &row.fit) else { continue };
        match &fit.excluded_by {
            Some((part, sigmas)) => {
                row.notes.push(format!("excluded by {part}; of the whole films few starts reach the least χ²"));
                row.verdict = Verdict::Excluded { sigmas: *sigmas };
            }
            None if !has_constants(&row.choice) && !is_law(row.choice.formulation) => {}
            None if fit.reached >= SEVERAL && is_as_high(fit.by_half, fit.chi_squared) => {}
            None => row.verdict = Verdict::Unsettled { sigmas },
        }
    }
}

/// What a plain explanation brings as near as the best fits is not excluded, and does not leave the best as
/// the only one; nor does a family whose search is not settled.
pub(crate) fn explain(scene: &Scene, rows: &mut [Row], films: &[Film], question: &Question) {
    // where nothing fits: what would make it noise
    for row in rows.iter_mut().filter(|row| row.verdict == Verdict::None) {
        let (Ok(fit), Some(problem)) = (&row.fit, &row.problem) else { continue };
        let noise = Fit { chi_squared: fit.freedom as f64, ..fit.clone() };
        let found = explanations(scene, &row.choice, films, question, (problem, fit), &noise);
        row.notes.extend(found.iter().flatten().map(|found| format!("it may fit {}", found.words())));
    }
    let supported = |row: &Row| row.verdict == Verdict::Supported;
    let Some(best) = rows.iter().find(|row| supported(row)).cloned() else { return };
    let Ok(least) = &best.fit else { return };
    let is_open = |row: &&Row| matches!(row.verdict, Verdict::Unsettled { .. }) && has_constants(&row.choice);
    let mut as_well: Vec<String> = rows.iter().filter(is_open).map(|row| row.choice.label.clone()).collect();
    for row in rows.iter_mut() {
        let (Verdict::Excluded { .. }, Ok(fit), Some(problem)) = (&row.verdict, &row.fit, &row.problem) else {
            continue;
        };
        for found in explanations(scene, &row.choice, films, question, (problem, fit), least).into_iter().flatten() {
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
