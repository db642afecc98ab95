//! Common factors drawn out of the definitions and rates of a plan: `a x + b x = (a + b) x`.
//!
//! Elimination leaves sums of products whose terms may meet and cancel; only when nothing more does are they
//! shortened. What is drawn out of one sum may have been shared with another: instructions are counted.

use std::collections::HashSet;

use symbolic::{CompileError, Expr, Symbol};

use super::chosen::{Collected, Plan};
use crate::equations::Equations;

/// One instruction in this number has to be saved: under that, Taylor series may take more products.
const WORTH_WHILE: usize = 10;

/// What is shorter than `plan` as it is, if anything is.
pub(crate) fn collected(equations: &Equations, plan: &Plan) -> Result<Option<Collected>, CompileError> {
    let g = &equations.graph;
    let (definitions, rates) = (plan.all_definitions(equations), plan.rates(equations));
    let all: Vec<Expr> = definitions.iter().map(|d| d.1).chain(rates.iter().copied()).collect();
    let parameters: HashSet<Symbol> = equations.parameters.keys().copied().collect();
    let mut shorter = g.collected(&all, &|s| parameters.contains(&s));
    if shorter == all {
        return Ok(None);
    }
    let after = Collected {
        rates: shorter.split_off(definitions.len()),
        definitions: definitions.iter().map(|d| d.0).zip(shorter).collect(),
    };
    let mut inputs = equations.known_symbols();
    inputs.extend(plan.left.iter().flat_map(|&k| equations.blocks[k].unknowns.iter().copied()));
    let length = |definitions: &[(Symbol, Expr)], rates: &[Expr]| {
        let outputs = [rates, plan.condition.as_slice()].concat();
        equations.tape_by(definitions, &inputs, &outputs).map(|tape| tape.len())
    };
    let (long, short) = (length(&definitions, &rates)?, length(&after.definitions, &after.rates)?);
    Ok((short * WORTH_WHILE <= long * (WORTH_WHILE - 1)).then_some(after))
}
