//! `deltaq list` and `deltaq show`.

use std::fmt::Write;

use anyhow::Result;
use deltaq::{EquationStyle, choices, derive_at, equations_text};
use mechanics::{Scene, integrability};

use crate::catalogue;
use crate::cli::ShowArguments;

/// The built-in scenes, a line each.
pub fn list() -> String {
    let line = |&(name, text): &(&str, &str)| match Scene::parse(name, text) {
        Ok(scene) => format!("{name:<24} {} ({})\n", scene.title, scene.source),
        Err(error) => format!("{name:<24} {error}\n"),
    };
    catalogue::SCENES.iter().map(line).collect()
}

/// Equations of every formulation, what was left out, and whether the constraints are integrable.
///
/// # Errors
/// Bad input, with its place.
pub fn run(arguments: &ShowArguments) -> Result<String> {
    let scene = catalogue::find(&arguments.scene, &arguments.overrides)?;
    let style = if arguments.latex { EquationStyle::Latex } else { EquationStyle::Plain };
    let source = if scene.source.is_empty() { String::new() } else { format!("{}\n", scene.source) };
    let mut text = format!("{}\n{source}\n", scene.title);
    let g = &scene.system.graph;
    let print = |e| if arguments.latex { g.latex(e) } else { g.plain(e) };
    let _ = writeln!(text, "L = {}", print(scene.system.lagrangian));
    for &f in &scene.system.constraints {
        let _ = writeln!(text, "0 = {}", print(f));
    }
    let _ = writeln!(text, "\nConstraint: {}", integrability(&scene.system, &scene.start)?);
    for choice in choices(&scene) {
        let _ = writeln!(text, "\n## {}\n", choice.label);
        match derive_at(&scene.system, &scene.start, &choice) {
            Ok(equations) => text += &equations_text(&equations, style),
            Err(error) => {
                let _ = writeln!(text, "refused: {error}");
            }
        }
    }
    Ok(text)
}
