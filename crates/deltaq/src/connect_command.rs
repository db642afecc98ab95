//! `deltaq connect`: motions between two points.

use anyhow::Result;
use indexmap::IndexMap;
use motion::{Aim, ConjugateTime, Connection, Connections, SecondVariation, Settings, connect};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;
use symbolic::limits::SHOWN;

use crate::cli::ConnectArguments;
use crate::columns::{Numbers, named};
use crate::solve_command::{choice, limited};
use program::{Answer, TextOrJson, parallel, typed};

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
        TextOrJson::Json => typed(&Connected::of(&scene, name, &aim, &found))?,
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
    for (motion, number) in found.found.iter().zip(1..).take(SHOWN) {
        text += "\n";
        text += &one(number, motion, found, aim);
    }
    if found.found.len() > SHOWN {
        text += &format!("\n{} more in JSON: --format json\n", found.found.len() - SHOWN);
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

/// Motions between two points: `deltaq connect --format json`.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "connect/2")]
pub(crate) struct Connected<'a> {
    scene: &'a str,
    formulation: &'a str,
    /// Time of the start.
    from: f64,
    /// Time of the end.
    at: f64,
    /// Coordinates at the end.
    to: Numbers,
    /// Free start velocities, free constants.
    unknowns: &'a [String],
    starts: usize,
    /// By rising action.
    motions: Vec<Found<'a>>,
    /// Why starts led nowhere.
    failures: Vec<Failure<'a>>,
    /// Whether every mu0 gives the same motions, so that none is unknown.
    every_constant: bool,
    /// Why there is no motion at all; null elsewhere.
    none: Option<&'a str>,
    /// Motions integrated in the search.
    runs: usize,
    /// Those among them that carried derivatives.
    with_derivatives: usize,
}

#[derive(Serialize, JsonSchema)]
struct Found<'a> {
    unknowns: Numbers,
    /// How far the unknowns may be wrong; null where nothing is known.
    #[schemars(with = "IndexMap<String, Option<f64>>")]
    errors: Numbers,
    /// All velocities at the start.
    velocities: Numbers,
    /// The integral of L over time.
    action: f64,
    /// Error of its quadrature.
    action_error: f64,
    /// What the end is missed by.
    residuals: Numbers,
    /// Condition number of the end by the unknowns, in units of the problem.
    #[schemars(with = "Option<f64>")]
    condition: f64,
    /// Whether no other motion is beside it.
    isolated: bool,
    /// Rising; null where the unknowns are dependent at all times.
    conjugate_times: Option<&'a [ConjugateTime]>,
    /// Whether the action has a local minimum, as far as conjugate times tell; null where that is not known.
    minimum: Option<bool>,
    /// What the second variation of the action says, in words.
    second_variation: &'static str,
    /// How many starts led here.
    starts: usize,
    /// Whether the first half of the starts leads here.
    by_half: bool,
}

#[derive(Serialize, JsonSchema)]
struct Failure<'a> {
    why: &'a str,
    starts: usize,
}

impl<'a> Connected<'a> {
    fn of(scene: &'a Scene, formulation: &'a str, aim: &Aim, found: &'a Connections) -> Self {
        let ends = || aim.to.iter().map(|(name, _)| name);
        let motion = |motion: &'a Connection| Found {
            unknowns: named(&found.unknowns, &motion.unknowns),
            errors: named(&found.unknowns, &motion.errors),
            velocities: named(scene.system.coordinates.iter().map(|c| format!("{}'", c.name)), &motion.start.v),
            action: motion.action[0],
            action_error: motion.action[1],
            residuals: named(ends(), &motion.residuals),
            condition: motion.condition,
            isolated: motion.is_isolated(),
            conjugate_times: motion.conjugate.as_deref(),
            minimum: motion.is_minimum,
            second_variation: motion.second_variation.words(),
            starts: motion.starts,
            by_half: motion.by_half,
        };
        Connected {
            scene: &scene.name,
            formulation,
            from: scene.start.t,
            at: aim.t,
            to: named(ends(), &aim.to.iter().map(|(_, q)| *q).collect::<Vec<_>>()),
            unknowns: &found.unknowns,
            starts: aim.starts,
            motions: found.found.iter().map(motion).collect(),
            failures: found.failures.iter().map(|(why, starts)| Failure { why, starts: *starts }).collect(),
            every_constant: found.every_constant,
            none: found.none.as_deref(),
            runs: found.runs[0],
            with_derivatives: found.runs[1],
        }
    }
}
