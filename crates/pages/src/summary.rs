//! A comparison for a terminal: the answer and three lines, two small tables, the gaps over time.

use std::fmt::Write;

use anyhow::Result;
use comparison::{Comparison, Pair, Verdict};
use motion::{CHETAEV, Ending, VAKONOMIC, error_estimate, setting};

use crate::scene_page::ROWS;
use crate::tables::{is_seen, largest};
use comparison::words::{Headline, answer, or_dash, rows, short};
use picture::{Axis, Curve, Picture, Style};

/// Rows of the plot.
const HEIGHT: usize = 12;

/// The fewest characters of a curve that can be seen.
const SEEN: usize = 4;

/// What has been compared so far, in lines of at most `width` where they are not sentences.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn summary(comparison: &mut Comparison, width: usize) -> Result<String> {
    let Headline { verdict, why, sure, which } = Headline::of(comparison);
    let name = &comparison.scene.name;
    let [first, second] = match answer(comparison) {
        Some(answer) => [(name.as_str(), answer), ("motions", verdict)],
        None => [(name.as_str(), verdict), ("which", which.into())],
    };
    let lines = [first, second, ("why", why), ("how sure", sure)];
    let lines = lines.iter().filter(|(_, text)| !text.is_empty()).map(|(of, text)| format!("{of}: {text}\n"));
    let text: String = lines.collect();
    let motions = motions(comparison)?;
    let (plot, plotted) = plot(comparison, width)?;
    Ok(text + &motions + &pairs(comparison, &plotted) + &plot)
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
fn pairs(comparison: &Comparison, plotted: &[&Pair]) -> String {
    let mut table = vec![["", "pair", "verdict", "1e-6 after", "1e-3 after", "largest gap"].map(String::from).to_vec()];
    let label = |i: usize| short_label(comparison, i);
    let principal = |p: &&Pair| [CHETAEV, VAKONOMIC].contains(&comparison.runs[p.first].choice.formulation);
    let (shown, others): (Vec<&Pair>, Vec<&Pair>) = rows(comparison).partition(principal);
    for pair in &shown {
        let letter = plotted.iter().position(|p| (p.first, p.second) == (pair.first, pair.second));
        let letter = letter.and_then(|i| ('a'..='z').nth(i)).map_or(String::new(), String::from);
        let names = format!("{} – {}", label(pair.first), label(pair.second));
        let [first, second, _] = pair.gap.passes.map(|t| or_dash(t.map(|t| pair.gap.after(t))));
        let verdict = if is_seen(&pair.gap) { pair.gap.verdict.word() } else { "different (proved)" };
        table.push([letter, names, verdict.into(), first, second, largest(&pair.gap)].to_vec());
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

/// The gaps over time, where they are certain, of the pairs that differ and have the first motion, which is
/// Chetaev's if it was asked for; with the pairs whose curves are drawn, all of which can be seen.
fn plot(comparison: &Comparison, width: usize) -> Result<(String, Vec<&Pair>)> {
    let first = rows(comparison).map(|p| p.first).min();
    let of_first = rows(comparison).filter(|p| p.gap.shows() && Some(p.first) == first);
    let mut plotted: Vec<&Pair> = of_first.take(ROWS).collect();
    while !plotted.is_empty() {
        let text = drawn(comparison, &plotted, width)?;
        let canvas: String =
            text.lines().skip(2).take(HEIGHT).filter_map(|line| line.split(['│', '┤']).nth(1)).collect();
        let is_hidden = |i: &usize| canvas.matches((b'a' + *i as u8) as char).count() < SEEN;
        // the last of those behind others first
        match (0..plotted.len()).rev().find(is_hidden) {
            Some(hidden) => drop(plotted.remove(hidden)),
            None => return Ok((text, plotted)),
        }
    }
    Ok((String::new(), plotted))
}

/// Curves of these pairs, and what a gap has to pass.
fn drawn(comparison: &Comparison, plotted: &[&Pair], width: usize) -> Result<String> {
    let start = comparison.scene.start.t;
    let label = |i: usize| short_label(comparison, i);
    let curve = |p: &&Pair| Curve {
        label: format!("{} – {}", label(p.first), label(p.second)),
        style: Style::Vakonomic,
        points: p.gap.points.iter().filter(|p| p.gap > p.limit).map(|p| (p.t - start, p.gap)).collect(),
    };
    let mut curves: Vec<Curve> = plotted.iter().map(curve).collect();
    let limits = plotted.first().map_or(&[][..], |first| &first.gap.points);
    let points = limits.iter().map(|p| (p.t - start, p.limit)).collect();
    curves.push(Curve { label: "what a gap has to pass".into(), style: Style::Threshold, points });
    let (x, y) = (Axis::log("t − t₀ (s)"), Axis::log("gap in the kinetic metric (m √kg)"));
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
