//! One step: from a node `(x_k, p_k)` to the next by Newton's method with the exact Jacobian.

use std::collections::HashMap;

use mechanics::fresh_symbol;
use nalgebra::{DMatrix, DVector};
use symbolic::{Expr, Graph, Symbol, Tape, Workspace};

use super::DiscreteError;

/// A correction relative to 1 + the largest unknown under which a step counts as solved.
const SOLVED: f64 = 4e-15;

/// Round-off of ill-conditioned steps: corrections under this that have stopped to shrink are accepted.
const ROUND_OFF: f64 = 1e-8;

/// Newton iterations of one step.
const ITERATIONS: usize = 40;

/// The symbols of one interval: `x_k = left`, `x_{k+1} = right`, `rate = (x_{k+1} − x_k)/h`, `t_k`, `h`.
pub(super) struct Interval {
    pub(super) t: Symbol,
    pub(super) h: Symbol,
    pub(super) left: Vec<Symbol>,
    pub(super) right: Vec<Symbol>,
    /// `rate` of this interval, unknown.
    pub(super) rate: Vec<Symbol>,
    /// `rate` of the interval before.
    pub(super) rate_before: Vec<Symbol>,
}

impl Interval {
    /// Fresh symbols for `size` variables.
    pub(super) fn new(g: &Graph, t: Symbol, size: usize) -> Self {
        let fresh = |stem: &str| (0..size).map(|i| fresh_symbol(g, &format!("{stem}{i}"))).collect();
        Interval {
            t,
            h: fresh_symbol(g, "step"),
            left: fresh("left"),
            right: fresh("right"),
            rate: fresh("rate"),
            rate_before: fresh("before"),
        }
    }

    /// `x ↦ (x_k + x_{k+1})/2`, `ẋ ↦ (x_{k+1} − x_k)/h`, `t ↦ t_k + h/2`.
    pub(super) fn midpoint(&self, g: &Graph, x: &[Symbol], rates: &[Symbol]) -> HashMap<Symbol, Expr> {
        let half = |e: Expr| g.mul(g.ratio(1, 2), e);
        let mut map = HashMap::from([(self.t, g.add(g.variable(self.t), half(g.variable(self.h))))]);
        for i in 0..self.left.len() {
            let (a, b) = (g.variable(self.left[i]), g.variable(self.right[i]));
            map.insert(x[i], half(g.add(a, b)));
            map.insert(rates[i], g.div(g.sub(b, a), g.variable(self.h)));
        }
        map
    }

    /// `x ↦ x_k`, `ẋ ↦` the mean of the rates on both sides, `t ↦ t_k`.
    pub(super) fn node(&self, g: &Graph, x: &[Symbol], rates: &[Symbol]) -> HashMap<Symbol, Expr> {
        let mut map = HashMap::new();
        for i in 0..self.left.len() {
            map.insert(x[i], g.variable(self.left[i]));
            let both = g.add(g.variable(self.rate_before[i]), g.variable(self.rate[i]));
            map.insert(rates[i], g.mul(g.ratio(1, 2), both));
        }
        map
    }
}

/// A discrete principle on one interval, in the symbols of an [`Interval`] and of the multipliers `ν`.
///
/// ```text
/// p_k + D₁S + F + R = 0 ,    c = 0 ,    p_{k+1} = D₂S + F
/// ```
pub(super) struct Principle {
    /// `S(x_k, x_{k+1}, ν)`, the action of the interval.
    pub(super) action: Expr,
    /// `F`, half the impulse of the forces on the interval.
    pub(super) impulse: Vec<Expr>,
    /// `R`, the impulse of the reaction at the node `k`.
    pub(super) reaction: Vec<Expr>,
    /// `ν`.
    pub(super) multipliers: Vec<Symbol>,
    /// `c`, one a multiplier.
    pub(super) conditions: Vec<Expr>,
}

/// A node of the discrete motion.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) t: f64,
    pub(super) x: Vec<f64>,
    pub(super) p: Vec<f64>,
    /// `(x_k − x_{k−1})/h`.
    pub(super) rate_before: Vec<f64>,
}

/// A compiled [`Principle`].
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Length of `x`.
    pub(super) size: usize,
    /// Whether the reaction depends on velocities.
    pub(super) looks_back: bool,
    /// Residuals, then their Jacobian row by row.
    balance: Program,
    /// `p_{k+1}`.
    momentum: Program,
}

/// A tape with its registers and outputs; all tapes of a step have the same inputs.
#[derive(Clone, Debug)]
struct Program {
    tape: Tape,
    workspace: Workspace<f64>,
    outputs: Vec<f64>,
}

impl Program {
    fn evaluate(&mut self, inputs: &[f64]) -> &[f64] {
        self.tape.evaluate(inputs, &mut self.workspace, &mut self.outputs);
        &self.outputs
    }
}

impl Step {
    pub(super) fn new(
        g: &Graph,
        parameters: &HashMap<Symbol, f64>,
        interval: &Interval,
        principle: &Principle,
    ) -> Result<Self, DiscreteError> {
        let size = interval.left.len();
        let momenta: Vec<Symbol> = (0..size).map(|i| fresh_symbol(g, &format!("momentum{i}"))).collect();
        // x_{k+1} = x_k + h·rate only after D₁ and D₂ have been taken.
        let advance: HashMap<Symbol, Expr> = (0..size)
            .map(|i| {
                let way = g.mul(g.variable(interval.h), g.variable(interval.rate[i]));
                (interval.right[i], g.add(g.variable(interval.left[i]), way))
            })
            .collect();
        let left = g.gradient(principle.action, &interval.left);
        let right = g.gradient(principle.action, &interval.right);
        let mut residuals: Vec<Expr> = (0..size)
            .map(|i| g.sum(&[g.variable(momenta[i]), left[i], principle.impulse[i], principle.reaction[i]]))
            .collect();
        residuals.extend(&principle.conditions);
        let residuals = g.substitute_all(&residuals, &advance);
        let ends: Vec<Expr> = (0..size).map(|i| g.add(right[i], principle.impulse[i])).collect();
        let ends = g.substitute_all(&ends, &advance);

        let unknowns: Vec<Symbol> = interval.rate.iter().chain(&principle.multipliers).copied().collect();
        let mut inputs = vec![interval.t, interval.h];
        inputs.extend(interval.left.iter().chain(&momenta).chain(&interval.rate_before).chain(&unknowns));
        let program = |outputs: &[Expr]| -> Result<Program, DiscreteError> {
            let tape = g.compile(&inputs, outputs, parameters)?;
            Ok(Program { workspace: tape.workspace(), outputs: vec![0.0; tape.outputs()], tape })
        };
        let mut balance = residuals.clone();
        balance.extend(g.jacobian(&residuals, &unknowns).entries());
        let looks_back = residuals.iter().any(|&e| interval.rate_before.iter().any(|&s| g.depends_on(e, s)));
        Ok(Step { size, looks_back, balance: program(&balance)?, momentum: program(&ends)? })
    }

    /// Solves the step of length `h` from `node` for `(rate, ν)`, from the guess in `unknowns`.
    pub(super) fn solve(&mut self, node: &Node, h: f64, unknowns: &mut [f64]) -> Result<(), DiscreteError> {
        let count = unknowns.len();
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let outputs = self.balance.evaluate(&inputs(node, h, unknowns));
            check_finite("an equation of a step", node.t, outputs)?;
            let (residuals, jacobian) = outputs.split_at(count);
            let correction = solve_linear(node.t, jacobian, residuals)?;
            let scale = 1.0 + largest(unknowns);
            unknowns.iter_mut().zip(correction.iter()).for_each(|(z, dz)| *z -= dz);
            let found = largest(correction.as_slice()) / scale;
            if found <= SOLVED || (found <= ROUND_OFF && found >= 0.5 * before) {
                return Ok(());
            }
            before = found;
        }
        Err(DiscreteError::NotConverged { t: node.t, iterations: ITERATIONS, found: before, limit: SOLVED })
    }

    /// The node after `node` at the time `t = t_k + h`, with the `unknowns` of [`Step::solve`].
    pub(super) fn next(&mut self, node: &Node, h: f64, unknowns: &[f64], t: f64) -> Result<Node, DiscreteError> {
        let p = self.momentum.evaluate(&inputs(node, h, unknowns)).to_vec();
        check_finite("a momentum", t, &p)?;
        let rate_before = unknowns[..self.size].to_vec();
        let x = node.x.iter().zip(&rate_before).map(|(x, v)| x + h * v).collect();
        Ok(Node { t, x, p, rate_before })
    }

    /// The first rates: `rate_before` of the start is not given but follows from the step backwards, with which the reaction at the
    /// start is the same one from both sides. Leaves the solution of the step forwards in `unknowns`.
    pub(super) fn start(&mut self, node: &mut Node, h: f64, unknowns: &mut [f64]) -> Result<(), DiscreteError> {
        self.solve(node, h, unknowns)?;
        if !self.looks_back {
            return Ok(());
        }
        let mut backwards = unknowns.to_vec();
        backwards.iter_mut().skip(self.size).for_each(|reaction| *reaction = -*reaction);
        let mut change = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let mut mirrored = node.clone();
            mirrored.rate_before.copy_from_slice(&unknowns[..self.size]);
            self.solve(&mirrored, -h, &mut backwards)?;
            node.rate_before.copy_from_slice(&backwards[..self.size]);
            let old = unknowns.to_vec();
            self.solve(node, h, unknowns)?;
            let scale = 1.0 + largest(unknowns);
            let found = unknowns.iter().zip(&old).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
            if found <= SOLVED || (found <= ROUND_OFF && found >= 0.5 * change) {
                return Ok(());
            }
            change = found;
        }
        Err(DiscreteError::NotConverged { t: node.t, iterations: ITERATIONS, found: change, limit: SOLVED })
    }
}

fn inputs(node: &Node, h: f64, unknowns: &[f64]) -> Vec<f64> {
    let parts = node.x.iter().chain(&node.p).chain(&node.rate_before).chain(unknowns);
    [node.t, h].into_iter().chain(parts.copied()).collect()
}

/// `jacobian⁻¹ residuals`, rows scaled to largest entry 1.
fn solve_linear(t: f64, jacobian: &[f64], residuals: &[f64]) -> Result<DVector<f64>, DiscreteError> {
    let count = residuals.len();
    let mut matrix = DMatrix::from_row_slice(count, count, jacobian);
    let mut right = DVector::from_column_slice(residuals);
    for i in 0..count {
        let scale = matrix.row(i).amax();
        if scale == 0.0 {
            return Err(DiscreteError::Singular { t });
        }
        matrix.row_mut(i).scale_mut(1.0 / scale);
        right[i] /= scale;
    }
    let solution = matrix.full_piv_lu().solve(&right).ok_or(DiscreteError::Singular { t })?;
    check_finite("a correction", t, solution.as_slice())?;
    Ok(solution)
}

pub(super) fn check_finite(what: &'static str, t: f64, values: &[f64]) -> Result<(), DiscreteError> {
    match values.iter().find(|x| !x.is_finite()) {
        None => Ok(()),
        Some(&found) => Err(DiscreteError::NotFinite { what, found, t }),
    }
}

/// `max |a_i|`, 0 for none.
pub(super) fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m, x| m.max(x.abs()))
}
