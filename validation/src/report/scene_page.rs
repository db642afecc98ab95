//! The page of one scene.

use std::fmt::Write;

use anyhow::Result;
use deltaq::{Comparison, Verdict, removals};
use mechanics::ConstantsRule;

use crate::report::equations::{EquationStyle, equations_text};
use crate::report::numbers::{precise, short};
use crate::report::tables;
use crate::substitution;

/// The answer in one or two sentences: do the formulations agree, if not from when, by how much.
pub fn answer(comparison: &Comparison) -> String {
    let mut sentences = Vec::new();
    let main: Vec<usize> =
        ["chetaev", "vakonomic", "removed-constraint"].iter().filter_map(|f| comparison.run(f)).collect();
    let pair_of = |a: usize, b: usize| comparison.pair(a, b);
    let label = |i: usize| comparison.runs[i].choice.label.clone();
    let all: Vec<(usize, usize)> =
        (0..main.len()).flat_map(|i| (i + 1..main.len()).map(move |j| (i, j))).map(|(i, j)| (main[i], main[j])).collect();
    let same = |&(a, b): &(usize, usize)| pair_of(a, b).is_some_and(|p| p.gap.verdict == Verdict::Same);
    if !all.is_empty() && all.iter().all(same) {
        sentences.push("All formulations give the same motion.".to_string());
    } else {
        for &(a, b) in &all {
            let words = match pair_of(a, b) {
                None => {
                    let refused = [a, b].into_iter().filter_map(|i| comparison.runs[i].outcome.as_ref().err().map(|e| (i, e)));
                    refused.map(|(i, e)| format!("{} gives no motion ({e})", label(i))).collect::<Vec<_>>().join("; ")
                }
                Some(pair) => match &pair.gap.verdict {
                    Verdict::Same => format!("{} and {} give the same motion", label(a), label(b)),
                    Verdict::Different => {
                        let passes = pair.gap.passes[1].map_or(String::new(), |t| format!(", 1e-3 at {} s", short(t)));
                        let first = pair.gap.passes[0].map_or(String::new(), |t| format!(": gap 1e-6 at {} s{passes}", short(t)));
                        format!("{} and {} part{first}, at most {}", label(a), label(b), short(pair.gap.largest))
                    }
                    Verdict::Undecided { because } => format!("{} and {}: undecided, {because}", label(a), label(b)),
                },
            };
            if !sentences.contains(&words) {
                sentences.push(words);
            }
        }
        for fit in comparison.fits.iter().take(1) {
            if let Some(fitted) = &fit.fitted {
                sentences.push(match fitted.gap.verdict {
                    Verdict::Same => "the best-fitting vakonomic multipliers make the difference vanish".into(),
                    _ => format!("the best-fitting vakonomic multipliers leave a gap of {}", short(fitted.gap.largest)),
                });
            }
        }
    }
    let text = sentences.join("; ");
    if text.ends_with('.') { text } else { text + "." }
}

/// The whole page, in Markdown.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn scene_page(comparison: &mut Comparison, pictures: &[String]) -> Result<String> {
    let mut page = String::new();
    let scene = &comparison.scene;
    let _ = writeln!(page, "# {}\n\n**{}**\n", scene.title, answer(comparison));
    let _ = writeln!(page, "Source: {}. Constraint: {}.", scene.source.trim_end_matches('.'), comparison.integrability);
    if !scene.notes.is_empty() {
        let _ = writeln!(page, "\n{}", scene.notes);
    }
    page += &system(comparison);
    page += "\n## Start and constants\n\n";
    let start: Vec<String> = (0..scene.system.dimension())
        .map(|i| {
            let c = &scene.system.coordinates[i];
            let g = &scene.system.graph;
            let (q, v) = (g.latex_symbol(c.position), g.latex_symbol(c.velocity));
            format!("| ${q}$ | {} | {} | ${v}$ | {} |", c.unit, precise(scene.start.q[i]), precise(scene.start.v[i]))
        })
        .collect();
    let _ = writeln!(page, "| coordinate | unit | start | velocity | start |\n|---|---|---|---|---|\n{}", start.join("\n"));
    let _ = writeln!(
        page,
        "\nGiven: {}. Supplied by the constraints: {}.{}\n",
        list(&scene.completion.given),
        list(&scene.completion.supplied),
        scene.completion.projected.map_or(String::new(), |d| format!(" Projection moved the velocity by {}.", short(d)))
    );
    page += &tables::runs(comparison);
    page += "\nError estimate: largest difference, in the kinetic metric, to a run at a hundred times larger tolerance.\n";
    page += "\n## Motions\n";
    for path in pictures {
        let _ = writeln!(page, "\n![{path}]({path})");
    }
    let _ = writeln!(page, "\n## Where the motions part\n\n{}", tables::pairs(comparison));
    page += "Gaps are lengths in the kinetic metric $\\sqrt{\\Delta q^T M \\Delta q}$; times in s. Two motions are *different* only where the gap is over \
             ten times the sum of both error estimates, *the same* where it never is and the estimates are below 1e-8 of the way.\n";
    let growth = tables::growth(comparison);
    if !growth.is_empty() {
        let _ = writeln!(page, "\n### How the gaps start\n\n{growth}");
        page += "Predicted for constraints linear in $v$, with $C = f_q^T - \\dot A^T$ and $\\Pi = M^{-1} - M^{-1}A^T(AM^{-1}A^T)^{-1}AM^{-1}$: \
                 $q_{vak} - q_{chet} = \\tfrac12 \\Pi C \\mu_0 t^2 + O(t^3)$, for $\\mu_0 = 0$ it is $-\\tfrac16 \\Pi C \\lambda_0 t^3 + O(t^4)$.\n";
    }
    let fits = tables::fits(comparison);
    if !fits.is_empty() {
        let _ = writeln!(page, "\n### With the best free constants\n\n{fits}");
        page += "Two formulations differ as theories only if they do so for every choice of the constants that the start leaves free.\n";
    }
    let _ = writeln!(page, "\n## What stays constant\n\n{}", tables::invariants(comparison)?);
    page += &equations(comparison);
    Ok(page)
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "nothing".into() } else { names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ") }
}

fn system(comparison: &Comparison) -> String {
    let system = &comparison.scene.system;
    let g = &system.graph;
    let mut text = String::from("\n## System\n\n");
    let _ = writeln!(text, "```math\nL = {}\n```", g.latex(system.lagrangian));
    for &f in &system.constraints {
        let _ = writeln!(text, "```math\n{} = 0\n```", g.latex(f));
    }
    for (c, &force) in system.coordinates.iter().zip(&system.forces).filter(|(_, force)| !g.is_zero(**force)) {
        let _ = writeln!(text, "```math\nQ_{{{}}} = {}\n```", g.latex_symbol(c.position), g.latex(force));
    }
    let parameters: Vec<String> =
        system.parameters.iter().map(|p| format!("${} = {}$", g.latex_symbol(p.symbol), p.value)).collect();
    if !parameters.is_empty() {
        let _ = writeln!(text, "Parameters: {}.", parameters.join(", "));
    }
    if let Ok(removals) = removals(&comparison.scene) {
        for removal in removals {
            let parameters: Vec<String> =
                removal.parameters.iter().map(|u| format!("${}$", g.latex_symbol(u.symbol))).collect();
            let constants = match &removal.constants {
                ConstantsRule::Zero => "$P(t_0) = 0$".to_string(),
                ConstantsRule::Given(_) => "$P(t_0)$ given".to_string(),
                ConstantsRule::Natural { horizon } => format!("$P({horizon}) = 0$"),
            };
            let _ = writeln!(text, "\nRemoval `{}`: parameters {}; constants {constants}.", removal.name, parameters.join(", "));
        }
    }
    text
}

fn equations(comparison: &Comparison) -> String {
    let mut text = String::from("\n## Equations\n\nPrinted from the expressions that are integrated.\n");
    for run in &comparison.runs {
        let Ok(motion) = &run.outcome else { continue };
        if run.choice.formulation == substitution::NAME {
            continue;
        }
        let body = equations_text(&motion.equations, EquationStyle::Latex);
        let _ = writeln!(text, "\n<details><summary>{}</summary>\n\n{body}\n</details>", run.choice.label);
    }
    text
}
