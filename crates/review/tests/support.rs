//! Lagrange's equations with multipliers as somebody writes them down, with mistakes on order.

use mechanics::System;
use symbolic::{Expr, SplitMix};

/// One of `n`.
pub fn below(random: &mut SplitMix, n: usize) -> usize {
    (random.bits() % n as u64) as usize
}

/// Rows `d/dt ∂L/∂v − ∂L/∂q − Q`, rates of the constraints, and reactions.
#[derive(Clone)]
pub struct Derivation {
    pub rows: Vec<Expr>,
    pub rates: Vec<Expr>,
    /// `∂f_j/∂v_i`, constraint by constraint.
    pub reactions: Vec<Vec<Expr>>,
}

pub fn derive(system: &System) -> Derivation {
    let (g, flow) = (&system.graph, system.flow());
    let row = |i: usize| {
        let c = &system.coordinates[i];
        let momentum = g.total_derivative(g.derivative(system.lagrangian, c.velocity), &flow);
        g.sub(momentum, g.add(g.derivative(system.lagrangian, c.position), system.forces[i]))
    };
    Derivation {
        rows: (0..system.dimension()).map(row).collect(),
        rates: system.constraints.iter().map(|&f| g.total_derivative(f, &flow)).collect(),
        reactions: system.constraints.iter().map(|&f| g.gradient(f, &system.velocities())).collect(),
    }
}

/// The equations as text: in another order, each scaled, with multipliers of another name, sign and scale.
pub fn text(system: &System, derivation: &Derivation, random: &mut SplitMix) -> String {
    let g = &system.graph;
    let names = ["N", "mu", "reaction", "k", "zeta_1", "F"];
    let stem = names[below(random, names.len())];
    let unknown = |j: usize| g.variable(g.symbol(&format!("{stem}_{j}_")));
    let sign = if random.bits().is_multiple_of(2) { 1 } else { -3 };
    let mut lines: Vec<String> = Vec::new();
    for (i, &row) in derivation.rows.iter().enumerate() {
        let reaction = derivation.reactions.iter().enumerate();
        let parts: Vec<Expr> = reaction.map(|(j, a)| g.product(&[g.integer(sign), a[i], unknown(j)])).collect();
        let scale = [g.one(), g.integer(-2), g.ratio(1, 3)][below(random, 3)];
        let parameter = system.parameters.first().map_or(g.one(), |p| g.variable(p.symbol));
        let scale = if random.bits().is_multiple_of(4) { g.div(scale, parameter) } else { scale };
        let [left, right] = [row, g.sum(&parts)].map(|e| g.plain(g.mul(scale, e)));
        lines.push(if random.bits().is_multiple_of(2) {
            format!("{left} = {right}")
        } else {
            format!("0 = {right} - ({left})")
        });
    }
    lines.extend(derivation.rates.iter().map(|&f| format!("{} = 0", g.plain(f))));
    for i in (1..lines.len()).rev() {
        lines.swap(i, below(random, i + 1));
    }
    lines.join("\n")
}

/// Scenes whose equations have images in a field.
pub const SYSTEMS: [&str; 20] = [
    "sledge",
    "ball-in-cone",
    "three-cylinders",
    "particle",
    "heisenberg",
    "sleigh",
    "disc",
    "turntable",
    "bowl",
    "planar-body",
    "coin-on-incline",
    "mobile-robot",
    "falling-disc",
    "two-wheeled-carriage",
    "unicycle-in-potential",
    "turning-knife-edge",
    "nonholonomic-oscillator",
    "snakeboard",
    "roller-racer",
    "sledge-with-friction",
];

/// `q̈` of a derivation at a state, in doubles, by elimination with pivots; nothing where it is not
/// determined.
pub fn accelerations(system: &System, of: &Derivation, state: &mechanics::State) -> Option<Vec<f64>> {
    let (g, n, h) = (&system.graph, system.dimension(), of.rates.len());
    let equations = [&of.rows[..], &of.rates].concat();
    let a = system.accelerations();
    let mut values = system.values_at(state);
    values.extend(system.parameter_values());
    let number = |e: Expr, values: &_| g.evaluate(e, values).ok();
    let mut rows = Vec::new();
    for (k, &e) in equations.iter().enumerate() {
        let slope = |&s: &symbolic::Symbol| number(g.derivative(e, s), &values);
        let mut row: Vec<f64> = a.iter().map(slope).collect::<Option<_>>()?;
        let reacts = |j: usize| if k < n { number(g.neg(of.reactions[j][k]), &values) } else { Some(0.0) };
        row.extend((0..h).map(reacts).collect::<Option<Vec<f64>>>()?);
        let mut still = values.clone();
        still.extend(a.iter().map(|&s| (s, 0.0)));
        row.push(-number(e, &still)?);
        rows.push(row);
    }
    for k in 0..n + h {
        let best = (k..n + h).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, best);
        let pivot = rows[k].clone();
        if pivot[k].abs() < 1e-10 {
            return None;
        }
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k] / pivot[k];
            row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= factor * p);
        }
    }
    Some((0..n).map(|i| rows[i][n + h] / rows[i][i]).collect())
}
