//! `deltaq judge`: which law does a program integrate that made these motions?

use std::fmt::Write;

use anyhow::{Context, Result, bail};
use indexmap::IndexMap;
use judge::{Judgement, Law, Number, Order, Residual, Samples, judge, order};
use program::{Answer, TextOrJson, typed};
use scene::table_text;
use schemars::JsonSchema;
use serde::Serialize;

use crate::cli::JudgeArguments;

/// Judges every table.
///
/// # Errors
/// A scene or table that cannot be read, with its place, and one that cannot be judged.
pub fn run(arguments: &JudgeArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let (files, given) = (&arguments.motions, &arguments.steps);
    if !given.is_empty() && given.len() != files.len() {
        bail!("--steps: {} steps are given for {} tables", given.len(), files.len());
    }
    if let Some(step) = given.iter().find(|step| !(step.is_finite() && **step > 0.0)) {
        bail!("--steps: {step} is not a positive number");
    }
    if !(arguments.tolerance > 0.0 && arguments.tolerance <= 1.0) {
        bail!("--tolerance: {} is not between 0 and 1", arguments.tolerance);
    }
    let (mut motions, mut judgements) = (Vec::new(), Vec::new());
    for file in files {
        let (name, text) = (file.display().to_string(), table_text(file)?);
        let samples = Samples::read(&scene.system, &name, &text)?;
        drop(text);
        let judgement = judge(&scene, &samples, arguments.tolerance).with_context(|| name.clone())?;
        judgements.push((name, judgement));
        motions.push(samples);
    }
    let steps = if given.is_empty() { motions.iter().map(Samples::step).collect() } else { given.clone() };
    let order = order(&motions, &steps);
    let none: Vec<&str> = judgements.iter().filter(|(_, j)| j.law().is_none()).map(|(f, _)| f.as_str()).collect();
    let complaint = (!none.is_empty()).then(|| format!("no law fits: {}", none.join(", ")));
    let text = match arguments.format {
        TextOrJson::Text => {
            let mut text: String = judgements.iter().map(|(file, j)| table(file, j)).collect();
            if let Some(o) = order {
                let [a, b] = o.distances;
                let _ = writeln!(text, "order in the step {:.3}: distances {a:.3e}, {b:.3e} at t = {}", o.order, o.t);
            }
            text
        }
        TextOrJson::Json => {
            let motions = judgements.iter().map(|(file, j)| Judged::of(file, j)).collect();
            typed(&AllJudged { scene: &scene.name, motions, order })?
        }
    };
    Ok(Answer { text, complaint, ..Answer::default() })
}

fn numbers(j: &Judgement) -> [(&'static str, &'static str, Option<Number>); 4] {
    [
        ("epsilon", "ε, a time", j.epsilon),
        ("slip", "1/N", j.slip),
        ("drag", "γ of −γ M v", j.drag),
        ("left_out", "part of ḟ − A a left out", j.left_out),
    ]
}

fn table(file: &str, j: &Judgement) -> String {
    let mut text = format!("{file}: {} samples, {:.6e} apart\n", j.samples, j.step);
    let law = match j.fitting.split_first() {
        None => "none of these".to_string(),
        Some((law, [])) => law.name().to_string(),
        Some((law, also)) => {
            let also: Vec<&str> = also.iter().map(|l| l.name()).collect();
            format!("{}; these samples cannot tell it from {}", law.name(), also.join(", "))
        }
    };
    let _ = writeln!(text, "  law: {law}");
    for left in &j.laws {
        let with = if left.with.is_empty() { String::new() } else { format!("  ({})", left.with) };
        let _ = writeln!(text, "  {:<14} leaves {:.3e} of the forces{with}", left.law.name(), left.residual / j.scale);
    }
    let _ = writeln!(text, "  {:<14} {:>13.3e} of the forces", "noise", j.noise / j.scale);
    for (name, what, number) in numbers(j) {
        let _ = match number {
            Some(Number { value, error }) => writeln!(text, "  {name:<14} {value:>13.6e} ± {error:.1e}  ({what})"),
            None => writeln!(text, "  {name:<14} is not a number that this motion shows  ({what})"),
        };
    }
    for misfit in &j.misfits {
        let Number { value, error } = misfit.by;
        let (name, left) = (&misfit.name, misfit.residual / j.scale);
        let _ = match name.starts_with("force") {
            true => writeln!(text, "  misfit: with a {name} of {value:.4e} ± {error:.1e} chetaev leaves {left:.3e}"),
            false => {
                let (part, error) = (1.0 + value, error);
                writeln!(
                    text,
                    "  misfit: with {part:.6} ± {error:.1e} times the scene's {name} chetaev leaves {left:.3e}"
                )
            }
        };
    }
    for (i, Residual { largest, rms, parts }) in j.constraints.iter().enumerate() {
        let _ = writeln!(text, "  f_{:<12} largest {largest:.3e}, rms {rms:.3e}; rms of its parts {parts:.3e}", i + 1);
    }
    for d in &j.drifts {
        let _ = writeln!(text, "  {:<14} {:.6e}, drifts by {:.3e}", d.name, d.start, d.largest);
    }
    text
}

/// Which law a program integrates: `deltaq judge --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "judge/1")]
pub(crate) struct AllJudged<'a> {
    scene: &'a str,
    motions: Vec<Judged<'a>>,
    order: Option<Order>,
}

#[derive(Serialize, JsonSchema)]
struct Judged<'a> {
    file: &'a str,
    /// The first of those that fit; null for none.
    law: Option<Law>,
    /// Null where the motion does not show it.
    numbers: IndexMap<&'static str, Option<Number>>,
    #[serde(flatten)]
    judgement: &'a Judgement,
}

impl<'a> Judged<'a> {
    fn of(file: &'a str, judgement: &'a Judgement) -> Self {
        let numbers = numbers(judgement).into_iter().map(|(name, _, number)| (name, number)).collect();
        Judged { file, law: judgement.law(), numbers, judgement }
    }
}
