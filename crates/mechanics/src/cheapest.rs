//! The cheapest of several ways to write the same motion.

use symbolic::Expr;

use crate::{Compiled, Equations};

/// Of equations of one motion, those whose rates take the fewest operations in the plain form ([`Compiled::cost`]) once what
/// they do not need is left out; to choose a form for each would take longer than to derive them; the first of equals. Those that do not compile come last.
///
/// # Panics
/// If there are none.
pub fn cheapest(candidates: Vec<Equations>) -> Equations {
    let price = |equations: &Equations| {
        let compiled = Compiled::plain(&equations.clone().leave_out_unneeded());
        compiled.map_or(usize::MAX, |compiled| compiled.cost()[0].operations())
    };
    candidates.into_iter().min_by_key(price).expect("at least one candidate")
}

/// Nodes of definitions, rates and equations of the instant: how long equations are, known without compiling them.
pub fn length(equations: &Equations) -> usize {
    let rates = equations.states.iter().map(|y| y.rate);
    let blocks = equations.blocks.iter().flat_map(|b| b.residuals.iter().copied());
    let all: Vec<Expr> = equations.definitions.iter().map(|d| d.1).chain(rates).chain(blocks).collect();
    equations.graph.size(&all)
}
