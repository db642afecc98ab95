//! The velocities that were not given.

use symbolic::limits::{DEPENDENT, SAME};
use symbolic::{Expr, Symbol};

use super::data::{StartNumbers, StartShape};
use super::error::StartError;
use super::numeric::{Problem, Solved};
use super::regularity::Regularity;
use crate::newton::Root;
use crate::{State, System};

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
    /// Start equations are those from here on.
    first_own: usize,
}

/// Velocities found from some conditions.
pub(super) struct Attempt {
    /// The first solution, or the nearest to one.
    pub(super) state: State,
    /// Whether it is not a solution.
    pub(super) unsolved: bool,
    root: Root,
    /// Velocities that are left open.
    open: Vec<usize>,
    /// Another solution.
    second: Option<Vec<f64>>,
}

impl VelocityProgram {
    /// `outputs` are the velocities; the `equations` from `first_own` on are start equations.
    pub(super) fn new(
        system: &System,
        shape: &StartShape,
        equations: &[Expr],
        first_own: usize,
        outputs: &[Expr],
    ) -> Self {
        let known = [&system.positions()[..], &[system.time], shape.given, shape.varied].concat();
        let problem = Problem::new(system, equations, outputs, &known, &[]);
        let place = |unknown: &Symbol| shape.guessed.iter().position(|s| s == unknown);
        let guessed: Vec<_> = problem.unknowns.iter().map(place).collect();
        VelocityProgram {
            names: system.velocities().into_iter().map(|s| system.graph.name(s)).collect(),
            several: !problem.is_linear && guessed.iter().all(Option::is_none),
            guessed,
            problem,
            first_own,
        }
    }

    pub(super) fn is_linear(&self) -> bool {
        self.problem.is_linear
    }

    /// The state with these velocities; of contradictory equations by least squares. None may be open:
    /// dependent constraints are the deeper fault and come first. Where equations that are not linear have no
    /// real solution, also the velocities that were looked for.
    pub(super) fn solve(
        &mut self,
        numbers: &StartNumbers,
        regularity: &mut Regularity,
    ) -> Result<(State, Option<Vec<String>>), StartError> {
        let Attempt { state, unsolved, root, open, second } = self.attempt(numbers)?;
        let names = |places: &[usize]| places.iter().map(|&i| self.names[i].clone()).collect();
        if unsolved && !self.problem.is_linear {
            let looked_for = if open.is_empty() { None } else { Some(names(&open)) };
            return Ok((state, looked_for));
        }
        if !open.is_empty() {
            let velocities = names(&open);
            regularity.check_constraints(&state, &numbers.varied)?;
            let idle = self.problem.idle(&self.known(numbers), &root, self.first_own)?;
            let idle = idle.into_iter().map(|i| i - self.first_own + 1).collect();
            return Err(StartError::Undetermined { velocities, idle });
        }
        if let Some(second) = second {
            let differ = differing(&state.v, &second);
            return Err(StartError::Ambiguous {
                velocities: names(&differ),
                first: differ.iter().map(|&i| state.v[i]).collect(),
                second: differ.iter().map(|&i| second[i]).collect(),
            });
        }
        Ok((state, None))
    }

    fn known(&self, numbers: &StartNumbers) -> Vec<f64> {
        let StartNumbers { time, positions, given, varied, .. } = numbers;
        [&positions[..], &[*time], given, varied].concat()
    }

    /// The state with these velocities, whatever is open or contradictory.
    pub(super) fn attempt(&mut self, numbers: &StartNumbers) -> Result<Attempt, StartError> {
        let StartNumbers { time, positions, given, guess, .. } = numbers;
        let expected = self.names.len();
        if positions.len() != expected {
            return Err(StartError::WrongLength { found: positions.len(), expected });
        }
        let known = self.known(numbers);
        let mut roots: Vec<(Root, Vec<f64>, Vec<bool>)> = Vec::new();
        let mut nearest: Option<Root> = None;
        let guesses = self.guesses(given);
        for &default in &guesses {
            let start: Vec<f64> = self.guessed.iter().map(|place| place.map_or(default, |i| guess[i])).collect();
            match self.problem.solve(&known, &[], &start)? {
                Solved::Root(root) => {
                    let (v, open) = self.problem.outputs(&known, &root)?;
                    if !roots.iter().any(|(_, other, _)| differing(&v, other).is_empty()) {
                        roots.push((root, v, open));
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
        if let (true, Some(root)) = (unsolved, nearest) {
            let (v, open) = self.problem.outputs(&known, &root)?;
            roots.push((root, v, open));
        }
        let mut roots = roots.into_iter();
        let Some((root, v, open)) = roots.next() else { return Err(StartError::NotSolved { points: guesses.len() }) };
        let open = (0..open.len()).filter(|&i| open[i]).collect();
        let state = State { t: *time, q: positions.clone(), v };
        Ok(Attempt { state, unsolved, root, open, second: roots.next().map(|(_, v, _)| v) })
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
    let round_off = DEPENDENT * a.iter().chain(b).fold(0.0_f64, |size, x| size.max(x.abs()));
    let same = |i: usize| (a[i] - b[i]).abs() <= (SAME * a[i].abs().max(b[i].abs())).max(round_off);
    (0..a.len()).filter(|&i| !same(i)).collect()
}
