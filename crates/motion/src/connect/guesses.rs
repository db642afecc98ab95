//! Where searches start, and the units of the problem.

use crate::connect::two_point::TwoPoint;
use crate::shooting::{BEGINNING, spread};
use crate::variational::{VariationalRun, Which};
use crate::{Metric, SolveError};

/// Where searches start.
pub(super) struct Guesses {
    /// The unit of each unknown.
    pub(super) units: Vec<f64>,
    /// The size of each coordinate aimed at.
    pub(super) sizes: Vec<f64>,
    /// Unknowns in these units.
    pub(super) values: Vec<Vec<f64>>,
}

/// Half widths of the boxes that guesses are spread over in turn, in units of the problem.
const BOXES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// The first guess goes straight at the goal, the second is the scene's own start; the others are the
/// additive recurrence of Roberts about the first, over boxes of four sizes. One unit of a velocity is what
/// leads to the goal in time, or what the start has, or what straight motion misses by, whichever is most; of
/// a constant what turns such a velocity once.
pub(super) fn guesses(problem: &TwoPoint, count: usize) -> Result<Guesses, SolveError> {
    let mut problem = problem.clone();
    let (start, time) = (problem.scene_start.clone(), problem.aim.t - problem.scene_start.t);
    let n = start.q.len();
    let mut way = vec![0.0; n];
    problem.goal.iter().for_each(|&(i, q)| way[i] = q - start.q[i]);
    let straight: Vec<f64> = {
        let is_aimed = |i: usize| problem.goal.iter().any(|&(aimed, _)| aimed == i);
        let velocity = |i: usize| if is_aimed(i) { way[i] / time } else { start.v[i] };
        (0..n).map(velocity).collect()
    };
    let free = problem.velocities.free.clone();
    let constants = if problem.every_constant { Vec::new() } else { problem.first_constants.clone() };
    let unknowns = |v: &[f64]| -> Vec<f64> { free.iter().map(|&i| v[i]).chain(constants.iter().copied()).collect() };
    let first = unknowns(&straight);
    let mut metric = Metric::new(&problem.system)?;
    let mut length = |dq: &[f64]| metric.length(start.t, &start.q, &start.v, dq);
    let mut speeds = vec![length(&way) / time, length(&start.v)];
    problem.units = vec![1.0; first.len()];
    if let Ok(reached) = problem.end(&first) {
        let mut missed = vec![0.0; n];
        problem.goal.iter().for_each(|&(i, q)| missed[i] = reached[i] - q);
        speeds.push(length(&missed) / time);
    }
    let speed = speeds.into_iter().filter(|speed| speed.is_finite()).fold(0.0, f64::max);
    let (inertia, _) = metric.inertia(start.t, &start.q, &start.v);
    let or_one = |x: f64| if x > 0.0 && x.is_finite() { x } else { 1.0 };
    let mut units: Vec<f64> = free
        .iter()
        .map(|&i| match inertia[i] > 0.0 && speed > 0.0 {
            true => speed / inertia[i],
            false => or_one(straight[i].abs().max(start.v[i].abs())),
        })
        .collect();
    // what constants do to a motion that goes nowhere in particular
    let generic = shifted(&first, &units, &spread(1, first.len()), 1.0, free.len());
    let bends = bends(&mut problem, &generic, time * BEGINNING)?;
    for (dq, constant) in bends.iter().zip(&constants) {
        let acceleration = 2.0 * metric.length(start.t, &start.q, &start.v, dq) / (time * BEGINNING).powi(2);
        let turns_once = std::f64::consts::TAU * or_one(speed) / time;
        units.push(or_one(turns_once / acceleration).max(1e-12 * constant.abs()));
    }
    let scaled = |x: &[f64]| -> Vec<f64> { x.iter().zip(&units).map(|(x, unit)| x / unit).collect() };
    let mut values = vec![scaled(&first), scaled(&unknowns(&start.v))];
    for k in 0..count.saturating_sub(2) {
        let half = BOXES[k % BOXES.len()];
        values.push(scaled(&shifted(&first, &units, &spread(k + 1, first.len()), half, first.len())));
    }
    values.truncate(count);
    let mut squares = vec![0.0; n];
    for x in &values {
        let x: Vec<f64> = x.iter().zip(&units).map(|(x, unit)| x * unit).collect();
        if let Ok((state, _)) = problem.start(&x) {
            squares.iter_mut().zip(&state.v).for_each(|(sum, v)| *sum += v * v);
        }
    }
    let typical = |i: usize| time * (squares[i] / values.len() as f64).sqrt();
    let sizes = problem.goal.iter().map(|&(i, _)| or_one(typical(i).max(way[i].abs()))).collect();
    Ok(Guesses { units, sizes, values })
}

/// Derivatives of all coordinates by the constants, early on the motion with these unknowns.
fn bends(problem: &mut TwoPoint, x: &[f64], after: f64) -> Result<Vec<Vec<f64>>, SolveError> {
    let own = x.len() - problem.velocities.free.len();
    if own == 0 {
        return Ok(Vec::new());
    }
    problem.set(x)?;
    let end = problem.scene_start.t + after;
    let options = problem.options(problem.settings.tolerance);
    let prepared = problem.varying.prepared_mut();
    let along: Vec<_> = (0..own).map(|i| prepared.along_constant(i, 1.0)).collect();
    let mut carried = VariationalRun::run(prepared, &along, end, &options, Which::Kept)?;
    let t = carried.step_times().last().copied().unwrap_or(end);
    let (_, derivatives) = carried.at(prepared, t)?;
    Ok(derivatives.into_iter().map(|outputs| outputs.coordinates).collect())
}

/// The first `moved` unknowns moved within a box.
fn shifted(x: &[f64], units: &[f64], by: &[f64], half: f64, moved: usize) -> Vec<f64> {
    let mut shifted = x.to_vec();
    for (i, x) in shifted.iter_mut().enumerate().take(moved) {
        *x += half * by[i] * units[i];
    }
    shifted
}
