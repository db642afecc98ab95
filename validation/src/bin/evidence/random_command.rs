//! `evidence random`.

use std::fmt::Write;
use std::time::Instant;

use anyhow::Result;
use scene::Scene;
use serde_json::json;

use crate::cli::RandomArguments;
use program::Answer;
use program::File;
use random::{Batch, Count, Kind, Record, Summary, milliseconds, theorem_title};
use validation::report::random_complaint;

/// Puts random systems to the test.
pub(crate) fn run(arguments: &RandomArguments, quiet: bool) -> Result<Answer> {
    if !arguments.merge.is_empty() {
        let (batch, records) = Batch::merged(&arguments.merge)?;
        return told(&batch, &records, None, arguments);
    }
    let kinds = arguments.kind.map_or(Kind::ALL.to_vec(), |kind| vec![kind]);
    let batch = Batch { seed: arguments.seed, kinds };
    match arguments.index {
        Some(index) => one(&batch, index, arguments),
        None => many(&batch, arguments, quiet),
    }
}

fn many(batch: &Batch, arguments: &RandomArguments, quiet: bool) -> Result<Answer> {
    let clock = Instant::now();
    let indices = arguments.from..arguments.from + arguments.count;
    let records = batch.run(indices, arguments.log.as_deref(), quiet)?;
    told(batch, &records, Some(clock.elapsed().as_secs_f64()), arguments)
}

/// What was found on these systems, and in how many seconds if they were put to the test now.
fn told(batch: &Batch, records: &[Record], seconds: Option<f64>, arguments: &RandomArguments) -> Result<Answer> {
    let summary = Summary::of(records);
    let folder = arguments.output.out.as_deref();
    let shrunk = folder.map_or(Vec::new(), |_| batch.counterexamples(records));
    let files: Vec<File> = shrunk.iter().map(|(_, scene)| file(scene)).collect();
    let paths: Vec<String> =
        files.iter().filter_map(|file| Some(folder?.join(&file.path).display().to_string())).collect();
    let open: Vec<&Record> = records.iter().filter(|record| !record.open.is_empty()).collect();
    let text = || {
        let mut text = tables(&summary);
        for record in &open {
            text += &opened(&batch.name(record.index), record);
        }
        let rate = |seconds: f64| format!(" in {seconds:.1} s, {:.0} per second", records.len() as f64 / seconds);
        let _ = writeln!(text, "\n{} systems{}", records.len(), seconds.map_or(String::new(), rate));
        let features: Vec<String> = summary.features.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let _ = writeln!(text, "they have {}", comparison::words::enumerate(&features));
        let (at_stake, all) = (summary.total_at_stake(), summary.total().total());
        let _ = writeln!(text, "{at_stake} of {all} verdicts are on systems on which formulations differ");
        text += &work(records);
        for path in &paths {
            let _ = writeln!(text, "counterexample: {path}");
        }
        text
    };
    let json = || json!({ "batch": batch, "summary": summary, "open": open, "counterexamples": paths });
    let text = arguments.output.answer("random", || Ok(files), text, json)?;
    Ok(Answer { text, complaint: random_complaint(summary.total()), ..Answer::default() })
}

/// Where the time went.
fn work(records: &[Record]) -> String {
    let (motions, checks) = milliseconds(records);
    let checks: Vec<String> = checks.iter().map(|(theorem, ms)| format!("{} {ms:.1}", label(*theorem))).collect();
    format!(
        "milliseconds of one processor per system: motions of all formulations {motions:.1}; checks {}\n",
        checks.join(", ")
    )
}

fn one(batch: &Batch, index: u64, arguments: &RandomArguments) -> Result<Answer> {
    let record = batch.record(index);
    let scene = batch.scene(index);
    let summary = Summary::of(std::slice::from_ref(&record));
    let text = || {
        let mut text = format!("{}: {}\n\n{}\n", scene.name, scene.title, scene.to_toml());
        for (theorem, claim, times) in &record.held {
            let _ = writeln!(text, "{:<4} holds {times} times  {claim}", label(*theorem));
        }
        text + &opened(&scene.name, &record)
    };
    let json = || json!({ "batch": batch, "record": record, "scene": scene.to_toml() });
    let text = arguments.output.answer("random-system", || Ok(vec![file(&scene)]), text, json)?;
    Ok(Answer { text, complaint: random_complaint(summary.total()), ..Answer::default() })
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

fn file(scene: &Scene) -> File {
    File { path: format!("{}.toml", scene.name).into(), text: scene.to_toml() }
}
