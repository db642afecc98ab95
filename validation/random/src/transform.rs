//! The same system written differently: what a formulation may not depend on, and systems built from it.

use std::collections::HashMap;

use equations::Equations;
use mechanics::{ConstantsRule, Removal, State, System};
use scene::Scene;
use symbolic::{Expr, Matrix, Symbol};

/// Units: `q_i = a_i q̂_i`, `t = τ t̂`, `L̂ = κ L`, `f̂ = c f`. `τ = −1`, all else 1: the motion backwards.
///
/// Then `v_i = a_i v̂_i / τ`, `μ̂ = κ μ / c`, and of a removal `B̂_k = τ B_k / a_k`, `P̂_k = κ a_k P_k / τ`.
#[derive(Clone, Debug)]
pub struct Scaling {
    /// `a`, length n.
    pub lengths: Vec<f64>,
    /// `τ`.
    pub time: f64,
    /// `κ`.
    pub action: f64,
    /// `c`.
    pub constraint: f64,
}

impl Scaling {
    /// The motion run backwards.
    pub fn reversal(n: usize) -> Scaling {
        Scaling { lengths: vec![1.0; n], time: -1.0, action: 1.0, constraint: 1.0 }
    }

    fn map(&self, system: &System) -> HashMap<Symbol, Expr> {
        let g = &system.graph;
        // quotients of decimals stay what they are
        let scaled = |(a, over): (f64, f64), s: Symbol| (s, g.mul(g.div(g.number(a), g.number(over)), g.variable(s)));
        let coordinates = system.coordinates.iter().zip(&self.lengths);
        coordinates
            .flat_map(|(c, &a)| [scaled((a, 1.0), c.position), scaled((a, self.time), c.velocity)])
            .chain([scaled((self.time, 1.0), system.time)])
            .collect()
    }

    /// The system in the new units, under the same names.
    pub fn system(&self, system: &System) -> System {
        let mut scaled = system.clone();
        let g = &scaled.graph;
        let map = self.map(&scaled);
        let by = |factor: Expr, e: Expr| g.mul(factor, g.substitute(e, &map));
        let rewritten = |factor: f64, e: Expr| by(g.number(factor), e);
        let lagrangian = rewritten(self.action, system.lagrangian);
        let constraints = system.constraints.iter().map(|&f| rewritten(self.constraint, f)).collect();
        // virtual work Q dq is an L, too
        let work = |(&q, &a): (&Expr, &f64)| by(g.mul(g.number(self.action), g.number(a)), q);
        let forces = system.forces.iter().zip(&self.lengths).map(work).collect();
        (scaled.lagrangian, scaled.constraints, scaled.forces) = (lagrangian, constraints, forces);
        scaled.domains = g.substitute_all(&system.domains, &map);
        scaled.virtual_conditions = g.substitute_all(&system.virtual_conditions, &map);
        scaled.breakpoints.iter_mut().for_each(|t| *t /= self.time);
        for watched in &mut scaled.watched {
            watched.expression = g.substitute(watched.expression, &map);
        }
        scaled
    }

    /// The scene in the new units: the system, its start as written, removals, multipliers, duration.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let system = self.system(&scene.system);
        let (g, map) = (&system.graph, self.map(&system));
        let written = |(s, e): &(Symbol, Expr)| {
            let place = |symbols: Vec<Symbol>| symbols.iter().position(|x| x == s);
            let (position, velocity) = (place(system.positions()), place(system.velocities()));
            // a parameter of a removal keeps its unit, but for time
            let length = position.or(velocity).map_or(1.0, |i| self.lengths[i]);
            let rate = if position.is_some() { 1.0 } else { self.time };
            (*s, g.div(g.mul(g.number(rate), g.substitute(*e, &map)), g.number(length)))
        };
        let mut scaled = scene.clone();
        scaled.completion.written = scene.completion.written.iter().map(written).collect();
        scaled.completion.guessed = scene.completion.guessed.iter().map(written).collect();
        scaled.completion.equations = g.substitute_all(&scene.completion.equations, &map);
        scaled.removals = scene.removals.iter().map(|removal| self.removal(&system, removal)).collect();
        scaled.start = self.state(&scene.start);
        scaled.multipliers = self.multipliers(&scene.multipliers);
        scaled.duration = scene.duration / self.time;
        scaled.system = system;
        scaled
    }

    /// A state in the new units.
    pub fn state(&self, state: &State) -> State {
        let scaled = |xs: &[f64], by: f64| xs.iter().zip(&self.lengths).map(|(x, a)| by * x / a).collect();
        State { t: state.t / self.time, q: scaled(&state.q, 1.0), v: scaled(&state.v, self.time) }
    }

    /// A removal in the new units, of the `scaled` system. Parameters and memory that are not coordinates
    /// keep their unit except for time; costates `P` are scaled where one is given for each memory variable.
    pub fn removal(&self, scaled: &System, removal: &Removal) -> Removal {
        let g = &scaled.graph;
        let mut map = self.map(scaled);
        // quotients of decimals stay what they are
        let [one, time] = [1.0, self.time].map(|x| g.number(x));
        let over = |a: Expr, b: Expr| g.div(a, b);
        let mut scaled_by = |s: Symbol, by: Expr| map.insert(s, g.mul(by, g.variable(s)));
        for (c, &a) in scaled.coordinates.iter().zip(&self.lengths) {
            scaled_by(c.acceleration, over(g.number(a), g.powi(time, 2)));
        }
        let own: Vec<_> = removal.parameters.iter().filter(|u| u.coordinate.is_none()).collect();
        for u in &own {
            scaled_by(u.rate, over(one, time));
            scaled_by(u.second_rate, over(one, g.powi(time, 2)));
        }
        let rewritten = |factor: Expr, e: Expr| g.mul(factor, g.substitute(e, &map));
        let mut removal = removal.clone();
        for w in &mut removal.memory {
            w.rate = rewritten(over(time, g.number(w.coordinate.map_or(1.0, |i| self.lengths[i]))), w.rate);
        }
        for ((e, own), &a) in removal.coordinates.iter_mut().zip(scaled.positions()).zip(&self.lengths) {
            if *e != g.variable(own) {
                *e = rewritten(over(one, g.number(a)), *e);
            }
        }
        removal.chart = g.substitute_all(&removal.chart, &map);
        for (s, start) in &mut removal.start {
            // what the parameter's own rate is at the start has the new unit of time too
            *start = rewritten(if own.iter().any(|u| u.rate == *s) { time } else { one }, *start);
        }
        removal.constants = match &removal.constants {
            ConstantsRule::Zero => ConstantsRule::Zero,
            ConstantsRule::Given(values) if values.len() == removal.memory.len() => {
                ConstantsRule::Given(self.costates(&removal, values))
            }
            ConstantsRule::Given(values) => ConstantsRule::Given(values.clone()),
            ConstantsRule::Natural { horizon } => ConstantsRule::Natural { horizon: horizon / self.time },
        };
        removal
    }

    /// Multipliers `μ̂`.
    pub fn multipliers(&self, multipliers: &[f64]) -> Vec<f64> {
        multipliers.iter().map(|mu| self.action * mu / self.constraint).collect()
    }

    /// Costates `P̂`.
    pub fn costates(&self, removal: &Removal, costates: &[f64]) -> Vec<f64> {
        let length = |i: usize| removal.memory[i].coordinate.map_or(1.0, |c| self.lengths[c]);
        costates.iter().enumerate().map(|(i, p)| self.action * length(i) * p / self.time).collect()
    }

    /// Equations of the scaled system whose outputs are in the old units.
    pub fn outputs(&self, mut equations: Equations) -> Equations {
        let g = &equations.graph;
        let scaled = |es: &[Expr], over: f64| -> Vec<Expr> {
            es.iter().zip(&self.lengths).map(|(&e, &a)| g.mul(g.div(g.number(a), g.number(over)), e)).collect()
        };
        let (coordinates, velocities) = (scaled(&equations.coordinates, 1.0), scaled(&equations.velocities, self.time));
        (equations.coordinates, equations.velocities, equations.chart) = (coordinates, velocities, None);
        equations
    }
}

/// The system with constraints `G f`.
pub fn recombined(system: &System, mixing: &Matrix) -> System {
    let mut other = system.clone();
    other.constraints = other.graph.mat_vec(mixing, &system.constraints);
    other
}

/// The system in coordinates `y` with `q_i = y_i + shift_i(y)`, under the same names.
pub struct Rewritten {
    /// The system in the new coordinates.
    pub system: System,
    positions: Vec<Expr>,
    velocities: Vec<Expr>,
}

impl Rewritten {
    /// `shift` are expressions in the positions.
    pub fn new(system: &System, shift: &[Expr]) -> Rewritten {
        let mut other = system.clone();
        let g = &other.graph;
        let flow: Vec<(Symbol, Expr)> =
            other.coordinates.iter().map(|c| (c.position, g.variable(c.velocity))).collect();
        let positions: Vec<Expr> =
            other.coordinates.iter().zip(shift).map(|(c, &s)| g.add(g.variable(c.position), s)).collect();
        let velocities: Vec<Expr> = positions.iter().map(|&q| g.total_derivative(q, &flow)).collect();
        let old = other.positions().into_iter().chain(other.velocities());
        let map: HashMap<Symbol, Expr> = old.zip(positions.iter().chain(&velocities).copied()).collect();
        let lagrangian = g.substitute(system.lagrangian, &map);
        let constraints = g.substitute_all(&system.constraints, &map);
        // the virtual work Q·δq with δq = ∂q/∂y δy
        let forces = g.substitute_all(&system.forces, &map);
        let forces = g.transpose_vec(&g.jacobian(&positions, &other.positions()), &forces);
        (other.lagrangian, other.constraints, other.forces) = (lagrangian, constraints, forces);
        Rewritten { system: other, positions, velocities }
    }

    /// Equations in the new coordinates whose outputs are the old ones.
    pub fn outputs(&self, mut equations: Equations) -> Equations {
        equations.coordinates = self.positions.clone();
        equations.velocities = self.velocities.clone();
        equations.chart = None;
        equations
    }
}

/// The augmented system of a removal (T2): coordinates `(q, u)`, `L(q, q̇, t)`, `Q` on `q`, `q̇ = Φ(u̇, q,
/// t)`.
///
/// A parameter that is a coordinate is that coordinate. The removal's `q` must be parameters or memory, and
/// `L` of first order in `u`. The vakonomic multiplier of `ẇ_k − B_k` is `μ_k = −P_k − ∂L/∂ẇ_k`.
pub fn augmented(system: &System, removal: &Removal) -> System {
    let mut names: Vec<String> = system.coordinates.iter().map(|c| c.name.clone()).collect();
    let g = system.graph.clone();
    names.extend(removal.parameters.iter().filter(|u| u.coordinate.is_none()).map(|u| g.name(u.symbol)));
    let coordinates: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "1")).collect();
    let mut other = System::new(g, &coordinates);
    other.parameters = system.parameters.clone();
    other.breakpoints = system.breakpoints.clone();
    other.lagrangian = system.lagrangian;
    other.forces.iter_mut().zip(&system.forces).for_each(|(other, force)| *other = *force);
    let rate = |w: &mechanics::MemoryVariable| other.graph.symbol(&format!("{}'", other.graph.name(w.symbol)));
    let constraints = removal.memory.iter().map(|w| other.graph.sub(other.graph.variable(rate(w)), w.rate)).collect();
    other.constraints = constraints;
    other
}
