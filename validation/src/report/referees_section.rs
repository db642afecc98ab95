//! The section of a scene page that says what the referees found.

use anyhow::Result;
use comparison::Comparison;
use motion::{CHETAEV, Metric};

use crate::casadi_job::{Outcome, Row, Word, referee_table};
use referees::maggi::{Maggi, Motion};

/// Tolerances of the two runs of Maggi's equations; their difference estimates the error of the first.
const TOLERANCES: [f64; 2] = [1e-11, 1e-13];
/// Equidistant times at which the motions are compared, besides the start.
const TIMES: usize = 100;
/// Difference over the way that counts as none.
const SAME: f64 = 1e-8;
/// A difference counts as none, too, under this multiple of the error estimates.
const CERTAINTY: f64 = 10.0;

/// The place in the reports that the overview's line about CasADi leads to.
pub const CASADI: &str = "scenes/sledge.md#referees";

/// The section, in Markdown; empty where there is nothing to say. Only bounds are printed, powers of ten, so
/// that the page does not change with the last digit of a difference.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn referees_section(comparison: &mut Comparison, casadi: Option<&Outcome>) -> Result<String> {
    let mut rows = Vec::new();
    rows.extend(maggi(comparison)?);
    if let Some(outcome) = casadi {
        rows.extend(outcome.rows().iter().filter(|row| row.scene == comparison.scene.name).cloned());
    }
    let mut text = String::from("\n## Referees\n\n");
    text += "Other derivations of the same equations, by programs that share no derivation with this one.\n\n";
    if let Some(Outcome::NotRun(reason)) = casadi {
        text += &format!("CasADi and SymPy: *not run: {reason}.*\n\n");
    }
    if rows.is_empty() {
        return Ok(if matches!(casadi, Some(Outcome::NotRun(_))) { text } else { String::new() });
    }
    text += &referee_table(&rows);
    text += "\nRates are compared at random states near the start, each relative to the largest rate or multiplier of its instant; motions by coordinate, relative to \
             the way; the curves of stationary action come from the discretized action itself, without an equation of motion.\n";
    Ok(text)
}

/// A committed page without what referees say that are other programs: on pages of scenes their section is
/// the last one, on the overview a line leads there.
pub fn without_referees(page: &str) -> String {
    let before = page.split("\n## Referees\n").next().unwrap_or(page);
    before.lines().filter(|line| !line.contains(CASADI)).map(|line| format!("{line}\n")).collect()
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
        count: TIMES + 1,
        largest: None,
        tolerance: SAME,
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
    for i in 0..=TIMES {
        let t = motion.start() + (end - motion.start()) * i as f64 / TIMES as f64;
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
    if relative > SAME && relative <= limit {
        row.note = "as far as the error estimates reach".into();
        row.tolerance = 10_f64.powi(limit.log10().ceil() as i32);
    }
    row.verdict = if relative <= row.tolerance { Word::Agrees } else { Word::Disagrees };
    Ok(Some(row))
}
