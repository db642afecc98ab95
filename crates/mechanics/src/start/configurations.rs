//! Coordinates at the start that constraints on positions leave nothing of.

use nalgebra::{DMatrix, DVector};
use symbolic::{CompileError, Evaluator, Expr, SplitMix};

use crate::System;
use crate::newton::{Evaluation, NewtonOptions, solve};

/// Points from which Newton's method begins.
const STARTS: usize = 300;
/// Configurations nearer to one another than this, in parts of their size, are one.
const APART: f64 = 1e-6;

/// All values found of the coordinates `free` with which the constraints on positions hold at time `t`, the
/// others being those of `q`: Newton's method from `q` itself, then from points up to three times as far away
/// as its largest coordinate, angles from −π to π. They are roots at which the constraints determine all of
/// `free`; those nearest to `q` come first.
///
/// # Errors
/// [`CompileError`] where a constraint cannot be compiled.
pub fn configurations(system: &System, t: f64, q: &[f64], free: &[usize]) -> Result<Vec<Vec<f64>>, CompileError> {
    let g = &system.graph;
    let constraints: Vec<Expr> = system.on_positions.iter().map(|(_, e)| *e).collect();
    let symbols = system.positions();
    let own: Vec<_> = free.iter().map(|&i| symbols[i]).collect();
    let jacobian = g.jacobian(&constraints, &own);
    let inputs = [&[system.time], &symbols[..]].concat();
    let outputs = [&constraints[..], jacobian.entries()].concat();
    let mut program = Evaluator::<f64>::new(g.compile(&inputs, &outputs, &system.parameter_values())?);
    let (m, n) = (constraints.len(), free.len());
    let is_angle: Vec<bool> = free.iter().map(|&i| matches!(system.coordinates[i].unit.as_str(), "rad" | "")).collect();
    let mut at = |x: &DVector<f64>| {
        let mut all = q.to_vec();
        free.iter().zip(x.iter()).for_each(|(&i, x)| all[i] = *x);
        let values = program.evaluate(&[&[t], &all[..]].concat());
        let jacobian = DMatrix::from_row_slice(m, n, &values[m..]);
        let size = 1.0 + all.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let magnitude = DVector::from_fn(m, |i, _| size * jacobian.row(i).amax());
        Evaluation { residual: DVector::from_row_slice(&values[..m]), jacobian, magnitude }
    };
    let near = DVector::from_fn(n, |k, _| q[free[k]]);
    let size = q.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    let (mut random, mut found) = (SplitMix::new(4), Vec::<Vec<f64>>::new());
    for start in 0..STARTS {
        let mut draw = |k: usize| {
            let reach = if is_angle[k] { std::f64::consts::PI } else { 3.0 * size };
            reach * (2.0 * random.unit() - 1.0)
        };
        let from = if start == 0 { near.clone() } else { DVector::from_fn(n, |k, _| draw(k)) };
        let Ok(root) = solve(&mut at, from, &NewtonOptions::default()) else { continue };
        let mut x = root.x;
        // an angle and one that is full turns away are one configuration, where the constraints say so
        for k in (0..n).filter(|&k| is_angle[k]) {
            let mut turned = x.clone();
            turned[k] -= std::f64::consts::TAU * ((x[k] - near[k]) / std::f64::consts::TAU).round();
            if at(&turned).relative_residual(&turned) <= NewtonOptions::default().limit {
                x = turned;
            }
        }
        let is_known =
            |known: &Vec<f64>| known.iter().zip(x.iter()).all(|(a, b)| (a - b).abs() <= APART * (size + b.abs()));
        if root.rank == n && !found.iter().any(is_known) {
            found.push(x.as_slice().to_vec());
        }
    }
    let distance = |x: &Vec<f64>| x.iter().zip(near.iter()).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    found.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    Ok(found)
}
