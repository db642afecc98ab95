//! `evidence stability`.

use std::time::Instant;

use anyhow::{Result, bail};
use serde_json::json;

use crate::cli::StabilityArguments;
use program::Answer;
use validation::report::StabilityReport;
use validation::stability::{CASES, LONG_RUNS};

/// Runs the stiff and extreme cases.
pub(crate) fn run(arguments: &StabilityArguments, quiet: bool) -> Result<Answer> {
    let known: Vec<&str> = CASES.iter().map(|case| case.name).chain([LONG_RUNS]).collect();
    if let Some(unknown) = arguments.cases.iter().find(|name| !known.contains(&name.as_str())) {
        bail!("unknown case `{unknown}`; known: {}", known.join(", "));
    }
    let chosen = |name: &str| arguments.cases.is_empty() || arguments.cases.iter().any(|asked| asked == name);
    let clock = Instant::now();
    let report = StabilityReport::new(chosen, quiet)?;
    let (answers, seconds) = (report.answers(), clock.elapsed().as_secs_f64());
    let text = || report.text() + &format!("\n{answers} cells, {seconds:.1} s\n");
    let text = arguments.output.answer("stability", || report.files(), text, || json!({ "cells": report.json() }))?;
    Ok(Answer { text, complaint: report.complaint(), ..Answer::default() })
}
