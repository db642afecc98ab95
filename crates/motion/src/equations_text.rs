//! Equations for the reader, printed from the expressions that are integrated.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use equations::Equations;
use mechanics::System;
use symbolic::limits::LINE;
use symbolic::{Expr, Graph, Symbol};

/// How formulas are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EquationStyle {
    /// The scene language.
    Plain,
    /// LaTeX in fenced `math` blocks.
    Latex,
}

/// Formulas of more symbols and numbers than this are cut into named pieces, however few are different.
const LONG_PRINTED: usize = 500;

/// The derived equations and what was left out of them.
pub fn equations_text(equations: &Equations, style: EquationStyle) -> String {
    let g = &equations.graph;
    let (symbols, values): (Vec<Symbol>, Vec<Expr>) = equations.definitions.iter().copied().unzip();
    let sides = equations.statements.iter().flat_map(|s| [s.left, s.right]);
    let mut whole: Vec<Expr> = values.into_iter().chain(sides).collect();
    let mut pieces = Vec::new();
    if whole.iter().any(|&e| g.size(&[e]) > LINE || g.printed_length(e) > LONG_PRINTED) {
        (pieces, whole) = g.abbreviate(&whole, "s");
    }
    let order: Vec<Symbol> = pieces.iter().map(|(symbol, _)| *symbol).collect();
    let mut writer = Writer { text: String::new(), graph: g, style, pieces: pieces.into_iter().collect() };
    let (values, sides) = whole.split_at(symbols.len());
    if symbols.is_empty() && !order.is_empty() {
        writer.text += "Intermediate quantities:\n\n";
        order.into_iter().for_each(|symbol| writer.piece(symbol));
        writer.text += "\nEquations:\n\n";
    }
    if !symbols.is_empty() {
        writer.text += "By way of:\n\n";
        for (symbol, value) in symbols.into_iter().zip(values) {
            writer.line(g.variable(symbol), *value);
        }
        writer.text += "\nEquations:\n\n";
    }
    for pair in sides.chunks_exact(2) {
        writer.line(pair[0], pair[1]);
    }
    let mut text = writer.text;
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

/// Formulas and what they share by name: names with what they stand for, then the formulas in these.
pub fn shared_text(g: &Graph, es: &[Expr], latex: bool) -> (Vec<[String; 2]>, Vec<String>) {
    let print = |e: Expr| if latex { g.latex(e) } else { g.plain(e) };
    let long = es.iter().any(|&e| g.printed_length(e) > LONG_PRINTED);
    let (pieces, rest) = if long { g.abbreviate(es, "s") } else { (Vec::new(), es.to_vec()) };
    let pieces = pieces.into_iter().map(|(symbol, e)| [print(g.variable(symbol)), print(e)]);
    (pieces.collect(), rest.into_iter().map(print).collect())
}

/// `L` and `f = 0` of a system, a line each; what would be long is cut into named pieces, before the line.
pub fn system_text(system: &System, style: EquationStyle) -> String {
    let g = &system.graph;
    let mut whole = [&[system.lagrangian], &system.constraints[..]].concat();
    let mut pieces = Vec::new();
    if whole.iter().any(|&e| g.printed_length(e) > LONG_PRINTED) {
        (pieces, whole) = g.abbreviate(&whole, "s");
    }
    let mut writer = Writer { text: String::new(), graph: g, style, pieces: pieces.into_iter().collect() };
    let lagrangian = g.variable(g.symbol("L"));
    for (i, e) in whole.into_iter().enumerate() {
        writer.line(if i == 0 { lagrangian } else { g.zero() }, e);
    }
    writer.text
}

struct Writer<'a> {
    text: String,
    graph: &'a Graph,
    style: EquationStyle,
    /// Pieces that were cut out and are not written yet.
    pieces: BTreeMap<Symbol, Expr>,
}

impl Writer<'_> {
    fn piece(&mut self, symbol: Symbol) {
        if let Some(value) = self.pieces.remove(&symbol) {
            self.line(self.graph.variable(symbol), value);
        }
    }

    /// The line, after those of the pieces that it needs.
    fn line(&mut self, left: Expr, right: Expr) {
        let g = self.graph;
        let needed = [left, right].into_iter().flat_map(|e| g.symbols_of(e));
        needed.collect::<BTreeSet<_>>().into_iter().for_each(|symbol| self.piece(symbol));
        let _ = match self.style {
            EquationStyle::Plain => writeln!(self.text, "  {} = {}", g.plain(left), g.plain(right)),
            EquationStyle::Latex => writeln!(self.text, "```math\n{} = {}\n```", g.latex(left), g.latex(right)),
        };
    }
}
