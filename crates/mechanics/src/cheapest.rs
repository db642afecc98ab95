//! The cheapest of several ways to write the same motion.

use crate::{Compiled, Equations};

/// Of equations of one motion in the same states, those whose rates take the fewest operations in the plain form ([`Compiled::cost`]) once what
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
