//! `deltaq connect`: motions between two points.

use anyhow::Result;
use motion::{Aim, Connection, Connections, SecondVariation, Settings, connect};
use scene::Scene;
use serde_json::{Map, Value, json};

use crate::cli::ConnectArguments;
use crate::solve_command::{choice, limited};
use program::{Answer, TextOrJson, parallel, pretty};

/// Motions that are printed in text; JSON has all.
const PRINTED: usize = 30;

/// Runs the command.
pub(crate) fn run(arguments: &ConnectArguments) -> Result<Answer> {
    let scene = arguments.scene.find()?;
    let settings = Settings { tolerance: arguments.tolerance, ..Settings::default() };
    let settings = limited(settings, &arguments.limits)?;
    let choice = choice(&scene, (arguments.formulation, "auto"), &arguments.free)?;
    let aim = Aim {
        t: arguments.at.unwrap_or(scene.start.t + scene.duration),
        to: arguments.to.iter().map(|(name, value)| (name.clone(), value.value())).collect(),
        starts: arguments.starts as usize,
        threads: parallel::threads(),
    };
    let found = connect(&scene, &choice, &aim, &settings)?;
    let name = choice.formulation.name;
    let complaint = (found.found.is_empty() && found.none.is_none()).then(|| {
        format!("no {name} motion found from {} starts: try more --starts, another --at or a first guess", aim.starts)
    });
    let text = match arguments.format {
        TextOrJson::Text => text(&scene, name, &aim, &found),
        TextOrJson::Json => pretty("connect", &json_of(&scene, name, &aim, &found)),
    };
    Ok(Answer { text, complaint, ..Answer::default() })
}

fn text(scene: &Scene, formulation: &str, aim: &Aim, found: &Connections) -> String {
    let start = scene.system.coordinates.iter().zip(&scene.start.q).map(|(c, q)| format!("{} = {q}", c.name));
    let start: Vec<String> = start.collect();
    let goal: Vec<String> = aim.to.iter().map(|(name, q)| format!("{name} = {q}")).collect();
    let mut text = format!(
        "{}, {formulation}: from {} at t = {} to {} at t = {}\n",
        scene.name,
        start.join(", "),
        scene.start.t,
        goal.join(", "),
        aim.t
    );
    let led = found.found.iter().map(|motion| motion.starts).sum::<usize>();
    text += &format!(
        "{} unknowns ({}); {led} of {} starts led to {} motion{}, the first half to {}; {} runs, {} of them with derivatives\n",
        found.unknowns.len(),
        found.unknowns.join(", "),
        aim.starts,
        found.found.len(),
        if found.found.len() == 1 { "" } else { "s" },
        found.found.iter().filter(|motion| motion.by_half).count(),
        found.runs[0],
        found.runs[1]
    );
    if let Some(none) = &found.none {
        return text + &format!("there is none: {none}\n");
    }
    if found.every_constant {
        text += "the constraints are integrable: every mu0 gives the same motions\n";
    }
    for (reason, starts) in &found.failures {
        text += &format!("{starts} led nowhere: {reason}\n");
    }
    let is_neither = |motion: &Connection| motion.is_minimum == Some(false);
    if !found.found.is_empty() && found.found.iter().all(is_neither) {
        text += "none of them is a local minimum of the action: if there is one, it was not found\n";
    }
    for (motion, number) in found.found.iter().zip(1..).take(PRINTED) {
        text += "\n";
        text += &one(number, motion, found, aim);
    }
    if found.found.len() > PRINTED {
        text += &format!("\n{} more in JSON: --format json\n", found.found.len() - PRINTED);
    }
    text
}

fn one(number: usize, motion: &Connection, found: &Connections, aim: &Aim) -> String {
    let [action, error] = motion.action;
    let starts = if motion.starts == 1 { "1 start".into() } else { format!("{} starts", motion.starts) };
    let mut text = format!("{number}. action {action:.9} (quadrature {error:.0e}), from {starts}: ");
    text += &format!("{}\n", motion.second_variation.words());
    for ((name, x), error) in found.unknowns.iter().zip(&motion.unknowns).zip(&motion.errors) {
        text += &format!("   {name:<8} {x:>18.12}  ± {error:.0e}\n");
    }
    let misses = aim.to.iter().zip(&motion.residuals).map(|((name, _), r)| format!("{name} {r:.0e}"));
    text += &format!("   misses the end by {}\n", misses.collect::<Vec<_>>().join(", "));
    if motion.second_variation == SecondVariation::Abnormal {
        return text;
    }
    if !motion.is_isolated() {
        text += &format!(
            "   not isolated: condition number of the end by the unknowns {:.0e}; it may be one of a family\n",
            motion.condition
        );
    }
    text += &match &motion.conjugate {
        None => "   conjugate times: not determined, the unknowns are dependent at all times\n".into(),
        Some(times) if times.is_empty() => format!("   no conjugate time before t = {}\n", aim.t),
        Some(times) => {
            let each = times.iter().map(|time| {
                let times =
                    if time.multiplicity > 1 { format!(" ({}-fold)", time.multiplicity) } else { String::new() };
                format!("{:.9} ± {:.0e}{times}", time.t, time.error)
            });
            format!("   conjugate times: {}\n", each.collect::<Vec<_>>().join(", "))
        }
    };
    text
}

fn json_of(scene: &Scene, formulation: &str, aim: &Aim, found: &Connections) -> Value {
    let named = |values: &[f64]| -> Map<String, Value> {
        found.unknowns.iter().cloned().zip(values.iter().map(|&x| finite(x))).collect()
    };
    let to = |values: &mut dyn Iterator<Item = f64>| -> Map<String, Value> {
        aim.to.iter().map(|(name, _)| name.clone()).zip(values.map(|x| json!(x))).collect()
    };
    let motion = |motion: &Connection| {
        let velocities = scene.system.coordinates.iter().map(|c| format!("{}'", c.name));
        let velocities: Map<String, Value> = velocities.zip(motion.start.v.iter().map(|&v| json!(v))).collect();
        let times = motion.conjugate.as_ref().map(|times| {
            let each = times.iter();
            each.map(|time| json!({ "t": time.t, "error": finite(time.error), "multiplicity": time.multiplicity }))
                .collect::<Vec<_>>()
        });
        json!({
            "unknowns": named(&motion.unknowns),
            "errors": named(&motion.errors),
            "velocities": velocities,
            "action": motion.action[0],
            "action_error": motion.action[1],
            "residuals": to(&mut motion.residuals.iter().copied()),
            "condition": finite(motion.condition),
            "isolated": motion.is_isolated(),
            "conjugate_times": times,
            "minimum": motion.is_minimum,
            "second_variation": motion.second_variation.words(),
            "starts": motion.starts,
            "by_half": motion.by_half,
        })
    };
    json!({
        "scene": scene.name,
        "formulation": formulation,
        "from": scene.start.t,
        "at": aim.t,
        "to": to(&mut aim.to.iter().map(|(_, q)| *q)),
        "unknowns": found.unknowns,
        "starts": aim.starts,
        "motions": found.found.iter().map(motion).collect::<Vec<_>>(),
        "failures": found.failures.iter().map(|(why, starts)| json!({ "why": why, "starts": starts })).collect::<Vec<_>>(),
        "every_constant": found.every_constant,
        "none": found.none,
        "runs": found.runs[0],
        "with_derivatives": found.runs[1],
    })
}

/// A number, or null for what is unbounded.
fn finite(x: f64) -> Value {
    if x.is_finite() { json!(x) } else { Value::Null }
}
