//! The equations of a scene as a document in LaTeX.

use comparison::Comparison;
use motion::{EquationStyle, derive_at, equations_text, system_text};
use review::substitution::SUBSTITUTION;

const HEAD: &str =
    "\\documentclass{article}\n\\usepackage[fleqn]{amsmath}\n\\setlength{\\mathindent}{0pt}\n\\begin{document}\n";

/// `L` and the constraints, then the equations of every motion as derived, printed from the expressions that
/// are integrated.
pub(crate) fn equations(comparison: &Comparison) -> String {
    let scene = &comparison.scene;
    let mut text = format!("{HEAD}\n\\section*{{{}}}\n\n", prose(&scene.title));
    text += &translated(&system_text(&scene.system, EquationStyle::Latex));
    for run in &comparison.runs {
        let Ok(motion) = &run.outcome else { continue };
        if run.choice.formulation == &SUBSTITUTION {
            continue;
        }
        let chosen = &motion.form.chosen;
        let as_derived = derive_at(&scene.system, &scene.start, &run.choice);
        let same = chosen.name == run.choice.formulation.name;
        let equations = if same { &motion.equations } else { as_derived.as_ref().unwrap_or(&motion.equations) };
        text += &format!("\n\\subsection*{{{}}}\n\n", prose(&run.choice.label));
        if !same {
            text += &prose(&format!("Integrated as {}: {}.\n\n", chosen.name, chosen.why));
        }
        text += &translated(&equations_text(equations, EquationStyle::Latex));
    }
    text + "\n\\end{document}\n"
}

/// Markdown with fenced formulas in LaTeX.
fn translated(text: &str) -> String {
    let mut inside = false;
    let mut line = |line: &str| match line {
        "```math" => {
            inside = true;
            "\\[".to_owned()
        }
        "```" => {
            inside = false;
            "\\]".to_owned()
        }
        line if inside => line.to_owned(),
        line => line.strip_prefix("- ").map_or_else(|| prose(line), |item| format!("\\noindent-- {}\\\\", prose(item))),
    };
    text.lines().map(|of| line(of) + "\n").collect()
}

/// Words with formulas between dollars.
fn prose(text: &str) -> String {
    let escaped = |c: char| match c {
        '_' | '&' | '%' | '#' | '{' | '}' => format!("\\{c}"),
        '\\' => "\\textbackslash{}".into(),
        '^' => "\\^{}".into(),
        '~' => "\\~{}".into(),
        'μ' => "$\\mu$".into(),
        '₀' => "$_0$".into(),
        c => c.to_string(),
    };
    let part = |(i, part): (usize, &str)| match i % 2 {
        0 => part.chars().map(escaped).collect(),
        _ => format!("${part}$"),
    };
    text.split('$').enumerate().map(part).collect()
}
