//! The cost of equivalent equations of one motion, and the cheapest of them.

use equations::{Compiled, Equations};

/// The candidate with the fewest operations per evaluation of the rates ([`Compiled::cost`]), before
/// elimination, what is not needed left out; candidates that do not compile rank last. Plans for each would
/// cost more than deriving them.
///
/// # Panics
/// If there are none.
pub fn cheapest(mut candidates: Vec<Equations>) -> Equations {
    if candidates.len() == 1 {
        return candidates.remove(0);
    }
    let price = |equations: &Equations| {
        let compiled = Compiled::plain(&equations.clone().leave_out_unneeded());
        compiled.map_or(usize::MAX, |compiled| compiled.cost()[0].operations())
    };
    candidates.into_iter().min_by_key(price).expect("at least one candidate")
}

/// Whether the matrix of the equations of the instant depends on time or state.
pub fn matrix_moves(equations: &Equations) -> bool {
    let rows = equations.blocks.iter().flat_map(|b| equations.graph.sparse_jacobian(&b.residuals, &b.unknowns));
    let behind = equations.symbols_behind(rows.flatten().map(|(_, e)| e));
    let mut moving = equations.known_symbols().into_iter().chain(equations.unknowns());
    moving.any(|s| behind.contains(&s))
}
