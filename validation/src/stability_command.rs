//! `deltaq stability`.

use std::fmt::Write;
use std::time::Instant;

use anyhow::{Result, bail};
use serde_json::{Value, json};

use crate::cli::{StabilityArguments, TextOrJson};
use crate::solve_command::Answer;
use crate::stability::{CASES, Case, Cell, Verdict, run as answer};

/// Runs the stiff and extreme cases.
///
/// # Errors
/// Where a case is unknown, or a reference cannot be had.
pub fn run(arguments: &StabilityArguments) -> Result<Answer> {
    let known: Vec<&str> = CASES.iter().map(|case| case.name).collect();
    if let Some(unknown) = arguments.cases.iter().find(|name| !known.contains(&name.as_str())) {
        bail!("unknown case `{unknown}`; known: {}", known.join(", "));
    }
    let chosen = |case: &&Case| arguments.cases.is_empty() || arguments.cases.iter().any(|name| name == case.name);
    let cases: Vec<&Case> = CASES.iter().filter(chosen).collect();
    let clock = Instant::now();
    let cells = answer(&cases, arguments.quiet)?;
    let wrong = cells.iter().filter(|cell| matches!(cell.verdict, Verdict::Wrong { .. })).count();
    let text = match arguments.format {
        TextOrJson::Json => serde_json::to_string_pretty(&cells.iter().map(json_of).collect::<Vec<_>>())? + "\n",
        TextOrJson::Text => {
            table(&cells) + &format!("\n{} cells, {:.1} s\n", cells.len(), clock.elapsed().as_secs_f64())
        }
    };
    let complaint = (wrong > 0).then(|| format!("{wrong} of {} cells are wrong", cells.len()));
    Ok(Answer { text, complaint })
}

fn json_of(cell: &Cell) -> Value {
    let mut value = json!({
        "case": cell.case,
        "point": cell.point,
        "formulation": cell.formulation,
        "method": format!("{:?}", cell.method),
        "verdict": cell.verdict.word(),
        "steps": cell.steps,
    });
    match &cell.verdict {
        Verdict::Accurate { error, estimate } | Verdict::Admitted { error, estimate } => {
            (value["error"], value["estimate"]) = (json!(error), json!(estimate));
        }
        Verdict::Refused { t, cause } => (value["t"], value["cause"]) = (json!(t), json!(cause)),
        Verdict::Wrong { error, estimate, t } => {
            (value["error"], value["estimate"], value["t"]) = (json!(error), json!(estimate), json!(t));
        }
    }
    value
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
            format!("{:?}", cell.method),
            cell.verdict.word(),
            figures(&cell.verdict)
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
