//! The method of a motion where none was asked for.

use equations::Equations;
use integrate::Method;

/// The method of a motion, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The method.
    pub method: Method,
    /// Why, in words; that it was asked for, too.
    pub why: String,
}

/// What the equations alone tell: whether they have Taylor series wherever a motion may come.
pub(crate) fn suited(equations: &Equations) -> Chosen {
    let g = &equations.graph;
    let definitions = equations.definitions.iter().map(|(_, e)| *e);
    let residuals = equations.blocks.iter().flat_map(|block| block.residuals.iter().copied());
    let all: Vec<_> = equations.states.iter().map(|y| y.rate).chain(definitions).chain(residuals).collect();
    let mut kinks = g.kinks(&all);
    kinks.retain(|&e| !equations.is_constant(g, e));
    let (method, why) = match kinks.first() {
        None => (Method::Taylor, "the equations have Taylor series".into()),
        Some(&kink) => (Method::Dop853, format!("the equations have a kink where {} is zero", g.plain(kink))),
    };
    Chosen { method, why }
}
