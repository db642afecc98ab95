//! Where constraints lose rank along a motion: what is watched, and what is said of it.

use std::collections::HashSet;

use equations::{Compiled, ConstraintRows, Equations};
use integrate::DenseOutput;
use mechanics::{SingularValues, System};
use nalgebra::DMatrix;
use symbolic::limits::{SAME, SHOWN};
use symbolic::{Expr, Matrix, Symbol, Vanishing};

use crate::Metric;
use crate::band::limits::NEARLY_ZERO;
use crate::numbers::{enumerate, short};
use crate::variables::in_variables_of;

/// The rows of `A = ∂f/∂v` of `system` that may lose rank become [`Equations::rows`].
pub(crate) fn watch_rank(equations: &mut Equations, system: &System) {
    let jacobian = system.constraint_jacobian();
    let numbers = rows_at_stake(system, &jacobian);
    let at_stake: Vec<Expr> = numbers.iter().flat_map(|&i| jacobian.row(i).iter().copied()).collect();
    let unknowns: HashSet<Symbol> = equations.unknowns().into_iter().collect();
    let entries = in_variables_of(equations, system, &at_stake, &unknowns);
    let (rows, columns) = (numbers.len(), jacobian.columns());
    let given = system.constraint_numbers();
    equations.rows = (rows > 0 && entries.len() == rows * columns).then(|| ConstraintRows {
        jacobian: Matrix::from_fn(rows, columns, |i, j| entries[i * columns + j]),
        numbers: numbers.into_iter().map(|i| given[i]).collect(),
        replaceable: !system.redundant.is_empty(),
        coordinates: system.coordinates.iter().map(|c| c.name.clone()).collect(),
    });
}

/// The rows whose rank may fall along a motion. A row with a column of its own, in which it has a constant
/// other than zero, adds one to the rank of the others everywhere; and a row of constant length has rank 1.
fn rows_at_stake(system: &System, jacobian: &Matrix) -> Vec<usize> {
    let (g, values) = (&system.graph, system.parameter_values());
    let is_constant = |e: Expr| g.symbols_of(e).iter().all(|symbol| values.contains_key(symbol));
    let is_nonzero = |e: Expr| is_constant(e) && matches!(g.vanishes(e, &values), Vanishing::No { .. });
    let mut rows: Vec<usize> = (0..jacobian.rows()).collect();
    loop {
        let own = |&i: &usize| {
            (0..jacobian.columns()).any(|j| {
                is_nonzero(jacobian[(i, j)]) && rows.iter().all(|&other| other == i || g.is_zero(jacobian[(other, j)]))
            })
        };
        let Some(place) = rows.iter().position(own) else { break };
        rows.remove(place);
    }
    if rows.iter().all(|&i| jacobian.row(i).iter().all(|&e| is_constant(e))) {
        return Vec::new();
    }
    if let [row] = rows[..] {
        let squares: Vec<Expr> = jacobian.row(row).iter().map(|&e| g.mul(e, e)).collect();
        let square = g.sum(&squares);
        let mut moving = g.symbols_of(square).into_iter().filter(|symbol| !values.contains_key(symbol));
        if moving.all(|symbol| g.vanishes_exactly(g.derivative(square, symbol))) {
            return Vec::new();
        }
    }
    rows
}

/// Factors by which the columns of `A` come into one unit: velocities over those of the same energy at
/// `(t, y)`; 1 where a coordinate has no inertia.
pub(crate) fn column_factors(compiled: &mut Compiled, metric: &mut Metric, t: f64, y: &[f64]) -> Vec<f64> {
    let (h, n) = compiled.rank();
    let outputs = if h > 0 { compiled.outputs(t, y).ok() } else { None };
    let lengths = outputs.map(|now| metric.inertia(t, &now.coordinates, &now.velocities).0);
    let factor = |length: f64| if length > 0.0 && length.is_finite() { length.recip() } else { 1.0 };
    lengths.map_or(vec![1.0; n], |lengths| lengths.into_iter().map(factor).collect())
}

/// Which constraints say nothing of the velocities at the end of a run, and where that is.
pub(crate) fn words(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> String {
    let (h, n) = compiled.rank();
    let numbers = equations.rows.as_ref().map_or(&[][..], |rows| &rows.numbers);
    let mut rows = |t: f64, y: &[f64]| {
        let mut entries = vec![f64::NAN; h * n];
        let known = compiled.rows(t, y, &mut entries).is_ok() && entries.iter().all(|x| x.is_finite());
        known.then(|| DMatrix::from_row_slice(h, n, &entries))
    };
    let start = rows(dense.start(), dense.start_state());
    let end = rows(dense.end(), dense.end_state());
    let silent: Vec<String> = match (start, end) {
        (Some(start), Some(end)) if h > 1 => {
            let scaled = DMatrix::from_fn(h, n, |i, j| end[(i, j)] / start.row(i).norm().max(f64::MIN_POSITIVE));
            let square = SingularValues::of(&(&scaled * scaled.transpose()));
            let last = square.right.row(h - 1);
            let told = (0..h).filter(|&i| last[i].abs() > NEARLY_ZERO * last.amax());
            told.map(|i| numbers[i].to_string()).collect()
        }
        _ => numbers.iter().map(usize::to_string).collect(),
    };
    let which = match &silent[..] {
        [one] => format!("constraint {one}"),
        several => format!("a combination of constraints {}", enumerate(several)),
    };
    let place = place(equations, dense).map_or(String::new(), |place| format!(" at {place}"));
    format!(
        "{which} says nothing of the velocities{place}: the rank of ∂f/∂v falls there, and several motions or none go on"
    )
}

fn place(equations: &Equations, dense: &DenseOutput) -> Option<String> {
    if equations.coordinates.len() > SHOWN {
        return None;
    }
    let symbols: Vec<Symbol> = [equations.time].into_iter().chain(equations.state_symbols()).collect();
    let tape = equations.tape(&symbols, &equations.coordinates).ok()?;
    let at = |t: f64, y: &[f64]| {
        let mut found = vec![f64::NAN; equations.coordinates.len()];
        tape.evaluate(&[&[t], y].concat(), &mut tape.workspace(), &mut found);
        found
    };
    let (start, end) = (at(dense.start(), dense.start_state()), at(dense.end(), dense.end_state()));
    let size = start.iter().chain(&end).fold(0.0_f64, |most, x| most.max(x.abs()));
    let value = |x: f64| if x.abs() < SAME * size { "0".into() } else { short(x) };
    let names = equations.rows.as_ref()?.coordinates.iter();
    Some(names.zip(&end).map(|(name, &x)| format!("{name} = {}", value(x))).collect::<Vec<_>>().join(", "))
}
