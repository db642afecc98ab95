//! `deltaq new` and `deltaq check`: a scene to begin with, and all that is wrong with one.

use std::fmt::Write;
use std::io::{IsTerminal, Write as _, stderr};

use anyhow::{Result, bail};
use scene::{Scene, SceneError};

use crate::cli::{CheckArguments, NewArguments};
use crate::schema::schema;
use crate::show_command::of_contacts;
use program::{keep, plain};

const TEMPLATE: &str = include_str!("template.toml");
const ROBOT: &str = include_str!("robot.toml");

/// A commented template, or a built-in scene; to a file that is not there yet, or to the terminal.
pub(crate) fn new(arguments: &NewArguments) -> Result<String> {
    let text = match &arguments.from {
        None if arguments.schema => format!("{:#}\n", schema()),
        None if arguments.bodies => ROBOT.to_string(),
        None => TEMPLATE.to_string(),
        Some(name) => scene::catalogue::source(name)?,
    };
    keep(arguments.file.as_deref(), text, |path| {
        let next = format!("; next: deltaq check {path}, deltaq compare {path}");
        format!("{path} written{}\n", if arguments.schema { "" } else { &next })
    })
}

/// What each scene is; or all faults of all of them, and an error.
pub(crate) fn check(arguments: &CheckArguments) -> Result<String> {
    let mut text = String::new();
    let (mut faults, mut remarks) = (0, 0);
    for name in &arguments.scenes {
        let file = if name == "-" { "stdin" } else { name };
        let read = |text: String| Ok(Scene::remarks(file, &text, &arguments.set.overrides)?);
        match scene::catalogue::source(name).and_then(read) {
            Ok((scene, of_scene)) => {
                text += &described(&scene);
                text += &of_contacts(&scene);
                for remark in of_scene {
                    remarks += 1;
                    text += &format!("note: {remark}\n");
                }
            }
            Err(scene::catalogue::NotFound::Fault(error)) => {
                error.each().for_each(|fault| {
                    let _ = writeln!(stderr(), "{}", coloured(fault));
                });
                faults += error.each().count();
            }
            Err(nothing) => return Err(nothing.into()),
        }
    }
    if faults > 0 {
        bail!("{faults} fault{}", if faults == 1 { "" } else { "s" });
    }
    if arguments.strict && remarks > 0 {
        bail!("{text}{remarks} note{}, and --strict takes them for faults", if remarks == 1 { "" } else { "s" });
    }
    Ok(text)
}

fn described(scene: &Scene) -> String {
    let system = &scene.system;
    let mut text = format!(
        "{}: {} coordinates, {} constraints; starts at t = {} for {}\n",
        scene.name,
        system.dimension(),
        system.constraints.len(),
        scene.start.t,
        scene.duration
    );
    // what the constraints give as a difference of larger numbers may be nothing but their last digits
    let noise = 8.0 * f64::EPSILON * scene.start.v.iter().fold(0.0_f64, |size, v| size.max(v.abs()));
    for ((c, q), v) in system.coordinates.iter().zip(&scene.start.q).zip(&scene.start.v) {
        let supplied = scene.completion.supplied.contains(&format!("{}'", c.name));
        let v = if supplied && v.abs() <= noise { 0.0 } else { *v };
        let by = match supplied {
            true if scene.completion.equations.is_empty() => "  by the constraints",
            true => "  by constraints and start equations",
            false => "",
        };
        let _ = writeln!(text, "  {:<12} {q:<22} {:<13} {v}{by}", c.name, format!("{}'", c.name));
    }
    text
}

/// The fault, with its place in colour on a terminal.
fn coloured(fault: &SceneError) -> String {
    let alone = plain(&SceneError { also: Vec::new(), ..fault.clone() }.to_string()).into_owned();
    if !stderr().is_terminal() {
        return alone;
    }
    let (bold, red, plain) = ("\x1b[1m", "\x1b[1;31m", "\x1b[0m");
    let mut lines: Vec<String> = alone.lines().map(String::from).collect();
    let last = lines.len() - 1;
    if last > 0 {
        lines[last] = lines[last].replacen("| ", &format!("| {red}"), 1) + plain;
    }
    lines[0] = format!("{bold}{}{plain}", lines[0]);
    lines.join("\n")
}
