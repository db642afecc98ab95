//! One step, from a node `(x_k, p_k)` to the next: two small Newton iterations with exact Jacobians.

use std::collections::HashMap;

use mechanics::fresh_symbol;
use symbolic::{CompileError, Evaluator, Expr, Graph, Symbol};

use crate::DiscreteError;
use crate::newton::{Iteration, check_finite};
use crate::sum::Compensated;

/// The symbols of one interval.
///
/// ```text
/// x̄ = x_k + h ẋ/2 ,    ẋ = (x_{k+1} − x_k)/h ,    t̄ = t_k + h/2
/// ```
pub(crate) struct Interval {
    /// `t_k`.
    t: Symbol,
    h: Symbol,
    /// `x_k`, `p_k`, `v_k`.
    left: Vec<Symbol>,
    momentum: Vec<Symbol>,
    velocity: Vec<Symbol>,
    /// `ẋ`, the unknown of the step.
    rate: Vec<Symbol>,
}

impl Interval {
    /// Fresh symbols for `size` variables.
    pub(crate) fn new(g: &Graph, t: Symbol, size: usize) -> Self {
        let fresh = |stem: &str| (0..size).map(|i| fresh_symbol(g, &format!("{stem}{i}"))).collect();
        Interval {
            t,
            h: fresh_symbol(g, "step"),
            left: fresh("left"),
            momentum: fresh("momentum"),
            velocity: fresh("velocity"),
            rate: fresh("rate"),
        }
    }

    /// `(x, ẋ, t)` at the midpoint.
    fn midpoint(&self, g: &Graph, x: &[Symbol], rates: &[Symbol]) -> HashMap<Symbol, Expr> {
        let half = g.mul(g.ratio(1, 2), g.variable(self.h));
        let mut map = HashMap::from([(self.t, g.add(g.variable(self.t), half))]);
        for i in 0..x.len() {
            let rate = g.variable(self.rate[i]);
            map.insert(x[i], g.add(g.variable(self.left[i]), g.mul(half, rate)));
            map.insert(rates[i], rate);
        }
        map
    }

    /// `(x, ẋ)` at the node.
    fn node(&self, g: &Graph, x: &[Symbol], rates: &[Symbol]) -> HashMap<Symbol, Expr> {
        let pair = |from: &[Symbol], to: &[Symbol]| -> Vec<(Symbol, Expr)> {
            from.iter().copied().zip(g.variables(to)).collect()
        };
        pair(x, &self.left).into_iter().chain(pair(rates, &self.velocity)).collect()
    }
}

/// A discrete principle, in the symbols `x`, `ẋ`, `t` of the system and the multipliers `ν`.
///
/// With `S = h 𝓛(x̄, ẋ, t̄)`, that is `D₁S = (h/2) 𝓛_x − 𝓛_ẋ` and `D₂S = (h/2) 𝓛_x + 𝓛_ẋ` at the midpoint:
///
/// ```text
/// p_k + (h/2) R(x_k, v_k) ν + D₁S + (h/2) Q = 0 ,        c(x̄, ẋ, t̄) = 0 ,
/// p_{k+1} = D₂S + (h/2) Q + (h/2) R(x_{k+1}, v_{k+1}) ν'
/// ```
///
/// where `ν'`, `v_{k+1}` follow from `p_{k+1} = 𝓛_ẋ`, `c = 0` at the node. Without `R`: `D₂S + (h/2) Q`.
pub(crate) struct Principle {
    pub(crate) x: Vec<Symbol>,
    pub(crate) rates: Vec<Symbol>,
    /// `𝓛(x, ẋ, ν, t)`.
    pub(crate) lagrangian: Expr,
    /// `Q`, zeros where there is none.
    pub(crate) forces: Vec<Expr>,
    /// `R ν`, one per variable; none where multipliers stand in `𝓛`.
    pub(crate) reaction: Option<Vec<Expr>>,
    /// `ν`.
    pub(crate) multipliers: Vec<Symbol>,
    /// `c`, one per multiplier.
    pub(crate) conditions: Vec<Expr>,
}

/// A node of the discrete motion.
#[derive(Clone, Debug)]
pub struct Node {
    /// `t_k`.
    pub t: f64,
    /// `x_k`.
    pub x: Compensated,
    /// `p_k`.
    pub p: Compensated,
    /// `v_k` where reactions need it, else a first guess for it.
    pub v: Vec<f64>,
    /// `ν` at the node, or a first guess for it.
    pub multipliers: Vec<f64>,
}

impl Node {
    /// Appends `x, p, v, ν`.
    pub(crate) fn write(&self, to: &mut Vec<f64>) {
        for part in [&self.x.value, &self.p.value, &self.v, &self.multipliers] {
            to.extend_from_slice(part);
        }
    }
}

/// A compiled `Principle`.
#[derive(Clone, Debug)]
pub struct Step {
    /// Length of `x`.
    pub size: usize,
    /// Whether reactions act at the nodes.
    pub reacts: bool,
    /// `t, h, x, p, v, ẋ, ν` → the first line of [`Principle`].
    balance: Iteration,
    /// The same → `p_{k+1} − p_k` except for the reaction at `k + 1`, then `c`.
    impulse: Evaluator<f64>,
    /// `t, h, x, p, v, ν` → `𝓛_ẋ − p` (with a reaction: `− (h/2) R ν`) and `c` at the node.
    legendre: Iteration,
    /// The same → `(h/2) R ν`.
    reaction: Evaluator<f64>,
    /// The same → `ẋ·p − 𝓛`, then `c`.
    readings: Evaluator<f64>,
    /// The last midpoint times and what solved the steps there, the last first.
    past: [Option<(f64, Vec<f64>)>; 2],
}

impl Step {
    pub(crate) fn new(
        g: &Graph,
        parameters: &HashMap<Symbol, f64>,
        interval: &Interval,
        principle: &Principle,
        guess: &[f64],
    ) -> Result<Self, DiscreteError> {
        let Principle { x, rates, lagrangian, forces, multipliers, conditions, .. } = principle;
        let size = x.len();
        let (midpoint, node) = (interval.midpoint(g, x, rates), interval.node(g, x, rates));
        let h = g.variable(interval.h);
        let half = g.mul(g.ratio(1, 2), h);
        let by_position = g.substitute_all(&g.gradient(*lagrangian, x), &midpoint);
        let momenta = g.gradient(*lagrangian, rates);
        let forces = g.substitute_all(forces, &midpoint);
        let reaction = match &principle.reaction {
            Some(reaction) => g.substitute_all(reaction, &node).into_iter().map(|r| g.mul(half, r)).collect(),
            None => vec![g.zero(); size],
        };
        let at_midpoint = g.substitute_all(&momenta, &midpoint);
        let mut residuals = Vec::with_capacity(size + conditions.len());
        let mut impulse = Vec::with_capacity(size + conditions.len());
        for i in 0..size {
            let push = g.add(by_position[i], forces[i]);
            let ends = [g.variable(interval.momentum[i]), reaction[i], g.mul(half, push), g.neg(at_midpoint[i])];
            residuals.push(g.sum(&ends));
            impulse.push(g.add(reaction[i], g.mul(h, push)));
        }
        let discrete = g.substitute_all(conditions, &midpoint);
        residuals.extend(&discrete);
        impulse.extend(&discrete);

        let p = g.variables(&interval.momentum);
        let at_node = g.substitute_all(&momenta, &node);
        let mut legendre: Vec<Expr> =
            (0..size).map(|i| g.sum(&[at_node[i], g.neg(p[i]), g.neg(reaction[i])])).collect();
        let conditions = g.substitute_all(conditions, &node);
        legendre.extend(&conditions);
        let velocity = g.variables(&interval.velocity);
        let mut readings = vec![g.sub(g.dot(&velocity, &p), g.substitute(*lagrangian, &node))];
        readings.extend(&conditions);

        let known = [vec![interval.t, interval.h], interval.left.clone(), interval.momentum.clone()].concat();
        let at_node = [&known[..], &interval.velocity, multipliers].concat();
        let over = [&known[..], &interval.velocity, &interval.rate, multipliers].concat();
        let program = |inputs: &[Symbol], outputs: &[Expr]| -> Result<_, CompileError> {
            Ok(Evaluator::new(g.compile(inputs, outputs, parameters)?))
        };
        let iteration =
            |inputs: &[Symbol], outputs: &[Expr]| Iteration::new(g, inputs, outputs, parameters, guess, size);
        Ok(Step {
            size,
            reacts: principle.reaction.is_some(),
            balance: iteration(&over, &residuals)?,
            impulse: program(&over, &impulse)?,
            legendre: iteration(&at_node, &legendre)?,
            reaction: program(&at_node, &reaction)?,
            readings: program(&at_node, &readings)?,
            past: [None, None],
        })
    }

    /// Forgets what earlier steps were solved by: the next one starts from the node's own rates.
    pub fn forget(&mut self) {
        self.past = [None, None];
    }

    /// Moves `node` by a step of length `h`, of either sign, to the time `t = t_k + h`.
    pub fn advance(&mut self, node: &mut Node, h: f64, t: f64) -> Result<(), DiscreteError> {
        let middle = node.t + 0.5 * h;
        let n = self.size;
        let mut inputs = std::mem::take(&mut self.balance.inputs);
        inputs.clear();
        inputs.extend([node.t, h]);
        for part in [&node.x.value, &node.p.value, &node.v, &node.v, &node.multipliers] {
            inputs.extend_from_slice(part);
        }
        let first = inputs.len() - n - node.multipliers.len();
        self.balance.inputs = inputs;
        let predicted = self.predict(middle, first);
        let mut solved = self.balance.solve(node.t);
        if predicted && solved.is_err() {
            let unknowns = node.v.iter().chain(&node.multipliers);
            self.balance.inputs[first..].iter_mut().zip(unknowns).for_each(|(z, guess)| *z = *guess);
            solved = self.balance.solve(node.t);
        }
        solved?;
        let changes = self.impulse.evaluate(&self.balance.inputs);
        check_finite("a momentum", t, changes)?;
        let unknowns = &self.balance.inputs[first..];
        for i in 0..n {
            node.x.add(i, h * unknowns[i]);
            node.p.add(i, changes[i]);
        }
        node.t = t;
        self.remember(middle, first);
        if self.reacts {
            self.read(node, h)?;
            let changes = self.reaction.evaluate(&self.legendre.inputs);
            for (i, change) in changes.iter().enumerate() {
                node.p.add(i, *change);
            }
        } else {
            let (v, multipliers) = self.balance.inputs[first..].split_at(n);
            node.v.copy_from_slice(v);
            node.multipliers.copy_from_slice(multipliers);
        }
        Ok(())
    }

    /// `v` and `ν` of the node from its `x` and `p`: `𝓛_ẋ = p`, `c = 0`.
    pub fn read(&mut self, node: &mut Node, h: f64) -> Result<(), DiscreteError> {
        let inputs = &mut self.legendre.inputs;
        inputs.clear();
        inputs.extend([node.t, h]);
        node.write(inputs);
        self.legendre.solve(node.t)?;
        let (v, multipliers) = self.legendre.inputs[2 + 2 * self.size..].split_at(self.size);
        node.v.copy_from_slice(v);
        node.multipliers.copy_from_slice(multipliers);
        Ok(())
    }

    /// `ẋ·p − 𝓛` and `c` at a node that was read.
    pub fn readings(&mut self, node: &Node) -> &[f64] {
        let mut inputs = vec![node.t, 0.0];
        node.write(&mut inputs);
        self.readings.evaluate(&inputs)
    }

    /// Sets the unknowns to the straight line through the last two solutions, if any, at the time `middle`.
    fn predict(&mut self, middle: f64, first: usize) -> bool {
        let [Some((t1, one)), Some((t0, zero))] = &self.past else { return false };
        let slope = (middle - t1) / (t1 - t0);
        if !slope.is_finite() || slope.abs() > 4.0 {
            return false;
        }
        for ((z, one), zero) in self.balance.inputs[first..].iter_mut().zip(one).zip(zero) {
            *z = one + slope * (one - zero);
        }
        true
    }

    fn remember(&mut self, middle: f64, first: usize) {
        self.past.swap(0, 1);
        let unknowns = &self.balance.inputs[first..];
        match &mut self.past[0] {
            Some((t, values)) => {
                *t = middle;
                values.copy_from_slice(unknowns);
            }
            none => *none = Some((middle, unknowns.to_vec())),
        }
    }
}
