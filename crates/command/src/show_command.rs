//! `deltaq list` and `deltaq show`.

use std::fmt::Write;

use anyhow::Result;
use deltaq::{
    Choice, EquationStyle, Settings, choices, derive_at, equations_text, forms, integrability, prepare, setting,
};
use equations::{Cost, Equations};
use mechanics::ConstantsRule;
use scene::Scene;

use crate::cli::ShowArguments;
use validation::catalogue;

/// The built-in scenes, a line each.
pub(crate) fn list() -> String {
    let line = |&(name, text): &(&str, &str)| match Scene::parse(name, text) {
        Ok(scene) => format!("{name:<24} {} ({})\n", scene.title, scene.source),
        Err(error) => format!("{name:<24} {error}\n"),
    };
    catalogue::SCENES.iter().map(line).collect()
}

/// Equations of every formulation and its further forms, what was left out, and whether the constraints are integrable.
pub(crate) fn run(arguments: &ShowArguments) -> Result<String> {
    let scene = arguments.scene.find()?;
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
    for choice in choices(&scene).into_iter().chain(forms(&scene)) {
        let _ = writeln!(text, "\n## {}\n", choice.label);
        match derive_at(&scene.system, &scene.start, &choice) {
            Ok(equations) => {
                text += &equations_text(&equations, style);
                text += &form(&scene, equations, &choice)?;
            }
            Err(error) => {
                let _ = writeln!(text, "refused: {error}");
            }
        }
    }
    Ok(text)
}

/// In which form the equations are evaluated, why, and what that costs.
fn form(scene: &Scene, equations: Equations, choice: &Choice) -> Result<String> {
    // the start is needed, not the constants that are natural at a horizon: zero stands for them
    let constants = match &choice.constants {
        ConstantsRule::Natural { .. } => &ConstantsRule::Zero,
        given => given,
    };
    let ready = match prepare(setting(scene), equations, constants, &Settings::default()) {
        Ok(ready) => ready,
        Err(error) => return Ok(format!("\nNot started: {error}\n")),
    };
    let mut text = "\nEvaluated:\n\n".to_string();
    for words in ready.equations.chosen.iter().chain(&ready.form.why) {
        let _ = writeln!(text, "- {words}");
    }
    let [plain, chosen] = ready.compiled.cost();
    let Cost { instructions, factorization } = chosen;
    let _ = write!(text, "- rates in {instructions} instructions");
    if factorization > 0 {
        let _ = write!(text, " and LU factorizations of {factorization} multiplications");
    }
    if plain != chosen {
        let Cost { instructions, factorization } = plain;
        let _ = write!(
            text,
            "; the plain form takes {instructions} and LU factorizations of {factorization} multiplications"
        );
    }
    Ok(text + "\n")
}
