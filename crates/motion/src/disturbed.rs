//! Equations with added round-off of the rates: a run shows how it grows.

use equations::{Equations, FreeConstant};
use mechanics::fresh_symbol;
use symbolic::Symbol;

/// `ẏ_i = F_i (1 + η_i) + d_i`, except for rates that are states themselves, with these numbers: `d`, then
/// `η`.
pub(crate) fn disturbed(equations: &Equations, by: &[f64]) -> Equations {
    let mut equations = equations.clone();
    let symbols = disturb(&mut equations);
    equations.parameters.extend(symbols.into_iter().zip(by.iter().copied()));
    equations
}

/// The same with free constants, before the last `behind` ones.
pub(crate) fn disturbed_by_constants(equations: &Equations, behind: usize) -> Equations {
    let mut equations = equations.clone();
    let constant = |symbol| FreeConstant { symbol, natural: None, memory: None };
    let constants: Vec<FreeConstant> = disturb(&mut equations).into_iter().map(constant).collect();
    let place = equations.free_constants.len() - behind;
    equations.free_constants.splice(place..place, constants);
    equations
}

/// The symbols `d`, then `η`.
fn disturb(equations: &mut Equations) -> Vec<Symbol> {
    let g = &equations.graph;
    let known: Vec<Symbol> = equations.states.iter().map(|state| state.symbol).collect();
    let fresh =
        |name: &str| -> Vec<Symbol> { (0..known.len()).map(|i| fresh_symbol(g, &format!("{name}_{i}"))).collect() };
    let (offsets, parts) = (fresh("offset"), fresh("part"));
    for ((state, &offset), &part) in equations.states.iter_mut().zip(&offsets).zip(&parts) {
        if g.as_symbol(state.rate).is_none_or(|symbol| !known.contains(&symbol)) {
            let factor = g.add(g.one(), g.variable(part));
            state.rate = g.add(g.mul(state.rate, factor), g.variable(offset));
        }
    }
    [offsets, parts].concat()
}
