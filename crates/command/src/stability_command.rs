//! `deltaq stability`.

use std::fmt::Write;
use std::time::Instant;

use anyhow::{Result, bail};
use serde_json::{Value, json};

use crate::cli::{StabilityArguments, TextOrJson};
use crate::solve_command::Answer;
use validation::stability::{CASES, Case, Cell, LongRun, Verdict, long_runs, run as answer};

/// Name of the runs of a million steps.
const LONG_RUNS: &str = "million-steps";

/// Runs the stiff and extreme cases.
///
/// # Errors
/// Where a case is unknown, or a reference cannot be had.
pub fn run(arguments: &StabilityArguments) -> Result<Answer> {
    let known: Vec<&str> = CASES.iter().map(|case| case.name).chain([LONG_RUNS]).collect();
    if let Some(unknown) = arguments.cases.iter().find(|name| !known.contains(&name.as_str())) {
        bail!("unknown case `{unknown}`; known: {}", known.join(", "));
    }
    let chosen = |name: &str| arguments.cases.is_empty() || arguments.cases.iter().any(|asked| asked == name);
    let cases: Vec<&Case> = CASES.iter().filter(|case| chosen(case.name)).collect();
    let clock = Instant::now();
    let cells = answer(&cases, arguments.quiet)?;
    let runs = if chosen(LONG_RUNS) { long_runs(arguments.quiet)? } else { Vec::new() };
    let verdicts = cells.iter().map(|cell| &cell.verdict).chain(runs.iter().map(|run| &run.verdict));
    let wrong = verdicts.filter(|verdict| matches!(verdict, Verdict::Wrong { .. })).count();
    let answers = cells.len() + runs.len();
    let text = match arguments.format {
        TextOrJson::Json => {
            let values: Vec<Value> = cells.iter().map(json_of).chain(runs.iter().map(json_of_run)).collect();
            serde_json::to_string_pretty(&values)? + "\n"
        }
        TextOrJson::Text => {
            let seconds = clock.elapsed().as_secs_f64();
            table(&cells) + &table_of_runs(&runs) + &format!("\n{answers} cells, {seconds:.1} s\n")
        }
    };
    let complaint = (wrong > 0).then(|| format!("{wrong} of {answers} cells are wrong"));
    Ok(Answer { text, complaint })
}

fn json_of(cell: &Cell) -> Value {
    let mut value = json!({
        "case": cell.case,
        "point": cell.point,
        "formulation": cell.formulation,
        "method": cell.method.name(),
        "verdict": cell.verdict.word(),
        "steps": cell.steps,
    });
    write_verdict(&mut value, &cell.verdict);
    value
}

fn json_of_run(run: &LongRun) -> Value {
    let mut value = json!({
        "case": LONG_RUNS,
        "scene": run.scene,
        "duration": run.duration,
        "formulation": run.formulation,
        "method": run.stepping.name(),
        "verdict": run.verdict.word(),
        "by_place": run.by_place,
        "steps": run.steps,
        "energy": run.energy,
        "trend": run.trend,
        "constraint": run.constraint,
    });
    write_verdict(&mut value, &run.verdict);
    value
}

fn write_verdict(value: &mut Value, verdict: &Verdict) {
    match verdict {
        Verdict::Accurate { error, estimate } | Verdict::Admitted { error, estimate } => {
            (value["error"], value["estimate"]) = (json!(error), json!(estimate));
        }
        Verdict::Refused { t, cause } => (value["t"], value["cause"]) = (json!(t), json!(cause)),
        Verdict::Wrong { error, estimate, t } => {
            (value["error"], value["estimate"], value["t"]) = (json!(error), json!(estimate), json!(t));
        }
    }
}

fn table(cells: &[Cell]) -> String {
    let mut text = String::new();
    for cell in cells {
        let _ = writeln!(
            text,
            "{:<15} {:>9.2e} {:<24} {:<9} {:<9}{}",
            cell.case,
            cell.point,
            cell.formulation,
            cell.method.name(),
            cell.verdict.word(),
            figures(&cell.verdict)
        );
    }
    text
}

fn table_of_runs(runs: &[LongRun]) -> String {
    let mut text = String::new();
    for run in runs {
        let _ = writeln!(
            text,
            "{:<15} {:>9.2e} {:<24} {:<9} {:<9}{}; {} steps, energy {:.1e}, its trend {:.1e}, constraint {:.1e}",
            run.scene,
            run.duration,
            run.formulation,
            run.stepping.name(),
            run.verdict.word(),
            figures(&run.verdict),
            run.steps,
            run.energy,
            run.trend,
            run.constraint
        );
    }
    text
}

fn figures(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Accurate { error, estimate } | Verdict::Admitted { error, estimate } => {
            format!("error {error:.1e}, estimate {estimate:.1e}")
        }
        Verdict::Refused { t: None, cause } => cause.clone(),
        Verdict::Refused { t: Some(t), cause } => format!("at t = {t:.6e}: {cause}"),
        Verdict::Wrong { error, estimate, t } => format!("at t = {t:.3e}: error {error:.1e}, estimate {estimate:.1e}"),
    }
}
