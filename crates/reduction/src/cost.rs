//! What ways to write the same motion cost, and the cheapest of them.

use equations::{Compiled, Equations};

/// Of equations of one motion, those whose rates take the fewest operations with nothing eliminated ([`Compiled::cost`]) once what
/// they do not need is left out; to choose a plan for each would take longer than to derive them; the first of equals. Those that do not compile come last.
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

/// Whether the equations of the instant have a matrix that moves with time or state: one that has to be eliminated along the way.
pub fn matrix_moves(equations: &Equations) -> bool {
    let rows = equations.blocks.iter().flat_map(|b| equations.graph.sparse_jacobian(&b.residuals, &b.unknowns));
    let behind = equations.symbols_behind(rows.flatten().map(|(_, e)| e));
    let mut moving = equations.known_symbols().into_iter().chain(equations.unknowns());
    moving.any(|s| behind.contains(&s))
}
