//! The tables of a scene page.

use anyhow::Result;
use comparison::{Comparison, Pair, Verdict};
use motion::{ChartChange, Ending};

use crate::table::Table;
use comparison::words::{by_half, enumerate, or_dash, precise, reached, short, unseen};

/// Times at which invariants and residuals are sampled.
const SAMPLES: usize = 400;

/// Part of a motion that stopped early over which invariants are looked at.
const BEFORE_A_STOP: f64 = 0.95;

/// The word on a pair, with the time from which it holds.
pub fn verdict_words(gap: &comparison::Gap) -> String {
    match &gap.verdict {
        Verdict::Same => "same".into(),
        Verdict::Different => match gap.passes[0] {
            Some(t) => format!("**different**, 1e-6 after {} s", short(gap.after(t))),
            None if gap.certain_from.is_none() => format!("**different**: proved; {}", unseen(gap)),
            None => format!("**different**, by at most {}", short(gap.largest)),
        },
        Verdict::Undecided { because } => format!("undecided: {because}"),
    }
}

/// One line per run: how it was started and how it ended.
pub(crate) fn runs(comparison: &Comparison) -> Table {
    let mut table = Table::new(["motion", "free constants", "ended", "error estimate", "method", "steps"]);
    for (i, run) in comparison.runs.iter().enumerate() {
        match &run.outcome {
            Err(error) => table.row(&[&run.choice.label, &"", &format!("refused: {error}"), &"", &"", &""]),
            Ok(motion) => {
                let names = motion::constant_names(&motion.equations);
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
                    Ending::Completed => format!("{} s", short(motion.end() - motion.start())),
                    Ending::Stopped { t, cause } => format!("stopped at {} s: {cause}", precise(*t)),
                };
                let chart = |c: &ChartChange| format!("; by {} from {} s on", c.by, precise(c.t));
                let ended = ended + &motion.charts.iter().map(chart).collect::<String>();
                let estimate = comparison.estimate(i);
                let constants = if constants.is_empty() { "none".into() } else { constants.join(", ") };
                let (estimate, work) = (or_dash(estimate), &motion.work);
                let method = motion.method.as_ref().map_or("equal steps", |chosen| chosen.method.name());
                let constants = constants + &rule;
                table.row(&[&run.choice.label, &constants, &ended, &estimate, &method, &work.steps]);
            }
        }
    }
    table
}

/// One line per pair: the verdict, when thresholds are passed, and how sure it is.
pub(crate) fn pairs(comparison: &Comparison) -> Table {
    let columns = ["pair", "verdict", "τ(1e-6)", "τ(1e-3)", "τ(0.1)", "largest gap", "errors, both"];
    let mut table = Table::new(columns.into_iter().chain(["largest difference by coordinate"]));
    for pair in &comparison.pairs {
        let coordinates: Vec<String> = comparison
            .scene
            .system
            .coordinates
            .iter()
            .zip(&pair.gap.largest_by_coordinate)
            .map(|(c, d)| format!("{} {}", c.name, short(*d)))
            .collect();
        let [a, b, c] = pair.gap.passes.map(|t| or_dash(t.map(|t| pair.gap.after(t))));
        let verdict = match &pair.gap.verdict {
            Verdict::Same => "same".to_string(),
            Verdict::Different if pair.gap.certain_from.is_none() => {
                format!("**different**: proved; {}", unseen(&pair.gap))
            }
            Verdict::Different => "**different**".to_string(),
            Verdict::Undecided { because } => format!("undecided: {because}"),
        };
        let (largest, errors) = (short(pair.gap.largest), short(pair.gap.estimates[0] + pair.gap.estimates[1]));
        let names = names(comparison, pair);
        table.row(&[&names, &verdict, &a, &b, &c, &largest, &errors, &coordinates.join(", ")]);
    }
    table
}

fn names(comparison: &Comparison, pair: &Pair) -> String {
    format!("{} – {}", comparison.runs[pair.first].choice.label, comparison.runs[pair.second].choice.label)
}

/// How gaps start: measured, and predicted where a prediction exists. Empty where nothing could be fitted.
pub(crate) fn growth(comparison: &Comparison) -> Table {
    let columns = ["pair", "exponent", "leading coefficient", "fitted over", "predicted exponent"];
    let mut table = Table::new(columns.into_iter().chain(["predicted coefficient", "off by", "proved"]));
    for pair in &comparison.pairs {
        let Some(growth) = &pair.growth else { continue };
        let [exponent, length, off, proved] = match &pair.predicted {
            None => ["–"; 4].map(String::from),
            Some(p) => {
                let off = format!("{} %", short(100.0 * growth.deviation_from(p)));
                [p.exponent.to_string(), precise(p.length), off, if p.proved { "yes" } else { "no" }.into()]
            }
        };
        let measured = [format!("{:.3}", growth.exponent), precise(growth.length)];
        let over = format!("{} … {} s", short(growth.from), short(growth.to));
        table.row(&[&names(comparison, pair), &measured[0], &measured[1], &over, &exponent, &length, &off, &proved]);
    }
    table
}

/// What free constants that a search has found leave of a gap.
pub(crate) fn fits(comparison: &Comparison) -> Table {
    let columns = ["motion", "fitted to", "by", "free constants", "largest gap before", "largest gap, best found"];
    let mut table = Table::new(columns.into_iter().chain(["from half of the starts", "verdict after"]));
    for fit in &comparison.fits {
        let label = |i: usize| comparison.runs[i].choice.label.clone();
        let before = comparison.pair(fit.run, fit.target).map(|p| p.gap.largest);
        let (constants, left, half, verdict) = match &fit.fitted {
            None => ("no constants lead to the end".into(), "–".into(), "–".into(), "–".into()),
            Some(fitted) => {
                let constants: Vec<String> =
                    fitted.constants.iter().map(|(n, c)| format!("{n} = {}", precise(*c))).collect();
                (constants.join(", "), reached(fitted), by_half(fitted), verdict_words(&fitted.gap))
            }
        };
        let how = match &fit.fitted {
            _ if fit.by_identity => "identity".into(),
            Some(fitted) => format!("search from {} starts", fitted.starts),
            None => "search".into(),
        };
        table.row(&[&label(fit.run), &label(fit.target), &how, &constants, &or_dash(before), &left, &half, &verdict]);
    }
    table
}

/// Drift of what should be constant, and how far the constraint was left.
pub(crate) fn invariants(comparison: &mut Comparison) -> Result<Table> {
    let mut metric = motion::Metric::new(&comparison.scene.system)?;
    let columns = ["motion", "largest constraint residual", "constant by theory: largest deviation"];
    let mut table = Table::new(columns.into_iter().chain(["largest projection"]));
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
        let until = if part < 1.0 { format!(", to {} s", short(until)) } else { String::new() };
        let drifts = if drifts.is_empty() { "nothing".into() } else { enumerate(&drifts) };
        table.row(&[&format!("{}{until}", run.choice.label), &short(residual), &drifts, &projection]);
    }
    Ok(table)
}
