//! The tables of a scene page.

use std::fmt::Write;

use anyhow::Result;
use deltaq::{Comparison, Ending, Pair, Verdict};

use crate::report::numbers::{enumerate, or_dash, precise, short};

/// Times at which invariants and residuals are sampled.
const SAMPLES: usize = 400;

/// Part of a motion that stopped early over which invariants are looked at.
const BEFORE_A_STOP: f64 = 0.95;

/// Escapes what Markdown tables cannot hold.
pub(crate) fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// The word on a pair, with the time from which it holds.
pub(crate) fn verdict_words(gap: &deltaq::Gap) -> String {
    match &gap.verdict {
        Verdict::Same => "same".into(),
        Verdict::Different => match gap.passes[0] {
            Some(t) => format!("**different**, 1e-6 at {} s", short(t)),
            None => format!("**different**, by at most {}", short(gap.largest)),
        },
        Verdict::Undecided { because } => format!("undecided: {because}"),
    }
}

/// One line a run: how it was started and how it ended.
pub(crate) fn runs(comparison: &Comparison) -> String {
    let mut text = String::from(
        "| motion | free constants | ended | error estimate | steps | evaluations |\n|---|---|---|---|---|---|\n",
    );
    for (i, run) in comparison.runs.iter().enumerate() {
        let _ = match &run.outcome {
            Err(error) => writeln!(text, "| {} | | refused: {} | | | |", run.choice.label, cell(&error.to_string())),
            Ok(motion) => {
                let names = deltaq::constant_names(&motion.equations);
                let symbol = |name: &String| {
                    let g = &motion.equations.graph;
                    g.find_symbol(name).map_or(name.clone(), |s| format!("${}$", g.latex_symbol(s)))
                };
                let constants: Vec<String> = names
                    .iter()
                    .zip(&motion.constants)
                    .map(|(n, c)| format!("{} = {}", symbol(n), precise(*c)))
                    .collect();
                let rule = match &run.choice.constants {
                    mechanics::ConstantsRule::Natural { horizon } if !constants.is_empty() => {
                        format!("; natural at $t_1 = {horizon}$ s")
                    }
                    _ => String::new(),
                };
                let ended = match &motion.ending {
                    Ending::Completed => format!("{} s", short(motion.end())),
                    Ending::Stopped { t, cause } => format!("stopped at {} s: {}", precise(*t), cell(cause)),
                };
                let estimate = comparison
                    .pairs
                    .iter()
                    .filter(|p| p.first == i || p.second == i)
                    .map(|p| if p.first == i { p.gap.estimates[0] } else { p.gap.estimates[1] })
                    .fold(None, |a: Option<f64>, b| Some(a.map_or(b, |a| a.max(b))));
                writeln!(
                    text,
                    "| {} | {}{} | {} | {} | {} | {} |",
                    run.choice.label,
                    if constants.is_empty() { "none".into() } else { constants.join(", ") },
                    rule,
                    ended,
                    or_dash(estimate),
                    motion.work.steps,
                    motion.work.evaluations
                )
            }
        };
    }
    text
}

/// One line a pair: the verdict, when thresholds are passed, and how sure it is.
pub(crate) fn pairs(comparison: &Comparison) -> String {
    let mut text = String::from(
        "| pair | verdict | τ(1e-6) | τ(1e-3) | τ(0.1) | largest gap | errors, both | largest difference by coordinate |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for pair in &comparison.pairs {
        let coordinates: Vec<String> = comparison
            .scene
            .system
            .coordinates
            .iter()
            .zip(&pair.gap.largest_by_coordinate)
            .map(|(c, d)| format!("{} {}", c.name, short(*d)))
            .collect();
        let [a, b, c] = pair.gap.passes.map(or_dash);
        let verdict = match &pair.gap.verdict {
            Verdict::Same => "same".to_string(),
            Verdict::Different => "**different**".to_string(),
            Verdict::Undecided { because } => format!("undecided: {}", cell(because)),
        };
        let _ = writeln!(
            text,
            "| {} | {verdict} | {a} | {b} | {c} | {} | {} | {} |",
            names(comparison, pair),
            short(pair.gap.largest),
            short(pair.gap.estimates[0] + pair.gap.estimates[1]),
            coordinates.join(", ")
        );
    }
    text
}

fn names(comparison: &Comparison, pair: &Pair) -> String {
    format!("{} – {}", comparison.runs[pair.first].choice.label, comparison.runs[pair.second].choice.label)
}

/// How gaps start: measured, and predicted where a prediction exists. Empty where nothing could be fitted.
pub(crate) fn growth(comparison: &Comparison) -> String {
    let mut text = String::new();
    for pair in &comparison.pairs {
        let Some(growth) = &pair.growth else { continue };
        if text.is_empty() {
            text += "| pair | exponent | leading coefficient | fitted over | predicted exponent | predicted coefficient | off by |\n\
                     |---|---|---|---|---|---|---|\n";
        }
        let (exponent, length, off) = match &pair.predicted {
            None => ("–".into(), "–".into(), "–".into()),
            Some(p) => {
                (p.exponent.to_string(), precise(p.length), format!("{} %", short(100.0 * growth.deviation_from(p))))
            }
        };
        let _ = writeln!(
            text,
            "| {} | {:.3} | {} | {} … {} s | {exponent} | {length} | {off} |",
            names(comparison, pair),
            growth.exponent,
            precise(growth.length),
            short(growth.from),
            short(growth.to)
        );
    }
    text
}

/// What the best free constants leave of a gap.
pub(crate) fn fits(comparison: &Comparison) -> String {
    let mut text = String::new();
    for fit in &comparison.fits {
        if text.is_empty() {
            text += "| motion | fitted to | best free constants | largest gap before | largest gap left | verdict after the fit |\n\
                     |---|---|---|---|---|---|\n";
        }
        let label = |i: usize| comparison.runs[i].choice.label.clone();
        let before = comparison.pair(fit.run, fit.target).map(|p| p.gap.largest);
        let (constants, left, verdict) = match &fit.fitted {
            None => ("no constants lead to the end".into(), "–".into(), "–".into()),
            Some(fitted) => {
                let constants: Vec<String> =
                    fitted.constants.iter().map(|(n, c)| format!("{n} = {}", precise(*c))).collect();
                (constants.join(", "), short(fitted.gap.largest), verdict_words(&fitted.gap))
            }
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {left} | {} |",
            label(fit.run),
            label(fit.target),
            cell(&constants),
            or_dash(before),
            cell(&verdict)
        );
    }
    text
}

/// Drift of what should be constant, and how far the constraint was left.
///
/// # Errors
/// Where a motion cannot be read off.
pub(crate) fn invariants(comparison: &mut Comparison) -> Result<String> {
    let mut metric = deltaq::Metric::new(&comparison.scene.system)?;
    let mut text = String::from(
        "| motion | largest constraint residual | constant by theory: largest deviation | largest projection |\n|---|---|---|---|\n",
    );
    for run in &mut comparison.runs {
        let Ok(motion) = &mut run.outcome else { continue };
        let mut residual = 0.0_f64;
        // near a singularity everything is large; a motion that stops there is judged by what came before
        let part = if motion.is_complete() { 1.0 } else { BEFORE_A_STOP };
        let until = motion.start() + part * (motion.end() - motion.start());
        let times: Vec<f64> = motion.grid(SAMPLES).into_iter().filter(|&t| t <= until).collect();
        for &t in &times {
            let now = motion.at(t)?;
            residual = residual.max(metric.constraint_residual(t, &now.coordinates, &now.velocities));
        }
        let drifts: Vec<String> = motion
            .invariant_drift(&times)?
            .iter()
            .map(|(name, start, drift)| format!("{name} {} ± {}", precise(*start), short(*drift)))
            .collect();
        let projection =
            if motion.projection.projections == 0 { "–".into() } else { short(motion.projection.largest) };
        let _ = writeln!(
            text,
            "| {}{} | {} | {} | {projection} |",
            run.choice.label,
            if part < 1.0 { format!(", to {} s", short(until)) } else { String::new() },
            short(residual),
            if drifts.is_empty() { "nothing".into() } else { enumerate(&drifts) }
        );
    }
    Ok(text)
}
