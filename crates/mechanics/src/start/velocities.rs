//! The velocities that were not given.

use symbolic::{Expr, Symbol};

use super::data::{StartNumbers, StartShape};
use super::error::StartError;
use super::numeric::{Problem, Solved};
use super::regularity::Regularity;
use crate::newton::Root;
use crate::{State, System};

/// Two velocities closer than this part of the larger are one solution, and so is what in one that vanishes
/// is round-off of the others.
const SAME: f64 = 1e-6;
const ROUND_OFF: f64 = 1e-10;

/// The equations for the velocities that were not given, compiled.
#[derive(Clone)]
pub(super) struct VelocityProgram {
    problem: Problem,
    /// Names of the velocities.
    names: Vec<String>,
    /// Which number of a guess each unknown has.
    guessed: Vec<Option<usize>>,
    /// Whether more than one start of the search is needed.
    several: bool,
}

impl VelocityProgram {
    /// `outputs` are the velocities.
    pub(super) fn new(system: &System, shape: &StartShape, equations: &[Expr], outputs: &[Expr]) -> Self {
        let known = [&system.positions()[..], &[system.time], shape.given, shape.varied].concat();
        let problem = Problem::new(system, equations, outputs, &known, &[]);
        let place = |unknown: &Symbol| shape.guessed.iter().position(|s| s == unknown);
        VelocityProgram {
            names: system.velocities().into_iter().map(|s| system.graph.name(s)).collect(),
            guessed: problem.unknowns.iter().map(place).collect(),
            several: !problem.is_linear && shape.guessed.is_empty(),
            problem,
        }
    }

    /// The state with these velocities; of contradictory equations by least squares. None may be open:
    /// dependent constraints are the deeper fault and come first. Where equations that are not linear have no
    /// real solution, also the velocities that were looked for.
    pub(super) fn solve(
        &mut self,
        numbers: &StartNumbers,
        regularity: &mut Regularity,
    ) -> Result<(State, Option<Vec<String>>), StartError> {
        let StartNumbers { time, positions, given, guess, varied } = numbers;
        let expected = self.names.len();
        if positions.len() != expected {
            return Err(StartError::WrongLength { found: positions.len(), expected });
        }
        let known = [&positions[..], &[*time], given, varied].concat();
        let mut roots: Vec<(Vec<f64>, Vec<bool>)> = Vec::new();
        let mut nearest: Option<Root> = None;
        let guesses = self.guesses(given);
        for &default in &guesses {
            let start: Vec<f64> = self.guessed.iter().map(|place| place.map_or(default, |i| guess[i])).collect();
            match self.problem.solve(&known, &[], &start)? {
                Solved::Root(root) => {
                    let (v, open) = self.problem.outputs(&known, &root)?;
                    if !roots.iter().any(|(other, _)| differing(&v, other).is_empty()) {
                        roots.push((v, open));
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
        let unsolved = roots.is_empty();
        if let (true, Some(root)) = (unsolved, &nearest) {
            roots.push(self.problem.outputs(&known, root)?);
        }
        let Some((v, open)) = roots.first() else { return Err(StartError::NotSolved { points: guesses.len() }) };
        let state = State { t: *time, q: positions.clone(), v: v.clone() };
        let names = |places: &[usize]| places.iter().map(|&i| self.names[i].clone()).collect();
        if unsolved && !self.problem.is_linear {
            let open: Vec<usize> = (0..open.len()).filter(|&i| open[i]).collect();
            let looked_for = if open.is_empty() { None } else { Some(names(&open)) };
            return Ok((state, looked_for));
        }
        if open.contains(&true) {
            regularity.check_constraints(&state, varied)?;
            let open: Vec<usize> = (0..open.len()).filter(|&i| open[i]).collect();
            return Err(StartError::Undetermined { velocities: names(&open) });
        }
        if let Some((second, _)) = roots.get(1) {
            let differ = differing(v, second);
            return Err(StartError::Ambiguous {
                velocities: names(&differ),
                first: differ.iter().map(|&i| v[i]).collect(),
                second: differ.iter().map(|&i| second[i]).collect(),
            });
        }
        Ok((state, None))
    }

    /// Starts of unknowns without a guess: several, to see whether nonlinear equations have more solutions.
    fn guesses(&self, given: &[f64]) -> Vec<f64> {
        if !self.several {
            return vec![0.0];
        }
        let speed = given.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let speed = if speed > 0.0 { speed } else { 1.0 };
        vec![0.0, speed, -speed]
    }
}

/// The places of velocities that differ.
fn differing(a: &[f64], b: &[f64]) -> Vec<usize> {
    let round_off = ROUND_OFF * a.iter().chain(b).fold(0.0_f64, |size, x| size.max(x.abs()));
    let same = |i: usize| (a[i] - b[i]).abs() <= (SAME * a[i].abs().max(b[i].abs())).max(round_off);
    (0..a.len()).filter(|&i| !same(i)).collect()
}
