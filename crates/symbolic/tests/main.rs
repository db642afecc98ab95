//! Expressions as a user of the crate meets them: one program, one module per subject.

mod algebra;
mod derivatives;
mod evaluation;
mod fractions;
mod magnitudes;
mod marks;
mod numbers;
mod properties;
mod ranges;
mod saturation;
mod series;
mod text;
mod vectors;

/// A formula in whatever names it has.
#[track_caller]
fn read(g: &symbolic::Graph, text: &str) -> symbolic::Expr {
    g.parse(text, &|name: &str| Some(g.variable(g.symbol(name)))).expect(text)
}
