//! The tables of a scene page.

use anyhow::Result;
use comparison::{Comparison, Gap, Pair, Verdict};
use motion::band::{BEFORE_THE_END, SAMPLES};
use motion::{ChartChange, Ending};

use crate::table::Table;
use comparison::words::{at_most, by_half, or_dash, precise, reached, short, unseen};

/// The word on a pair, with the time from which it holds.
pub fn verdict_words(gap: &Gap) -> String {
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

/// Coordinates, their units and where they start.
pub(crate) fn start(comparison: &Comparison) -> Table {
    let scene = &comparison.scene;
    let mut table = Table::new(["coordinate", "unit", ">start", ">velocity at the start", "velocity"]);
    for (c, (q, v)) in scene.system.coordinates.iter().zip(scene.start.q.iter().zip(&scene.start.v)) {
        let rate = format!("{}'", c.name);
        let supplied = if scene.completion.supplied.contains(&rate) { "by the constraints" } else { "given" };
        table.row(&[&c.name, &c.unit, &precise(*q), &precise(*v), &supplied]);
    }
    table
}

/// One line per run: how it was started and how it ended.
pub(crate) fn runs(comparison: &Comparison) -> Table {
    let columns = ["motion", "free constants", "rule", ">from (s)", ">to (s)", "stopped because"];
    let mut table = Table::new(columns.into_iter().chain(["charts", ">error estimate", "form", "method", ">steps"]));
    for (i, run) in comparison.runs.iter().enumerate() {
        let label = run.choice.label.clone();
        let motion = match &run.outcome {
            Err(error) => {
                let refused = format!("no motion: {error}");
                table.cells([&label, "", "", "", "", &refused, "", "", "", "", ""].map(String::from));
                continue;
            }
            Ok(motion) => motion,
        };
        let names = motion::constant_names(&motion.equations);
        let constants = names.iter().zip(&motion.constants).map(|(n, c)| format!("{n} = {}", precise(*c)));
        let constants = constants.collect::<Vec<_>>().join(", ");
        let rule = match &run.choice.constants {
            mechanics::ConstantsRule::Natural { horizon } if !constants.is_empty() => {
                format!("natural at t1 = {horizon} s")
            }
            _ => String::new(),
        };
        let cause = match &motion.ending {
            Ending::Completed => String::new(),
            Ending::Stopped { cause, .. } => cause.to_string(),
        };
        let chart = |c: &ChartChange| format!("by {} from {} s on", c.by, precise(c.t));
        let charts = motion.charts.iter().map(chart).collect::<Vec<_>>().join("; ");
        let [from, to] = [motion.start(), motion.end()].map(precise);
        let method = motion.method.as_ref().map_or("equal steps", |chosen| chosen.method.name());
        let (form, steps) = (motion.form.chosen.name, motion.work.steps.to_string());
        let made = [from, to, cause, charts, or_dash(comparison.estimate(i)), form.into(), method.into(), steps];
        table.cells([label, constants, rule].into_iter().chain(made));
    }
    table
}

/// Columns of pairs that a page shows.
pub(crate) const SHOWN: [&str; 5] = ["pair", "verdict", "1e-3 after (s)", "largest gap", "errors, both"];

/// The largest gap; of motions without a difference what bounds it, as what was measured is round-off.
pub(crate) fn largest(gap: &Gap) -> String {
    match gap.verdict {
        Verdict::Same => format!("< {:.0e}", at_most(gap.bound())),
        Verdict::Different if !is_seen(gap) && gap.bound().is_finite() => format!("< {}", short(gap.bound())),
        Verdict::Different if !is_seen(gap) => "not known".into(),
        _ => short(gap.largest),
    }
}

/// Whether a difference was measured, not only proved.
pub(crate) fn is_seen(gap: &Gap) -> bool {
    gap.verdict != Verdict::Different || gap.certain_from.is_some()
}

/// One line per pair: the verdict, when thresholds are passed, and how sure it is; for a page, or with all
/// digits.
pub(crate) fn pairs<'a>(comparison: &Comparison, pairs: impl IntoIterator<Item = &'a Pair>, for_page: bool) -> Table {
    let columns = ["pair", "verdict", ">1e-6 after (s)", ">1e-3 after (s)", ">0.1 after (s)", ">largest gap"];
    let coordinates =
        comparison.scene.system.coordinates.iter().map(|c| format!(">largest in {} ({})", c.name, c.unit));
    let columns = columns.into_iter().chain([">errors, both"]).map(String::from).chain(coordinates);
    let mut table = Table::new(columns);
    for pair in pairs {
        let passes = pair.gap.passes.map(|t| or_dash(t.map(|t| pair.gap.after(t))));
        let verdict = match &pair.gap.verdict {
            Verdict::Same => "same".to_string(),
            Verdict::Different if pair.gap.certain_from.is_none() => {
                format!("**different**: proved; {}", unseen(&pair.gap))
            }
            Verdict::Different => "**different**".to_string(),
            Verdict::Undecided { because } => format!("undecided: {because}"),
        };
        let gap = if for_page { largest(&pair.gap) } else { short(pair.gap.largest) };
        let sizes = [gap, short(pair.gap.estimates[0] + pair.gap.estimates[1])];
        let by_coordinate = pair.gap.largest_by_coordinate.iter().map(|d| short(*d));
        let cells = [names(comparison, pair), verdict].into_iter().chain(passes).chain(sizes);
        table.cells(cells.chain(by_coordinate));
    }
    table
}

fn names(comparison: &Comparison, pair: &Pair) -> String {
    format!("{} – {}", comparison.runs[pair.first].choice.label, comparison.runs[pair.second].choice.label)
}

/// How gaps start: measured, and predicted where a prediction exists. Empty where nothing could be fitted.
pub(crate) fn growth(comparison: &Comparison) -> Table {
    let columns = ["pair", ">exponent", ">leading coefficient", ">fitted from (s)", ">to (s)", ">predicted exponent"];
    let mut table = Table::new(columns.into_iter().chain([">predicted coefficient", ">off by (%)", "proved"]));
    for pair in &comparison.pairs {
        let Some(growth) = &pair.growth else { continue };
        let predicted = match &pair.predicted {
            None => ["–"; 4].map(String::from),
            Some(p) => {
                let off = short(100.0 * growth.deviation_from(p));
                [p.exponent.to_string(), precise(p.length), off, if p.proved { "yes" } else { "no" }.into()]
            }
        };
        let measured =
            [format!("{:.3}", growth.exponent), precise(growth.length), short(growth.from), short(growth.to)];
        table.cells([names(comparison, pair)].into_iter().chain(measured).chain(predicted));
    }
    table
}

/// What free constants that a search has found leave of a gap.
pub(crate) fn fits(comparison: &Comparison) -> Table {
    let columns = ["motion", "fitted to", "by", ">starting guesses", "free constants", ">largest gap before"];
    let mut table =
        Table::new(columns.into_iter().chain(["largest gap, best found", "half of the guesses", "verdict after"]));
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
        let how = if fit.by_identity { "identity" } else { "search" };
        let starts = fit.fitted.as_ref().filter(|_| !fit.by_identity).map_or(String::new(), |f| f.starts.to_string());
        let before = or_dash(before);
        table.row(&[&label(fit.run), &label(fit.target), &how, &starts, &constants, &before, &left, &half, &verdict]);
    }
    table
}

/// How far each motion left the constraint, and the drift of what should be constant.
pub(crate) fn invariants(comparison: &mut Comparison) -> Result<[Table; 2]> {
    let mut metric = motion::Metric::new(&comparison.scene.system)?;
    let mut residuals = Table::new(["motion", ">to (s)", ">largest constraint residual", ">largest projection"]);
    let mut constant = Table::new(["motion", "constant by theory", ">start", ">largest deviation"]);
    for run in &mut comparison.runs {
        let Ok(motion) = &mut run.outcome else { continue };
        let mut residual = 0.0_f64;
        // near a singularity everything is large; a motion that stops there is judged by what came before
        let part = if motion.is_complete() { 1.0 } else { BEFORE_THE_END };
        let until = motion.start() + part * (motion.end() - motion.start());
        let times: Vec<f64> = motion.grid(SAMPLES).into_iter().filter(|&t| t <= until).collect();
        for &t in &times {
            let now = motion.at(t)?;
            residual = residual.max(metric.constraint_residual(t, &now.coordinates, &now.velocities));
        }
        for (name, start, drift) in motion.invariant_drift(&times)? {
            constant.row(&[&run.choice.label, &name, &precise(start), &short(drift)]);
        }
        let projection =
            if motion.projection.projections == 0 { "–".into() } else { short(motion.projection.largest) };
        residuals.row(&[&run.choice.label, &short(until), &short(residual), &projection]);
    }
    Ok([residuals, constant])
}
