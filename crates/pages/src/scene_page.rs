//! The page of one scene.

use std::fmt::Write;

use anyhow::{Context, Result};
use comparison::{Comparison, FirstTrace};
use motion::{CHETAEV, EquationStyle, derive_at, equations_text};

use crate::bodies::bodies;
use crate::markdown::{folded, image, inert};
use crate::pictures::pictures;
use crate::table::Table;
use crate::{membership, tables};
use comparison::words::Headline;
use comparison::words::{precise, short};
use program::File;
use review::substitution::SUBSTITUTION;

/// The page of a scene and its pictures, with paths in the folder of reports.
///
/// # Errors
/// Where a motion cannot be read off or a picture cannot be drawn.
pub fn scene_files(comparison: &mut Comparison) -> Result<Vec<File>> {
    let name = comparison.scene.name.clone();
    let moving = bodies(comparison).with_context(|| format!("bodies of scene `{name}`"))?;
    let still = pictures(comparison).with_context(|| format!("pictures of scene `{name}`"))?;
    let mut files: Vec<File> = moving.into_iter().chain(still).collect();
    files.push(File { path: format!("scenes/{name}.md").into(), text: scene_page(comparison, &files)? });
    Ok(files)
}

/// The whole page, in Markdown, with its pictures.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn scene_page(comparison: &mut Comparison, pictures: &[File]) -> Result<String> {
    let mut page = String::new();
    let scene = &comparison.scene;
    let Headline { verdict, why, sure, .. } = Headline::of(comparison);
    let [title, verdict, why, sure] = [&scene.title, &verdict, &why, &sure].map(|text| inert(text));
    let _ = writeln!(page, "# {title}\n\n**{verdict}**\n\n{why}\n\n{sure}");
    let is_moving = |picture: &&File| picture.path.to_string_lossy().ends_with("-bodies.svg");
    let (moving, still): (Vec<&File>, Vec<&File>) = pictures.iter().partition(is_moving);
    for picture in moving {
        let _ = writeln!(page, "\n{}\n\nThe bodies under each formulation, from one start, in a loop.", image(picture));
    }
    if !scene.source.is_empty() {
        let _ = writeln!(page, "\nSource: {}.", inert(scene.source.trim_end_matches('.')));
    }
    if !scene.notes.is_empty() {
        let _ = writeln!(page, "\n{}", inert(&scene.notes));
    }
    page += &system(comparison);
    page += "\n## Start and constants\n\n";
    let mut start = Table::new(["coordinate", "unit", "start", "velocity", "start"]);
    for (i, c) in scene.system.coordinates.iter().enumerate() {
        let [q, v] = [c.position, c.velocity].map(|s| format!("${}$", scene.system.graph.latex_symbol(s)));
        start.row(&[&q, &c.unit, &precise(scene.start.q[i]), &v, &precise(scene.start.v[i])]);
    }
    let _ = writeln!(
        page,
        "{start}\nGiven: {}. Supplied by the constraints: {}.{}\n",
        list(&scene.completion.given),
        list(&scene.completion.supplied),
        scene
            .completion
            .projected
            .map_or(String::new(), |d| format!(" Projection moved the velocity by {}.", short(d)))
    );
    page += &tables::runs(comparison).to_string();
    page +=
        "\nError estimate: largest difference, in the kinetic metric, to a run at a hundred times larger tolerance.\n";
    page += "\n## Motions\n";
    for picture in still {
        let _ = writeln!(page, "\n{}", image(picture));
    }
    let _ = writeln!(page, "\n## Where the motions part\n\n{}", tables::pairs(comparison));
    page += "Gaps are lengths in the kinetic metric $\\sqrt{\\Delta q^T |M| \\Delta q}$, in m √kg where $L$ is in J; times in s. Two motions are *different* where the gap, or the \
             difference of a coordinate, is over ten times the sum of both error estimates, or where that is proved. *Same* says what was measured: up to the end, neither is, and the estimates \
             are below 1e-8 of the way.\n";
    page += &first_trace(comparison)?;
    let growth = tables::growth(comparison);
    if !growth.is_empty() {
        let _ = writeln!(page, "\n### How the gaps start\n\n{growth}");
        page += "Predicted from the Taylor coefficients $y_k$ of the difference of accelerations along the first motion: with $y_k$ the first that is not zero, \
                 $\\Delta q = y_k t^{k+2}/((k+1)(k+2)) + O(t^{k+3})$. Of the vakonomic motion and Chetaev's, for constraints linear in $v$, it is $\\tfrac12 \\Pi C \\mu_0 t^2$, and \
                 $-\\tfrac16 \\Pi C \\lambda_0 t^3$ for $\\mu_0 = 0$, with $C = f_q^T - \\dot A^T$ and $\\Pi = M^{-1} - M^{-1}A^T(AM^{-1}A^T)^{-1}AM^{-1}$. \
                 Proved: in exact numbers every lower coefficient is zero and this one is not, so that the two motions differ.\n";
    }
    let fits = tables::fits(comparison);
    if !fits.is_empty() {
        let _ = writeln!(page, "\n### With other free constants\n\n{fits}");
        page += "Best found of so many starts is what a least-squares fit of the motion leaves, taken on to the powers 8, 32 and 128 of the gap, the largest of which counts; smaller gaps may exist. \
                 A number has settled where half of the starts find it to 1 %; one that has not is given to one digit, rounded up. Two formulations differ as theories only if they do so for every choice of the constants that the start leaves free. By identity: for a removal by \
                 coordinates $P(t_0) = -\\partial(L + \\mu_0\\cdot f)/\\partial\\dot w$ gives the vakonomic motion, and nothing is searched.\n";
    }
    if !comparison.decided.is_empty() {
        let _ = writeln!(page, "\n## Which family has which motion\n\n{}", membership::table(comparison));
        page += "Decided for this start over the whole run, and proved where it says so: constants $\\mu_0$ or $P(t_0)$, all costates kept.\n";
    }
    let _ = writeln!(page, "\n## What stays constant\n\n{}", tables::invariants(comparison)?);
    page += &equations(comparison);
    Ok(page)
}

/// Instants at which the trace is looked at.
const TRACED: usize = 64;

/// Size of the first-order vakonomic term along Chetaev's motion.
fn first_trace(comparison: &mut Comparison) -> Result<String> {
    let Some(run) = comparison.run(CHETAEV) else { return Ok(String::new()) };
    let Comparison { scene, runs, .. } = comparison;
    let Ok(motion) = &mut runs[run].outcome else { return Ok(String::new()) };
    let Some(FirstTrace { slope, acceleration }) = comparison::first_trace(scene, motion, TRACED)? else {
        return Ok(String::new());
    };
    let size = match slope / acceleration {
        part if part > 1e-9 => format!(
            "changes accelerations along Chetaev's motion by {} per ms of $\\varepsilon$, {} of the largest of them",
            short(1e-3 * slope),
            short(1e-3 * part)
        ),
        _ => "changes accelerations along Chetaev's motion by less than 1e-12 of the largest of them per ms of $\\varepsilon$"
            .into(),
    };
    Ok(format!(
        "\nThe first trace of vakonomic mechanics, the force $-\\varepsilon C\\lambda$ of the formulation `first-order`, {size} (lengths in the kinetic metric).\n"
    ))
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        "nothing".into()
    } else {
        names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
    }
}

fn system(comparison: &Comparison) -> String {
    let system = &comparison.scene.system;
    let g = &system.graph;
    let mut text = String::from("\n## System\n\n");
    let _ = writeln!(text, "```math\nL = {}\n```", g.latex(system.lagrangian));
    for &f in &system.constraints {
        let _ = writeln!(text, "```math\n{} = 0\n```", g.latex(f));
    }
    for &w in &system.virtual_conditions {
        let _ = writeln!(text, "```math\nw = {}\n```", g.latex(w));
    }
    if !system.virtual_conditions.is_empty() {
        text += "Virtual displacements, as prescribed: $\\partial w/\\partial\\dot q\\,\\delta q = 0$.\n\n";
    }
    for (c, &force) in system.coordinates.iter().zip(&system.forces).filter(|(_, force)| !g.is_zero(**force)) {
        let _ = writeln!(text, "```math\nQ_{{{}}} = {}\n```", g.latex_symbol(c.position), g.latex(force));
    }
    let parameters: Vec<String> =
        system.parameters.iter().map(|p| format!("${} = {}$", g.latex_symbol(p.symbol), p.value)).collect();
    if !parameters.is_empty() {
        let _ = writeln!(text, "Parameters: {}.", parameters.join(", "));
    }
    let choices = comparison.runs.iter().map(|run| &run.choice).filter(|choice| choice.formulation != &SUBSTITUTION);
    for removal in choices.filter_map(|choice| choice.removal.as_ref()) {
        let parameters: Vec<String> =
            removal.parameters.iter().map(|u| format!("${}$", g.latex_symbol(u.symbol))).collect();
        let _ = writeln!(text, "\nRemoval `{}`: parameters {}.", inert(&removal.name), parameters.join(", "));
    }
    text
}

fn equations(comparison: &Comparison) -> String {
    let mut text = String::from("\n## Equations\n\nPrinted from the expressions that are derived.\n");
    for run in &comparison.runs {
        let Ok(motion) = &run.outcome else { continue };
        if run.choice.formulation == &SUBSTITUTION {
            continue;
        }
        let scene = &comparison.scene;
        let form = motion.form.chosen.name;
        let (derived, integrated) = if form == run.choice.formulation.name {
            (None, String::new())
        } else {
            let as_derived = derive_at(&scene.system, &scene.start, &run.choice);
            (as_derived.ok(), format!(", integrated as {form}: {}", motion.form.chosen.why))
        };
        let body = equations_text(derived.as_ref().unwrap_or(&motion.equations), EquationStyle::Latex);
        let label = inert(&run.choice.label);
        let _ = writeln!(text, "\n{}", folded(&format!("{label}{integrated}"), &body));
    }
    text
}
