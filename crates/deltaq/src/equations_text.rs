//! Equations for the reader, printed from the expressions that are integrated.

use std::fmt::Write;

use equations::Equations;
use symbolic::Expr;

/// How formulas are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EquationStyle {
    /// The scene language.
    Plain,
    /// LaTeX in fenced `math` blocks.
    Latex,
}

/// Expressions with more nodes than this are written with named intermediate quantities.
const LONG: usize = 60;

/// The derived equations and what was left out of them.
pub fn equations_text(equations: &Equations, style: EquationStyle) -> String {
    let g = &equations.graph;
    let mut sides: Vec<Expr> = equations.statements.iter().flat_map(|s| [s.left, s.right]).collect();
    let mut text = String::new();
    if !equations.definitions.is_empty() {
        text += "By way of:\n\n";
        for &(symbol, value) in &equations.definitions {
            line(&mut text, equations, style, g.variable(symbol), value);
        }
        text += "\nEquations:\n\n";
    }
    if sides.iter().any(|&e| g.size(&[e]) > LONG) {
        let (definitions, short) = g.abbreviate(&sides, "s");
        sides = short;
        for (symbol, value) in definitions {
            line(&mut text, equations, style, g.variable(symbol), value);
        }
        if !text.is_empty() {
            text = format!("Intermediate quantities:\n\n{text}\nEquations:\n\n");
        }
    }
    for pair in sides.chunks_exact(2) {
        line(&mut text, equations, style, pair[0], pair[1]);
    }
    if !equations.left_out.is_empty() {
        text += "\nLeft out, because this scene does not need it:\n\n";
        for left_out in &equations.left_out {
            let name = |&symbol: &symbolic::Symbol| match style {
                EquationStyle::Plain => g.name(symbol),
                EquationStyle::Latex => format!("${}$", g.latex_symbol(symbol)),
            };
            let names: Vec<String> = left_out.variables.iter().map(name).collect();
            let colon = if names.is_empty() { "" } else { ": " };
            let _ = writeln!(text, "- {}{colon}{}", names.join(", "), left_out.words);
        }
    }
    text
}

fn line(text: &mut String, equations: &Equations, style: EquationStyle, left: Expr, right: Expr) {
    let g = &equations.graph;
    let _ = match style {
        EquationStyle::Plain => writeln!(text, "  {} = {}", g.plain(left), g.plain(right)),
        EquationStyle::Latex => writeln!(text, "```math\n{} = {}\n```", g.latex(left), g.latex(right)),
    };
}
