//! A comparison for a terminal: three lines, two small tables, the gaps over time.

use anyhow::Result;
use deltaq::{Comparison, Ending, Verdict, error_estimate, setting};

use crate::report::headline::{Headline, rows};
use crate::report::numbers::{or_dash, short};
use picture::{Axis, Curve, Picture, Style};

/// Rows of the plot.
const HEIGHT: usize = 12;

/// Most curves of the plot.
const CURVES: usize = 5;

/// What has been compared so far, in lines of at most `width` where they are not sentences.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn summary(comparison: &mut Comparison, width: usize) -> Result<String> {
    let Headline { verdict, why, sure } = Headline::of(comparison);
    let name = &comparison.scene.name;
    let lines = [(name.as_str(), verdict), ("why", why), ("how sure", sure)];
    let lines = lines.iter().filter(|(_, text)| !text.is_empty()).map(|(of, text)| format!("{of}: {text}\n"));
    let text: String = lines.collect();
    Ok(text + &motions(comparison)? + &pairs(comparison) + &plot(comparison, width)?)
}

/// One line a motion: where it ends, how wrong it is; alone, with where it is then.
fn motions(comparison: &mut Comparison) -> Result<String> {
    let mut table = vec![["motion", "to", "error", "by", "steps"].map(String::from).to_vec()];
    let estimates: Vec<Option<f64>> = (0..comparison.runs.len()).map(|i| comparison.estimate(i)).collect();
    let Comparison { scene, runs, .. } = comparison;
    for (run, estimate) in runs.iter_mut().zip(estimates) {
        let Ok(motion) = &mut run.outcome else { continue };
        let (alone, method) = (estimate.is_none(), motion.method.as_ref());
        let method = method.map_or("equal steps", |chosen| chosen.method.name());
        let estimate = estimate.map_or_else(|| Ok(error_estimate(motion, setting(scene))?.absolute), anyhow::Ok)?;
        let end = match &motion.ending {
            Ending::Completed => format!("{} s", short(motion.end())),
            Ending::Stopped { t, .. } => format!("stops at {} s", short(*t)),
        };
        let steps = motion.work.steps.to_string();
        let mut line = vec![run.choice.label.clone(), end, short(estimate), method.into(), steps];
        if alone {
            let last = motion.at(motion.end())?.coordinates;
            for (c, q) in scene.system.coordinates.iter().zip(last) {
                line.push(format!("{} = {}", c.name, short(q)));
            }
        }
        table.push(line);
    }
    Ok(aligned(&table))
}

/// One line a pair, with the letter of its curve.
fn pairs(comparison: &Comparison) -> String {
    let head = ["", "pair", "verdict", "1e-6 at", "1e-3 at", "largest gap", "certain from"];
    let mut table = vec![head.map(String::from).to_vec()];
    let (label, plotted) = (|i: usize| &comparison.runs[i].choice.label, plotted(comparison));
    for pair in rows(comparison) {
        let verdict = match &pair.gap.verdict {
            Verdict::Same => "same",
            Verdict::Different => "different",
            Verdict::Undecided { .. } => "undecided",
        };
        let letter = plotted.iter().position(|p| (p.first, p.second) == (pair.first, pair.second));
        let letter = letter.and_then(|i| ('a'..='z').nth(i)).map_or(String::new(), String::from);
        let names = format!("{} – {}", label(pair.first), label(pair.second));
        let [first, second, _] = pair.gap.passes.map(or_dash);
        let line = [letter, names, verdict.into(), first, second, short(pair.gap.largest), or_dash(pair.gap.certain_from)];
        table.push(line.to_vec());
    }
    if table.len() > 1 { aligned(&table) } else { String::new() }
}

/// Pairs that differ: those with the first motion, which is Chetaev's if it was asked for.
fn plotted(comparison: &Comparison) -> Vec<&deltaq::Pair> {
    let differ = rows(comparison).filter(|p| p.gap.verdict == Verdict::Different);
    let first = rows(comparison).map(|p| p.first).min();
    differ.filter(|p| Some(p.first) == first).take(CURVES).collect()
}

/// Their gaps over time.
fn plot(comparison: &Comparison, width: usize) -> Result<String> {
    let start = comparison.scene.start.t;
    let label = |i: usize| &comparison.runs[i].choice.label;
    let plotted = plotted(comparison);
    let mut curves: Vec<Curve> = plotted
        .iter()
        .map(|p| Curve {
            label: format!("{} – {}", label(p.first), label(p.second)),
            style: Style::Vakonomic,
            points: p.gap.points.iter().map(|p| (p.t - start, p.gap)).collect(),
        })
        .collect();
    let Some(first) = plotted.first() else { return Ok(String::new()) };
    let limit = first.gap.points.iter().map(|p| (p.t - start, p.limit)).collect();
    curves.push(Curve { label: "what a gap has to pass".into(), style: Style::Threshold, points: limit });
    let axes = (Axis::linear("t − t₀ (s)"), Axis::log("gap, kinetic metric"));
    Ok("\n".to_owned() + &Picture::new("gaps", axes.0, axes.1, curves).to_text(width, HEIGHT)?)
}

/// Columns two blanks apart; the first line is the head.
fn aligned(table: &[Vec<String>]) -> String {
    let columns = table.iter().map(Vec::len).max().unwrap_or(0);
    let length = |line: &Vec<String>, i: usize| line.get(i).map_or(0, |cell| cell.chars().count());
    let widths: Vec<usize> = (0..columns).map(|i| table.iter().map(|line| length(line, i)).max().unwrap_or(0)).collect();
    let line = |line: &Vec<String>| {
        let cells = line.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}")).collect::<Vec<_>>();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    table.iter().fold(String::from("\n"), |text, cells| text + &line(cells))
}
