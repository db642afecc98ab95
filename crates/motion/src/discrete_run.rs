//! A discrete motion as states of the derived equations.

use std::f64::consts::PI;

use discrete::{DiscreteError, Trajectory};
use equations::{Compiled, Equations, EvaluationFailure};
use integrate::{GAUGE_LIMIT, GAUGE_NODES, cosine, gauge_growth, may_lose_rank, orthonormal};
use mechanics::System;
use symbolic::Symbol;
use symbolic::limits::{ITERATIONS, SAME};

use crate::ending::in_own_names;
use crate::start_values::StartValues;
use crate::{Prepared, SolveError};

/// A discrete trajectory; its `(x, v, ν)` give states `y` by the derivation's expressions of start values.
#[derive(Clone)]
pub(crate) struct DiscreteRun {
    trajectory: Trajectory,
    values: StartValues,
    /// Where the time, the `x`, the `v` and the multipliers go in the inputs of `values`, and which of these.
    time: usize,
    positions: Vec<(usize, usize)>,
    rates: Vec<(usize, usize)>,
    multipliers: Vec<(usize, usize)>,
}

/// That equal steps pass over what a function does within one of them, which begins at `t`.
pub(crate) struct PassedOver {
    pub(crate) t: f64,
    pub(crate) cause: String,
}

impl DiscreteRun {
    pub(crate) fn new(trajectory: Trajectory, mut values: StartValues, equations: &Equations, system: &System) -> Self {
        let places = |of: &[Symbol]| of.iter().enumerate().filter_map(|(i, &s)| Some((values.place(s)?, i))).collect();
        let (x, v) = match &equations.removal {
            None => (system.positions(), system.velocities()),
            Some(removal) => {
                let memory = removal.memory.iter().map(|w| w.symbol);
                let x = removal.parameters.iter().map(|u| u.symbol).chain(memory).collect();
                (x, removal.parameters.iter().map(|u| u.rate).collect())
            }
        };
        let constants = &equations.free_constants;
        let first = values.first_constant(constants.len());
        let (time, positions, rates) = (values.place(system.time).unwrap_or(0), places(&x), places(&v));
        // what a discrete motion does not know may not be asked for
        values.inputs.fill(f64::NAN);
        let multipliers = constants.iter().enumerate().map(|(i, c)| (first + i, c.memory.unwrap_or(i))).collect();
        DiscreteRun { trajectory, values, time, positions, rates, multipliers }
    }

    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.times()[0], self.trajectory.end()]
    }

    /// The first step that knows nothing of what is within it, on the straight line from node to node: a step
    /// knows its middle only. The gauge of a steep function grows as [`integrate::Problem::gauges`] does not
    /// let it, or the rates jump with the angle of a point. `kept` is the length of the steps of the run that
    /// is kept. Nodes whose outputs cannot be evaluated are not part of the motion. Two steps along which the
    /// constraints may lose rank are too long to tell on which branch the motion goes on; `columns` are
    /// [`column_factors`].
    pub(crate) fn passed_over(&mut self, prepared: &mut Prepared, kept: f64, columns: &[f64]) -> Option<PassedOver> {
        let Prepared { compiled, equations, .. } = prepared;
        let angles = equations.angles();
        let (h, n) = compiled.rank();
        if compiled.gauges().is_empty() && angles.is_empty() && h == 0 {
            return None;
        }
        let mut from: Option<Node> = None;
        let mut minors: Vec<(f64, Vec<f64>)> = Vec::new();
        for t in self.times().to_vec() {
            let mut y = vec![0.0; compiled.dimension()];
            let Ok(()) = self.state(compiled, t, &mut y) else { break };
            if h > 0 {
                let mut rows = vec![0.0; h * n];
                let Ok(()) = compiled.rows(t, &y, &mut rows) else { break };
                rows.chunks_exact_mut(n).for_each(|row| row.iter_mut().zip(columns).for_each(|(x, c)| *x *= c));
                if minors.len() == 3 {
                    minors.remove(0);
                }
                minors.push((orthonormal(&mut rows, h), rows));
                let turns = minors.windows(2).any(|pair| cosine(&pair[0].1, &pair[1].1, h) < TURNED);
                let falls = match &minors[..] {
                    [a, b, c] => may_lose_rank([a.0, b.0, c.0], [&a.1, &b.1, &c.1], h),
                    _ => false,
                };
                if turns || falls {
                    let cause = format!(
                        "steps of {kept:.3e} are too long to tell whether the rank of ∂f/∂v falls within them, where several \
                         motions or none go on; shorter ones may tell, or a method that chooses its own"
                    );
                    return Some(PassedOver { t: from.map_or(t, |from| from.0), cause });
                }
            }
            let Some(from) = from.replace((t, y.clone())) else { continue };
            let begin = from.0;
            let Ok(jump) = jump(compiled, &from, &(t, y.clone())) else { break };
            if let Some(j) = jump {
                let angle = in_own_names(equations, angles[j]);
                let cause = format!(
                    "a step of {kept:.3e} passes over a jump of the rates, where {angle} passes from π to −π; steps can \
                     end there by `breakpoints`, or take a method that chooses its own"
                );
                return Some(PassedOver { t: begin, cause });
            }
            if let (j, true) = steepest(compiled, &from, &(t, y.clone())) {
                let (mut from, mut to, mut share) = (from, (t, y), 1.0);
                while share > f64::EPSILON && steepest(compiled, &from, &to).1 {
                    let middle = between(&from, &to, 0.5);
                    // the half where it is steeper
                    match steepest(compiled, &from, &middle).1 {
                        true => to = middle,
                        false => from = middle,
                    }
                    share *= 0.5;
                }
                let steep = equations.steep()[j];
                let function = format!("{} of {}", steep.function, in_own_names(equations, steep.argument));
                let enough = share * kept;
                let cause = format!(
                    "a step of {kept:.3e} passes over what {function} does; steps of {enough:.3e} would do there, or a method that chooses its own"
                );
                return Some(PassedOver { t: begin, cause });
            }
        }
        None
    }

    pub(crate) fn times(&self) -> &[f64] {
        self.trajectory.times()
    }

    /// Writes the state at `t`; sets the guess from which the equations of the instant are solved.
    pub(crate) fn state(&mut self, compiled: &mut Compiled, t: f64, state: &mut [f64]) -> Result<(), SolveError> {
        let sample = self.trajectory.at(t)?;
        self.values.inputs[self.time] = t;
        for (places, values) in
            [(&self.positions, &sample.x), (&self.rates, &sample.v), (&self.multipliers, &sample.multipliers)]
        {
            for &(place, i) in places {
                self.values.inputs[place] = values[i];
            }
        }
        let (y, guess) = self.values.evaluate();
        if let Some(&found) = y.iter().chain(guess).find(|x| !x.is_finite()) {
            return Err(DiscreteError::NotFinite { what: "a state", found, t }.into());
        }
        state.copy_from_slice(y);
        if compiled.needs_guess() && !guess.is_empty() {
            compiled.set_guess(guess);
        }
        Ok(())
    }
}

/// Minors that turn by more than this cosine within a step may have vanished in it: of branches that cross, a
/// step may lead from one to the other, at a right angle.
const TURNED: f64 = 0.5;

/// Time and state.
type Node = (f64, Vec<f64>);

fn between(from: &Node, to: &Node, theta: f64) -> Node {
    let at = |a: f64, b: f64| a + theta * (b - a);
    (at(from.0, to.0), from.1.iter().zip(&to.1).map(|(a, b)| at(*a, *b)).collect())
}

/// The first angle that passes from π to −π or back from node to node, where the rates jump with it.
fn jump(compiled: &mut Compiled, from: &Node, to: &Node) -> Result<Option<usize>, EvaluationFailure> {
    let places: [Node; GAUGE_NODES] = std::array::from_fn(|k| between(from, to, k as f64 / (GAUGE_NODES - 1) as f64));
    for pair in places.windows(2) {
        let passes = |a: f64, b: f64| (a - b).abs() > PI;
        let (low, high) = (compiled.angles(pair[0].0, &pair[0].1)?, compiled.angles(pair[1].0, &pair[1].1)?);
        for j in (0..low.len()).filter(|&j| passes(low[j], high[j])) {
            let (mut low, mut high) = (pair[0].clone(), pair[1].clone());
            for _ in 0..ITERATIONS {
                let middle = between(&low, &high, 0.5);
                match passes(compiled.angles(low.0, &low.1)?[j], compiled.angles(middle.0, &middle.1)?[j]) {
                    true => high = middle,
                    false => low = middle,
                }
            }
            let [mut before, mut behind] = [vec![0.0; low.1.len()], vec![0.0; low.1.len()]];
            let read = compiled.rates(low.0, &low.1, &mut before).and(compiled.rates(high.0, &high.1, &mut behind));
            let largest = before.iter().chain(&behind).fold(0.0_f64, |most, x| most.max(x.abs()));
            let jumps = |(a, b): (&f64, &f64)| (a - b).abs() > SAME * largest;
            if read.is_err() || before.iter().zip(&behind).any(jumps) {
                return Ok(Some(j));
            }
        }
    }
    Ok(None)
}

/// The gauge that grows most from node to node, and whether it grows too much.
fn steepest(compiled: &mut Compiled, from: &Node, to: &Node) -> (usize, bool) {
    let gauges = compiled.gauges().to_vec();
    let along: [Vec<f64>; GAUGE_NODES] = std::array::from_fn(|k| {
        let (t, y) = between(from, to, k as f64 / (GAUGE_NODES - 1) as f64);
        let mut arguments = vec![0.0; gauges.len()];
        // nothing is known of what an instant that cannot be solved does
        compiled.gauged(t, &y, &mut arguments).unwrap_or_else(|_| arguments.fill(f64::NAN));
        arguments
    });
    let growth = |j: usize| gauge_growth(gauges[j], &std::array::from_fn(|k| along[k][j]));
    let (j, growth) = (0..gauges.len()).map(|j| (j, growth(j))).max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
    (j, growth > GAUGE_LIMIT)
}
