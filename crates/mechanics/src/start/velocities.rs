//! The velocities that were not given.

use symbolic::Expr;

use super::data::StartData;
use super::error::StartError;
use super::numeric::{Problem, Solved};
use super::regularity::check_constraints;
use crate::newton::Root;
use crate::{State, System};

/// Two velocities closer than this part of the larger are one solution, and so is what in one that vanishes
/// is round-off of the others.
const SAME: f64 = 1e-6;
const ROUND_OFF: f64 = 1e-10;

/// Solves `problem` and evaluates the velocities `outputs`; of contradictory equations by least squares.
pub(super) fn solve_velocities(problem: &Problem, outputs: &[Expr], data: &StartData) -> Result<Vec<f64>, StartError> {
    let mut roots: Vec<(Vec<f64>, Root)> = Vec::new();
    let mut nearest: Option<Root> = None;
    let guesses = guesses(problem, data);
    for &guess in &guesses {
        match problem.solve(&data.guess, guess)? {
            Solved::Root(root) => {
                let (v, _) = problem.outputs(outputs, &root)?;
                if !roots.iter().any(|(other, _)| differing(&v, other).is_empty()) {
                    roots.push((v, root));
                }
            }
            Solved::LeastSquares(root) => {
                if nearest.as_ref().is_none_or(|other| root.residual < other.residual) {
                    nearest = Some(root);
                }
            }
            Solved::Nowhere => {}
        }
    }
    let root = match (&roots[..], &nearest) {
        ([(_, root), ..], _) | ([], Some(root)) => root,
        ([], None) => return Err(StartError::NotSolved { points: guesses.len() }),
    };
    let v = check_determined(problem, outputs, root, data)?;
    if let [(first, _), (second, _), ..] = &roots[..] {
        let differ = differing(first, second);
        return Err(StartError::Ambiguous {
            velocities: differ.iter().map(|&i| velocity_name(problem.system, i)).collect(),
            first: differ.iter().map(|&i| first[i]).collect(),
            second: differ.iter().map(|&i| second[i]).collect(),
        });
    }
    Ok(v)
}

/// Starts of unknowns without a guess: several, to see whether nonlinear equations have more solutions.
fn guesses(problem: &Problem, data: &StartData) -> Vec<f64> {
    if problem.is_linear() || !data.guess.is_empty() {
        return vec![0.0];
    }
    let speed = data.given.values().fold(0.0_f64, |a, x| a.max(x.abs()));
    let speed = if speed > 0.0 { speed } else { 1.0 };
    vec![0.0, speed, -speed]
}

/// The places of velocities that differ.
fn differing(a: &[f64], b: &[f64]) -> Vec<usize> {
    let round_off = ROUND_OFF * a.iter().chain(b).fold(0.0_f64, |size, x| size.max(x.abs()));
    let same = |i: usize| (a[i] - b[i]).abs() <= (SAME * a[i].abs().max(b[i].abs())).max(round_off);
    (0..a.len()).filter(|&i| !same(i)).collect()
}

fn velocity_name(system: &System, i: usize) -> String {
    system.graph.name(system.coordinates[i].velocity)
}

/// The velocities at `root`; none may be open. Dependent constraints are the deeper fault and come first.
fn check_determined(
    problem: &Problem,
    outputs: &[Expr],
    root: &Root,
    data: &StartData,
) -> Result<Vec<f64>, StartError> {
    let (v, open) = problem.outputs(outputs, root)?;
    if open.contains(&true) {
        let state = State { t: data.time, q: data.positions.clone(), v };
        check_constraints(problem.system, &state)?;
        let names = (0..open.len()).filter(|&i| open[i]).map(|i| velocity_name(problem.system, i));
        return Err(StartError::Undetermined { velocities: names.collect() });
    }
    Ok(v)
}
