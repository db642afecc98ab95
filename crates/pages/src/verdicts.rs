//! The verdicts for machines. Nothing in them depends on the machine's speed.

use comparison::words::at_most;
use comparison::{Comparison, FittedMotion, Gap};
use indexmap::IndexMap;
use motion::TRUSTED;
use motion::{Ending, Motion, SolveError};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::membership::Decision;

/// Verdicts on scenes: `deltaq compare --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "compare/2")]
pub struct Verdicts {
    /// Gaps whose first times are told.
    pub thresholds: [f64; 3],
    /// By name.
    pub scenes: IndexMap<String, SceneVerdicts>,
}

/// Verdicts on a scene.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "scene")]
pub struct SceneVerdicts {
    integrability: String,
    /// By label: the end, or where and why it stopped, or why it was refused.
    runs: IndexMap<String, Run>,
    pairs: Vec<Pair>,
    /// Is the motion one of the family, for some constants?
    decided: Vec<Decided>,
    fits: Vec<Fit>,
    /// Results that exclude each other: none, unless the program is wrong; compare only.
    #[serde(skip_serializing_if = "Option::is_none")]
    contradictions: Option<Vec<String>>,
}

#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
enum Run {
    Refused { refused: String },
    Completed { end: f64 },
    Stopped { stopped: f64, cause: String },
}

#[derive(Serialize, JsonSchema)]
struct Pair {
    first: String,
    second: String,
    #[schemars(extend("enum" = ["same", "different", "undecided"]))]
    verdict: &'static str,
    /// Whether it is proved that the motions differ.
    proved: bool,
    /// Times at which the gap passes the thresholds, s.
    passes: [Option<f64>; 3],
    #[serde(flatten)]
    numbers: Option<Numbers>,
}

/// Compare only.
#[derive(Serialize, JsonSchema)]
struct Numbers {
    /// Largest gap, kinetic metric; compare only.
    #[schemars(with = "Option<f64>")]
    largest: f64,
    /// Error estimates of the two motions; compare only.
    #[schemars(with = "[Option<f64>; 2]")]
    estimates: [f64; 2],
}

#[derive(Serialize, JsonSchema)]
struct Decided {
    #[serde(flatten)]
    decision: Decision,
    family: String,
    motion: String,
}

#[derive(Serialize, JsonSchema)]
struct Fit {
    run: String,
    target: String,
    #[schemars(extend("enum" = ["same", "different", "undecided", null]))]
    verdict: Option<&'static str>,
    #[serde(rename = "by identity")]
    by_identity: bool,
    #[serde(flatten)]
    numbers: Option<FitNumbers>,
}

#[derive(Serialize, JsonSchema)]
struct FitNumbers {
    /// By name; compare only.
    #[schemars(with = "IndexMap<String, Option<f64>>")]
    constants: IndexMap<String, f64>,
    /// Largest gap that is left, kinetic metric, the least that was found; to one digit, rounded up, if not
    /// settled; compare only.
    #[schemars(with = "Option<f64>")]
    largest: f64,
    /// The same from the first half of the starts; compare only.
    #[serde(rename = "by half")]
    #[schemars(with = "Option<f64>")]
    by_half: f64,
    /// Whether both are the same to 1 %; compare only.
    settled: bool,
    /// Values of the constants from which the largest gap was made smaller, 0 for an identity; compare only.
    starts: usize,
}

/// All verdicts of all scenes; with their numbers, which depend on the machine in their last digits, if
/// wanted.
pub fn verdicts(comparisons: &[Comparison], with_numbers: bool) -> Verdicts {
    let scenes = comparisons.iter().map(|c| (c.scene.name.clone(), scene(c, with_numbers)));
    Verdicts { thresholds: comparison::THRESHOLDS, scenes: scenes.collect() }
}

fn scene(comparison: &Comparison, with_numbers: bool) -> SceneVerdicts {
    let label = |i: usize| comparison.runs[i].choice.label.clone();
    let run = |outcome: &Result<Motion, SolveError>| match outcome {
        Err(error) => Run::Refused { refused: error.to_string() },
        Ok(motion) => match &motion.ending {
            Ending::Completed => Run::Completed { end: motion.end() },
            Ending::Stopped { t, cause } => Run::Stopped { stopped: rounded(*t), cause: cause.clone() },
        },
    };
    let numbers = |gap: &Gap| Numbers { largest: gap.largest, estimates: gap.estimates };
    let pair = |pair: &comparison::Pair| Pair {
        first: label(pair.first),
        second: label(pair.second),
        verdict: pair.gap.verdict.word(),
        proved: pair.gap.proved,
        passes: pair.gap.passes.map(|t| t.map(rounded)),
        numbers: with_numbers.then(|| numbers(&pair.gap)),
    };
    let decided = |decided: &comparison::Decided| Decided {
        decision: Decision::of(&decided.outcome),
        family: label(decided.family),
        motion: label(decided.curve),
    };
    let fit_numbers = |fitted: &FittedMotion| {
        let told = |gap: f64| if fitted.is_settled() { gap } else { at_most(gap) };
        FitNumbers {
            constants: fitted.constants.iter().cloned().collect(),
            largest: told(fitted.gap.largest),
            by_half: told(fitted.by_half),
            settled: fitted.is_settled(),
            starts: fitted.starts,
        }
    };
    let fit = |fit: &comparison::Fit| Fit {
        run: label(fit.run),
        target: label(fit.target),
        verdict: fit.fitted.as_ref().map(|fitted| fitted.gap.verdict.word()),
        by_identity: fit.by_identity,
        numbers: fit.fitted.as_ref().filter(|_| with_numbers).map(fit_numbers),
    };
    let contradictions = || comparison.contradictions().iter().map(ToString::to_string).collect();
    SceneVerdicts {
        integrability: comparison.integrability.to_string(),
        runs: comparison.runs.iter().map(|own| (own.choice.label.clone(), run(&own.outcome))).collect(),
        pairs: comparison.pairs.iter().map(pair).collect(),
        decided: comparison.decided.iter().map(decided).collect(),
        fits: comparison.fits.iter().map(fit).collect(),
        contradictions: with_numbers.then(contradictions),
    }
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
            ((a - b).abs() > TRUSTED * a.abs().max(b.abs())).then(|| format!("{path}: {a}, now {b}"))
        }
        // the numbers in a cause are those of the last step, and differ from machine to machine
        (Value::String(a), Value::String(b)) if path.ends_with("/cause") => {
            let words = |text: &str| text.replace(|c: char| c.is_ascii_digit() || c == '.' || c == '-', "");
            (words(a) != words(b)).then(|| format!("{path}: {a}, now {b}"))
        }
        _ => (old != new).then(|| format!("{path}: {old}, now {new}")),
    }
}
