//! The method of a motion where none was asked for.

use equations::Equations;
use integrate::Method;
use symbolic::Expr;

/// The method of a motion, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The method.
    pub method: Method,
    /// Why, in words; that it was asked for, too.
    pub why: String,
}

/// What the rates are computed from.
pub(crate) fn expressions(equations: &Equations) -> Vec<Expr> {
    let definitions = equations.definitions.iter().map(|(_, e)| *e);
    let residuals = equations.blocks.iter().flat_map(|block| block.residuals.iter().copied());
    equations.states.iter().map(|y| y.rate).chain(definitions).chain(residuals).collect()
}

/// What the equations alone tell: whether they have Taylor series wherever a motion may come.
pub(crate) fn suited(equations: &Equations) -> Chosen {
    let (g, all) = (&equations.graph, expressions(equations));
    let mut kinks = g.kinks(&all);
    kinks.retain(|&e| !equations.is_constant(g, e));
    let (method, why) = match kinks.first() {
        None => (Method::Taylor, "the equations have Taylor series".into()),
        Some(&kink) => (Method::Dop853, format!("the equations have a kink where {} is zero", g.plain(kink))),
    };
    Chosen { method, why }
}
