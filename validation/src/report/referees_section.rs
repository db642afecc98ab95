//! The page about independent implementations of the same equations.

use std::collections::BTreeMap;

use anyhow::Result;
use comparison::Comparison;
use motion::band::{SAME_ESTIMATE, SAMPLES};
use motion::{CERTAINTY, CHETAEV, Metric};
use pages::{DataPackage, Table, fill};
use program::File;

use crate::casadi_job::{Outcome, Row, Word, referee_table};
use referees::maggi::{Maggi, Motion};

/// Tolerances of the two runs of Maggi's equations; their difference estimates the error of the first.
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];

/// The page.
pub const CASADI: &str = "evidence/referees.md";

/// The page and its table. Only bounds are printed, powers of ten, so that nothing changes with the last
/// digit of a difference.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn referees_files<'a>(
    comparisons: impl Iterator<Item = &'a mut Comparison>,
    casadi: &Outcome,
) -> Result<Vec<File>> {
    let mut rows = Vec::new();
    for comparison in comparisons {
        rows.extend(maggi(comparison)?);
    }
    rows.extend(casadi.rows().iter().cloned());
    let mut by_who: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for row in &rows {
        let [agree, all] = by_who.entry(&row.who).or_default();
        (*agree, *all) = (*agree + usize::from(row.verdict == Word::Agrees), *all + 1);
    }
    let mut table = Table::new(["who", ">agree", ">of"]);
    by_who.iter().for_each(|(who, [agree, all])| table.row(&[who, agree, all]));
    let mut data = DataPackage::new("data/referees", "Independent implementations of the same equations");
    data.table("comparisons", "Every comparison, with its largest relative difference", &referee_table(&rows));
    let not_run = match casadi {
        Outcome::NotRun(reason) => format!("CasADi and SymPy: *not run: {reason}.*\n\n"),
        Outcome::Ran(_) => String::new(),
    };
    let agree = rows.iter().filter(|row| row.verdict == Word::Agrees).count();
    let (count, list) = (rows.len(), data.list(1));
    let text = fill(
        include_str!("pages/referees.md"),
        &[("agree", &agree), ("count", &count), ("not_run", &not_run), ("table", &table), ("data", &list)],
    );
    Ok([File { path: CASADI.into(), text }].into_iter().chain(data.files()).collect())
}

/// A page without the lines that lead to what other programs say.
pub fn without_referees(page: &str) -> String {
    page.lines().filter(|line| !line.contains(CASADI)).map(|line| format!("{line}\n")).collect()
}

/// Chetaev's motion by Maggi's equations, in the kinetic metric and relative to the way.
fn maggi(comparison: &mut Comparison) -> Result<Option<Row>> {
    let Some(index) = comparison.run(CHETAEV) else { return Ok(None) };
    let (scene, run) = (&comparison.scene, &mut comparison.runs[index]);
    let what = format!("{}: motion", run.choice.label);
    let Ok(motion) = &mut run.outcome else { return Ok(None) };
    let mut row = Row {
        scene: scene.name.clone(),
        who: "Maggi's equations".into(),
        what,
        count: SAMPLES + 1,
        largest: None,
        tolerance: SAME_ESTIMATE,
        verdict: Word::Failed,
        note: String::new(),
        condition: None,
    };
    let mut runs = match Maggi::new(&scene.system)
        .and_then(|mut maggi| maggi.solve_twice(&scene.start, motion.end(), TOLERANCES))
    {
        Ok(runs) => runs,
        Err(error) => {
            row.note = error.to_string();
            return Ok(Some(row));
        }
    };
    let mut metric = Metric::new(&scene.system)?;
    let (mut apart, mut estimate, mut way) = (0.0_f64, 0.0_f64, 0.0_f64);
    let first = motion.at(motion.start())?.coordinates;
    let end = runs.iter().map(Motion::end).fold(motion.end(), f64::min);
    for i in 0..=SAMPLES {
        let t = motion.start() + (end - motion.start()) * i as f64 / SAMPLES as f64;
        let (ours, looser) = motion.at_in_both_runs(t)?;
        let [one, two] = [runs[0].state(t)?.q, runs[1].state(t)?.q];
        let mut length = |a: &[f64], b: &[f64]| {
            let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            metric.length(t, &ours.coordinates, &ours.velocities, &difference)
        };
        apart = apart.max(length(&ours.coordinates, &two));
        estimate = estimate.max(length(&one, &two) + length(&ours.coordinates, &looser.coordinates));
        way = way.max(length(&ours.coordinates, &first));
    }
    let way = if way > 0.0 { way } else { 1.0 };
    if end < motion.end() {
        row.note = format!("up to t = {end:.3}");
    }
    let (relative, limit) = (apart / way, CERTAINTY * estimate / way);
    row.largest = relative.is_finite().then_some(relative);
    if relative > SAME_ESTIMATE && relative <= limit {
        row.note = "as far as the error estimates reach".into();
        row.tolerance = 10_f64.powi(limit.log10().ceil() as i32);
    }
    row.verdict = if relative <= row.tolerance { Word::Agrees } else { Word::Disagrees };
    Ok(Some(row))
}
