//! The referee's findings for readers and machines: bounds are powers of ten, so the last digit changes none.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::{Outcome, Row, Word};
use pages::Table;

/// `< 1e-12`: the smallest power of ten above the difference, and no less than a tenth of the tolerance;
/// where a note says that this is what the referee is unsure by, the tolerance: the rest is of a machine.
fn bound(row: &Row) -> String {
    let allowed = row.tolerance.log10().round() as i32;
    let least = if row.who == "IDAS" && !row.note.is_empty() { allowed } else { allowed - 1 };
    match row.largest {
        None => "–".into(),
        Some(0.0) => "0".into(),
        Some(x) => format!("< 1e{:+03}", (x.log10().floor() as i32 + 1).max(least)),
    }
}

fn word(verdict: Word) -> &'static str {
    match verdict {
        Word::Agrees => "agrees",
        Word::Disagrees => "disagrees",
        Word::Failed => "failed",
    }
}

/// Comparisons as a table.
pub fn referee_table(rows: &[Row]) -> Table {
    let columns = ["scene", "who", "what was compared", ">how many", "largest relative difference"];
    let columns = columns.into_iter().chain([">tolerance", "verdict", "note"]);
    let mut table = Table::new(columns);
    for row in rows {
        let (tolerance, verdict) = (format!("{:.0e}", row.tolerance), word(row.verdict));
        table.row(&[&row.scene, &row.who, &row.what, &row.count, &bound(row), &tolerance, &verdict, &row.note]);
    }
    table
}

/// One sentence about everything.
pub fn headline(outcome: &Outcome) -> String {
    let rows = match outcome {
        Outcome::NotRun(reason) => return format!("not run: {reason}"),
        Outcome::Ran(rows) => rows,
    };
    let agree = rows.iter().filter(|row| row.verdict == Word::Agrees).count();
    let mut text = format!("{agree} of {} comparisons agree", rows.len());
    if let Some(first) = rows.iter().find(|row| row.verdict != Word::Agrees) {
        let _ = write!(text, "; {} {} {}: {}", first.scene, first.who, first.what, word(first.verdict));
    }
    text
}

/// Verdict words by scene, for `verdicts.json`; `None` where the referee did not run.
pub fn verdict_words(outcome: &Outcome) -> Option<Value> {
    let Outcome::Ran(rows) = outcome else { return None };
    let mut scenes: Map<String, Value> = Map::new();
    for row in rows {
        let entry = scenes.entry(row.scene.clone()).or_insert_with(|| json!({}));
        entry[format!("{}: {}", row.who, row.what)] = word(row.verdict).into();
    }
    Some(Value::Object(scenes))
}
