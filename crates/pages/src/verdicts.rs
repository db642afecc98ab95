//! The verdicts for machines. Nothing in them depends on the machine's speed.

use comparison::Comparison;
use motion::Ending;
use serde_json::{Map, Value, json};

use crate::membership;

/// Relative difference in a time that two runs may have.
const SAME_TIME: f64 = 1e-3;

/// All verdicts of all scenes.
pub fn verdicts(comparisons: &[Comparison]) -> Value {
    let scenes: Map<String, Value> = comparisons.iter().map(|c| (c.scene.name.clone(), scene(c))).collect();
    json!({ "thresholds": comparison::THRESHOLDS, "scenes": scenes })
}

fn scene(comparison: &Comparison) -> Value {
    let label = |i: usize| comparison.runs[i].choice.label.clone();
    let runs: Map<String, Value> = comparison
        .runs
        .iter()
        .map(|run| {
            let value = match &run.outcome {
                Err(error) => json!({ "refused": error.to_string() }),
                Ok(motion) => match &motion.ending {
                    Ending::Completed => json!({ "end": motion.end() }),
                    Ending::Stopped { t, cause } => json!({ "stopped": rounded(*t), "cause": cause }),
                },
            };
            (run.choice.label.clone(), value)
        })
        .collect();
    let pairs: Vec<Value> = comparison
        .pairs
        .iter()
        .map(|p| {
            json!({
                "first": label(p.first),
                "second": label(p.second),
                "verdict": p.gap.verdict.word(),
                "proved": p.gap.proved,
                "passes": p.gap.passes.map(|t| t.map(rounded)),
            })
        })
        .collect();
    let fits: Vec<Value> = comparison
        .fits
        .iter()
        .map(|f| {
            let verdict = f.fitted.as_ref().map(|m| m.gap.verdict.word());
            json!({ "run": label(f.run), "target": label(f.target), "verdict": verdict, "by identity": f.by_identity })
        })
        .collect();
    json!({
        "integrability": comparison.integrability.to_string(),
        "runs": runs,
        "pairs": pairs,
        "decided": membership::values(comparison),
        "fits": fits,
    })
}

/// Four significant digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// The first difference of two sets of verdicts: its path and both values. Numbers may differ a little.
pub fn difference_of_verdicts(old: &Value, new: &Value) -> Option<String> {
    differ("", old, new)
}

fn differ(path: &str, old: &Value, new: &Value) -> Option<String> {
    match (old, new) {
        (Value::Object(a), Value::Object(b)) => {
            let missing = a.keys().find(|k| !b.contains_key(*k)).map(|k| format!("{path}/{k}: gone"));
            let added = || b.keys().find(|k| !a.contains_key(*k)).map(|k| format!("{path}/{k}: new"));
            missing.or_else(added).or_else(|| a.iter().find_map(|(k, v)| differ(&format!("{path}/{k}"), v, &b[k])))
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            (0..a.len()).find_map(|i| differ(&format!("{path}/{i}"), &a[i], &b[i]))
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64()?, b.as_f64()?);
            ((a - b).abs() > SAME_TIME * a.abs().max(b.abs())).then(|| format!("{path}: {a}, now {b}"))
        }
        // the numbers in a cause are those of the last step, and differ from machine to machine
        (Value::String(a), Value::String(b)) if path.ends_with("/cause") => {
            let words = |text: &str| text.replace(|c: char| c.is_ascii_digit() || c == '.' || c == '-', "");
            (words(a) != words(b)).then(|| format!("{path}: {a}, now {b}"))
        }
        _ => (old != new).then(|| format!("{path}: {old}, now {new}")),
    }
}
