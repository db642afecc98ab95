//! A comparison for a terminal: four lines, two small tables, the gaps over time.

use std::fmt::Write;

use anyhow::Result;
use comparison::{Comparison, Pair, Verdict};
use motion::{CHETAEV, Ending, VAKONOMIC, error_estimate, setting};

use comparison::words::{Headline, rows};
use comparison::words::{or_dash, short};
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
    let Headline { verdict, why, sure, which } = Headline::of(comparison);
    let name = &comparison.scene.name;
    let lines = [(name.as_str(), verdict), ("why", why), ("how sure", sure), ("which", which.into())];
    let lines = lines.iter().filter(|(_, text)| !text.is_empty()).map(|(of, text)| format!("{of}: {text}\n"));
    let text: String = lines.collect();
    Ok(text + &motions(comparison)? + &pairs(comparison) + &plot(comparison, width)?)
}

/// One line per motion: where it ends, how wrong it is; alone, with where it is then.
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
            Ending::Completed => format!("{} s", short(motion.end() - motion.start())),
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

/// A label that leaves room for another one beside it.
fn short_label(comparison: &Comparison, run: usize) -> String {
    comparison.runs[run].choice.label.replace("removed constraint", "removed")
}

/// One line per pair with Chetaev's or the vakonomic motion, with the letter of its curve; of the others
/// those that differ are named, those that agree are counted.
fn pairs(comparison: &Comparison) -> String {
    let mut table = vec![["", "pair", "verdict", "1e-6 after", "1e-3 after", "largest gap"].map(String::from).to_vec()];
    let (label, plotted) = (|i: usize| short_label(comparison, i), plotted(comparison));
    let principal = |p: &&Pair| [CHETAEV, VAKONOMIC].contains(&comparison.runs[p.first].choice.formulation);
    let (shown, others): (Vec<&Pair>, Vec<&Pair>) = rows(comparison).partition(principal);
    for pair in &shown {
        let letter = plotted.iter().position(|p| (p.first, p.second) == (pair.first, pair.second));
        let letter = letter.and_then(|i| ('a'..='z').nth(i)).map_or(String::new(), String::from);
        let names = format!("{} – {}", label(pair.first), label(pair.second));
        let [first, second, _] = pair.gap.passes.map(|t| or_dash(t.map(|t| pair.gap.after(t))));
        let seen = pair.gap.verdict != Verdict::Different || pair.gap.certain_from.is_some();
        let verdict = if seen { pair.gap.verdict.word() } else { "different (proved)" };
        let largest = if seen { short(pair.gap.largest) } else { format!("< {}", short(pair.gap.bound())) };
        table.push([letter, names, verdict.into(), first, second, largest].to_vec());
    }
    let mut rest = String::new();
    for pair in others.iter().filter(|p| p.gap.verdict != Verdict::Same) {
        let _ = writeln!(rest, "   {}: {} – {}", pair.gap.verdict.word(), label(pair.first), label(pair.second));
    }
    match others.iter().filter(|p| p.gap.verdict == Verdict::Same).count() {
        0 => {}
        1 => rest += "   one further pair: same\n",
        same => {
            let _ = writeln!(rest, "   {same} further pairs: same");
        }
    }
    let table = if shown.is_empty() { String::new() } else { aligned(&table) };
    table + &rest
}

/// Pairs that differ: those with the first motion, which is Chetaev's if it was asked for.
fn plotted(comparison: &Comparison) -> Vec<&Pair> {
    let differ = rows(comparison).filter(|p| p.gap.shows());
    let first = rows(comparison).map(|p| p.first).min();
    differ.filter(|p| Some(p.first) == first).take(CURVES).collect()
}

/// Their gaps over time, where they are certain.
fn plot(comparison: &Comparison, width: usize) -> Result<String> {
    let start = comparison.scene.start.t;
    let label = |i: usize| short_label(comparison, i);
    let plotted = plotted(comparison);
    let mut curves: Vec<Curve> = plotted
        .iter()
        .map(|p| Curve {
            label: format!("{} – {}", label(p.first), label(p.second)),
            style: Style::Vakonomic,
            points: p.gap.points.iter().filter(|p| p.gap > p.limit).map(|p| (p.t - start, p.gap)).collect(),
        })
        .collect();
    let Some(first) = plotted.first() else { return Ok(String::new()) };
    let limit = first.gap.points.iter().map(|p| (p.t - start, p.limit)).collect();
    curves.push(Curve { label: "what a gap has to pass".into(), style: Style::Threshold, points: limit });
    let (x, y) = (Axis::linear("t − t₀ (s)"), Axis::log("gap in the kinetic metric (m √kg)"));
    let x = Axis { range: Some((0.0, comparison.scene.duration)), ..x };
    Ok("\n".to_owned() + &Picture::new("gaps", x, y, curves).to_text(width, HEIGHT)?)
}

/// Columns two blanks apart; the first line is the head.
fn aligned(table: &[Vec<String>]) -> String {
    let columns = table.iter().map(Vec::len).max().unwrap_or(0);
    let length = |line: &Vec<String>, i: usize| line.get(i).map_or(0, |cell| cell.chars().count());
    let widths: Vec<usize> =
        (0..columns).map(|i| table.iter().map(|line| length(line, i)).max().unwrap_or(0)).collect();
    let line = |line: &Vec<String>| {
        let cells = line.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}")).collect::<Vec<_>>();
        cells.join("  ").trim_end().to_owned() + "\n"
    };
    table.iter().fold(String::from("\n"), |text, cells| text + &line(cells))
}
