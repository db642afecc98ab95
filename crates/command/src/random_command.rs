//! `deltaq random`.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use serde_json::json;

use crate::cli::{RandomArguments, TextOrJson};
use crate::solve_command::Answer;
use random::{Batch, Count, Kind, Record, Summary, milliseconds, theorem_title};
use validation::report::{File, write_all};

/// Counterexamples that are shrunk and written; more failures than these have the same causes.
const COUNTEREXAMPLES: usize = 5;

/// Puts random systems to the test.
///
/// # Errors
/// Where the log or a scene file cannot be read or written.
pub fn run(arguments: &RandomArguments) -> Result<Answer> {
    let kinds = arguments.kind.map_or(Kind::ALL.to_vec(), |kind| vec![kind]);
    let batch = Batch { seed: arguments.seed, kinds };
    match arguments.index {
        Some(index) => one(&batch, index, arguments),
        None => many(&batch, arguments),
    }
}

fn many(batch: &Batch, arguments: &RandomArguments) -> Result<Answer> {
    let clock = Instant::now();
    let records = batch.run(arguments.count, arguments.log.as_deref(), arguments.quiet)?;
    let seconds = clock.elapsed().as_secs_f64();
    let summary = Summary::of(&records);
    let files = match &arguments.out {
        Some(folder) => write_counterexamples(batch, &records, folder)?,
        None => Vec::new(),
    };
    let open: Vec<&Record> = records.iter().filter(|record| !record.open.is_empty()).collect();
    let text = match arguments.format {
        TextOrJson::Json => {
            let value = json!({ "batch": batch, "summary": summary, "open": open, "counterexamples": files });
            serde_json::to_string_pretty(&value)? + "\n"
        }
        TextOrJson::Text => {
            let mut text = tables(&summary);
            for record in &open {
                text += &opened(&batch.name(record.index), record);
            }
            let rate = records.len() as f64 / seconds;
            let _ = writeln!(text, "\n{} systems in {seconds:.1} s, {rate:.0} a second", records.len());
            text += &work(&records);
            for file in &files {
                let _ = writeln!(text, "counterexample: {file}");
            }
            text
        }
    };
    Ok(Answer { text, complaint: complaint(summary.total()) })
}

/// Where the time went.
fn work(records: &[Record]) -> String {
    let (motions, checks) = milliseconds(records);
    let checks: Vec<String> = checks.iter().map(|(theorem, ms)| format!("{} {ms:.1}", label(*theorem))).collect();
    format!(
        "milliseconds of one processor a system: motions of all formulations {motions:.1}; checks {}\n",
        checks.join(", ")
    )
}

fn one(batch: &Batch, index: u64, arguments: &RandomArguments) -> Result<Answer> {
    let record = batch.record(index);
    let scene = batch.scene(index);
    if let Some(folder) = &arguments.out {
        write_all(folder, &[File { path: format!("{}.toml", scene.name).into(), text: scene.to_toml() }])?;
    }
    let summary = Summary::of(std::slice::from_ref(&record));
    let text = match arguments.format {
        TextOrJson::Json => {
            serde_json::to_string_pretty(&json!({ "batch": batch, "record": record, "scene": scene.to_toml() }))? + "\n"
        }
        TextOrJson::Text => {
            let mut text = format!("{}: {}\n\n{}\n", scene.name, scene.title, scene.to_toml());
            for (theorem, claim, times) in &record.held {
                let _ = writeln!(text, "{:<4} holds {times} times  {claim}", label(*theorem));
            }
            text + &opened(&scene.name, &record)
        }
    };
    Ok(Answer { text, complaint: complaint(summary.total()) })
}

fn complaint(total: Count) -> Option<String> {
    (total.fails > 0).then(|| format!("{} of {} verdicts on theorems: a claim fails", total.fails, total.total()))
}

/// `T5`; what must hold within each formulation has no theorem.
fn label(theorem: u8) -> String {
    if theorem == 0 { "-".into() } else { format!("T{theorem}") }
}

/// Verdicts by theorem.
fn tables(summary: &Summary) -> String {
    let mut text = format!("{:<5}{:>8}{:>7}{:>11}\n", "", "holds", "fails", "undecided");
    for (theorem, Count { holds, fails, undecided }) in &summary.theorems {
        let title = theorem_title(*theorem);
        let _ = writeln!(text, "{:<5}{holds:>8}{fails:>7}{undecided:>11}   {title}", label(*theorem));
    }
    text
}

/// Claims that do not hold on one system.
fn opened(name: &str, record: &Record) -> String {
    let mut text = String::new();
    for open in &record.open {
        let figure = open.figure.map_or(String::new(), |(figure, limit)| format!(" {figure:.2e} (limit {limit:.2e})"));
        let theorem = label(open.theorem);
        let _ =
            writeln!(text, "{name}, {}: {theorem} {}: {}{figure} {}", record.kind, open.claim, open.word, open.note);
    }
    text
}

/// Shrinks and writes the first failures; their paths.
fn write_counterexamples(batch: &Batch, records: &[Record], folder: &Path) -> Result<Vec<String>> {
    let failures = records.iter().flat_map(|record| record.failures().into_iter().map(|t| (record.index, t)));
    let mut written = Vec::new();
    for (index, theorem) in failures.take(COUNTEREXAMPLES) {
        if let Some(scene) = batch.counterexample(index, theorem) {
            let path = format!("{}.toml", scene.name);
            write_all(folder, &[File { path: path.clone().into(), text: scene.to_toml() }])?;
            written.push(folder.join(path).display().to_string());
        }
    }
    Ok(written)
}
