//! Detects parameters and start values at which the equations have a kink along the whole motion.
//!
//! A motion and its constants move by `(dy, dc)` with a number. Where rates depend on `√(p²)` and p = 0,
//! their slope along this direction jumps on the motion itself, and automatic differentiation gives the mean
//! of both sides. Where a motion only crosses a kink, derivatives are continuous. A kink that lasts less than
//! a two-hundredth of the time, and contains none of the times asked for, may be missed.

use crate::differences::has_kink;
use crate::method::expressions;
use crate::variational::{Moves, VariationalRun};
use crate::wanted::scattered;
use crate::{Prepared, SolveError};

/// Refuses the first of these numbers at which rates, multipliers or invariants have one, at `times` or
/// between these ends.
pub(crate) fn refuse_kinks(
    prepared: &mut Prepared,
    carried: &VariationalRun,
    names: &[&str],
    [start, end]: [f64; 2],
    times: &[f64],
) -> Result<(), SolveError> {
    let equations = &prepared.equations;
    let read = equations.multipliers.iter().chain(&equations.invariants).map(|read| read.expression);
    let all: Vec<_> = expressions(equations).into_iter().chain(read).collect();
    if equations.graph.under_roots(&all).is_empty() {
        return Ok(());
    }
    let is_reached = |t: f64| carried.ends().all(|end| (t - start).abs() <= (end - start).abs());
    for t in scattered([start, end]).chain(times.iter().copied()).filter(|&t| is_reached(t)) {
        let moves = carried.moves(prepared, t)?;
        let kinked = moves.iter().position(|moves| is_kinked(prepared, t, moves));
        prepared.set_compiled();
        if let Some(i) = kinked {
            let name = names[i];
            let reason = format!("the motion does not move smoothly with {name}: its equations have a kink there");
            return Err(SolveError::Member { reason });
        }
    }
    Ok(())
}

fn is_kinked(prepared: &mut Prepared, t: f64, moves: &Moves) -> bool {
    let constants = prepared.constants.clone();
    let compiled = &mut prepared.compiled;
    has_kink(&mut |s| {
        let moved = |x: &[f64], by: &[f64]| x.iter().zip(by).map(|(x, by)| x + s * by).collect::<Vec<f64>>();
        let failed = |failure| SolveError::Reading { t, failure };
        compiled.set_constants(&moved(&constants, &moves.constants));
        let state = moved(&moves.state, &moves.by);
        let mut rates = vec![0.0; state.len()];
        compiled.rates(t, &state, &mut rates).map_err(failed)?;
        let read = compiled.outputs(t, &state).map_err(failed)?;
        Ok([rates, read.velocities, read.multipliers, read.invariants].concat())
    })
}
