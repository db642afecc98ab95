//! Where constraints lose rank along a motion: what is watched, and what is said of it.

use std::collections::HashSet;

use equations::{Compiled, ConstraintRows, Equations};
use integrate::DenseOutput;
use mechanics::{SingularValues, System};
use nalgebra::DMatrix;
use symbolic::{Matrix, Symbol};

use crate::Metric;
use crate::choice::in_variables_of;
use crate::words::{enumerate, short};

/// `A = ∂f/∂v` of `system` becomes [`Equations::rows`], unless it is constant.
pub(crate) fn watch_rank(equations: &mut Equations, system: &System) {
    let jacobian = system.constraint_jacobian();
    if jacobian.entries().iter().all(|&e| equations.is_constant(&system.graph, e)) {
        return;
    }
    let unknowns: HashSet<Symbol> = equations.unknowns().into_iter().collect();
    let entries = in_variables_of(equations, system, jacobian.entries(), &unknowns);
    let (rows, columns) = (jacobian.rows(), jacobian.columns());
    let complete = entries.len() == rows * columns;
    equations.rows = complete.then(|| ConstraintRows {
        jacobian: Matrix::from_fn(rows, columns, |i, j| entries[i * columns + j]),
        coordinates: system.coordinates.iter().map(|c| c.name.clone()).collect(),
    });
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

/// Components of the combination that loses its hold, over the largest, that are named.
const TOLD: f64 = 1e-3;
/// A coordinate under this part of what it or another of its kind was is zero to the reader.
const ZERO: f64 = 1e-5;
/// As many coordinates are told.
const PLACES: usize = 8;

/// Which constraints say nothing of the velocities at the end of a run, and where that is.
pub(crate) fn words(equations: &Equations, compiled: &mut Compiled, dense: &DenseOutput) -> String {
    let (h, n) = compiled.rank();
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
            let told = (0..h).filter(|&i| last[i].abs() > TOLD * last.amax());
            told.map(|i| (i + 1).to_string()).collect()
        }
        _ => (1..=h).map(|i| i.to_string()).collect(),
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
    if equations.coordinates.len() > PLACES {
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
    let value = |x: f64| if x.abs() < ZERO * size { "0".into() } else { short(x) };
    let names = equations.rows.as_ref()?.coordinates.iter();
    Some(names.zip(&end).map(|(name, &x)| format!("{name} = {}", value(x))).collect::<Vec<_>>().join(", "))
}
