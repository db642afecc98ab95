//! Discrete variational principles: the three formulations without one equation of motion.
//!
//! Time is cut into steps `h`; on the interval from node `k` to node `k+1` every function is taken at the midpoint, with
//! `x̄ = (x_k + x_{k+1})/2`, `ẋ ≈ (x_{k+1} − x_k)/h`, `t̄ = t_k + h/2`. What is differentiated is a sum over the intervals, with respect to
//! the nodes (`D₁`, `D₂`: with respect to the left and the right one); no time derivative of an expression is ever taken.
//!
//! **Chetaev** ([`Discrete::chetaev`], discrete Lagrange–d'Alembert principle). `L_d = h L`, `f_d = f`, `Q_d = h Q` at the midpoint:
//!
//! ```text
//! D₂L_d(k−1,k) + D₁L_d(k,k+1) + ½ Q_d(k−1,k) + ½ Q_d(k,k+1) + A_kᵀ κ_k = 0 ,      f_d(k,k+1) = 0 ,      κ_k ≈ h λ .
//! ```
//!
//! `A_k = ∂f/∂v` (h×n) stands at the node: `v ≈ (q_{k+1} − q_{k−1})/2h` where `f` is not linear in `v`.
//!
//! **Vakonomic** ([`Discrete::vakonomic`]). `S = Σ h (L + μ_{k+½}·f)` is stationary in all inner `q_k` and in all `μ_{k+½}` (h):
//!
//! ```text
//! D₂S(k−1,k) + D₁S(k,k+1) = 0 ,      f_d(k,k+1) = 0 .
//! ```
//!
//! **Removed constraint** ([`Discrete::removed`]). `S = Σ [ h L + P_{k+½}·(h B − (w_{k+1} − w_k)) ]` is stationary in all inner `u_k` (m)
//! and `w_k` (k), and in all `P_{k+½}` (k). At the last node `w_N` is free, `D₂S(N−1,N) = 0` there, which is `P_N = 0` with
//! `P_{k+1} = P_{k+½} − ½h G_w`, `G = L + P·B`. Not for removals that bring `ü` into `L` or `B`, or `u̇` into `q`.
//!
//! All three are marched with node momenta, `p_{k+1} = D₂S(k,k+1)` and `p_k + D₁S(k,k+1) [+ A_kᵀκ] = 0`, from `p₀ = L_v + Aᵀμ₀` (Chetaev:
//! `L_v`) and `p₀ = (G_u̇, −P₀)`.
//!
//! **Order 2, with an error that is a power series in `h²`.** Exchange the nodes of an interval and the sign of `h`: the midpoint, the
//! difference quotient, `S` up to its sign, and so all equations stay as they are. A two-sided sequence of nodes is then its own mirror,
//! and the difference equation is solved by curves `x(t) = Σ h²ʲ x_j(t)`. The vakonomic and the removed equations are the implicit midpoint
//! rule in `(x, p)`, a symmetric map from node to node, and nothing more is to be shown. Chetaev's start has to fit: with `κ₀` left open,
//! `p₀` fixes `D₁L_d(0,1)` up to `range A₀ᵀ`, as it does `D₂L_d(−1,0)` for the step backwards with `−h`; both steps together solve the
//! equation of node 0 with some reaction, so that the start is symmetric too. For nonlinear `f` this holds only if both have the same `A₀`.
//! With `A(q₀, v₀)` it would not be the `A₀` of the difference equation, `v₀ − (q₁ − q₋₁)/2h = O(h²)`, times `κ₀ = O(h)`, and put a term
//! `h³` into the error (order 3 after one extrapolation instead of 4). So there `q₋₁` is solved for together with `q₁`. `A` is not taken
//! at the midpoints, because the momenta across the constraint would then alternate from node to node.
//!
//! Hence Richardson's extrapolation over halvings of `h` gains two orders a level: [`convergence`].
//!
//! Sources: J. E. Marsden, M. West, *Discrete mechanics and variational integrators*, Acta Numerica 10 (2001); J. Cortés, S. Martínez,
//! *Non-holonomic integrators*, Nonlinearity 14 (2001); M. de León, J. C. Marrero, D. Martín de Diego, *Vakonomic
//! mechanics versus non-holonomic mechanics*, J. Geom. Phys. 35 (2000); R. Benito, D. Martín de Diego, *Discrete vakonomic mechanics*,
//! J. Math. Phys. 46 (2005); for the symmetry argument E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, chapter V. The
//! discrete removed action is derived here.

use mechanics::{Removal, State, System, complete_removal_start};
use nalgebra::DMatrix;
use symbolic::{Expr, Symbol, Tape};

mod convergence;
mod error;
mod natural;
mod start;
mod step;
#[cfg(test)]
mod tests;

pub use convergence::{Convergence, convergence};
pub use error::DiscreteError;
use natural::Natural;
use start::{
    check_length, check_start, fresh_symbols, numbers, refuse_forces, substituted_lagrangian, values, with_zeros,
};
use step::{Interval, Node, Principle, Step, check_finite};

/// Largest `|f_i| / (|A_i| (1 + |v|))` of a start.
pub const START_LIMIT: f64 = 1e-9;

/// A discrete motion over `[t₀, t₁]` (`t₁ < t₀`: backwards), for any number of steps. Clone it for another thread.
///
/// ```
/// use referees::discrete::Discrete;
/// let scene = mechanics::Scene::parse("sledge", include_str!("../../../../validation/scenes/sledge.toml"))?;
/// let mut discrete = Discrete::chetaev(&scene.system, &scene.start, 1.0)?;
/// let q = discrete.positions(200)?;
/// // φ = 0.3 + 1.1 t exactly, x by its integral to order h²
/// assert!((q[200][2] - 1.4).abs() < 1e-12);
/// let (g, s) = (9.81 * 0.4_f64.sin(), (1.4_f64.sin() - 0.3_f64.sin()) / 1.1);
/// assert!((q[200][0] - (0.5 * s + g * s * s / 2.0)).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Discrete {
    step: Step,
    start: Node,
    end: f64,
    /// First guess for rates and multipliers.
    guess: Vec<f64>,
    /// `q` from `(t, u, w)`, for removals.
    coordinates: Option<Tape>,
    /// How the start depends on `P₀`, for removals.
    costates: Option<Natural>,
    ends: Ends,
}

/// What holds at the ends of a removed motion; the other motions know only the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// `P₀` as given.
    GivenStart,
    /// `w_N` is free: `P_N = 0`, and `P₀` follows from it.
    Natural,
}

/// Where a removed motion starts.
#[derive(Clone, Debug, PartialEq)]
pub struct RemovedStart {
    /// `t₀`.
    pub t: f64,
    /// `u₀`, length m.
    pub parameters: Vec<f64>,
    /// `u̇₀`, length m.
    pub rates: Vec<f64>,
    /// `w₀`, length k.
    pub memory: Vec<f64>,
    /// `P₀`, length k; with [`Ends::Natural`] a first guess.
    pub costates: Vec<f64>,
}

impl RemovedStart {
    /// The values of `(u, u̇, w)` that belong to `state`, with `costates` one a memory variable.
    ///
    /// # Errors
    /// [`DiscreteError::Removal`].
    pub fn at(system: &System, removal: &Removal, state: &State, costates: &[f64]) -> Result<Self, DiscreteError> {
        let values = complete_removal_start(system, removal, state)?.values();
        let read = |symbols: &mut dyn Iterator<Item = Symbol>| -> Vec<f64> {
            symbols.map(|s| values.get(&s).copied().unwrap_or(f64::NAN)).collect()
        };
        Ok(RemovedStart {
            t: state.t,
            parameters: read(&mut removal.parameters.iter().map(|u| u.symbol)),
            rates: read(&mut removal.parameters.iter().map(|u| u.rate)),
            memory: read(&mut removal.memory.iter().map(|w| w.symbol)),
            costates: costates.to_vec(),
        })
    }
}

impl Discrete {
    /// The discrete Lagrange–d'Alembert motion from `start` to the time `end`.
    ///
    /// # Errors
    /// [`DiscreteError::NoFreedom`], [`DiscreteError::Length`], [`DiscreteError::OffConstraint`], [`DiscreteError::NotFinite`],
    /// [`DiscreteError::Compile`].
    pub fn chetaev(system: &System, start: &State, end: f64) -> Result<Self, DiscreteError> {
        let system = system.clone();
        check_start(&system, start)?;
        let (g, x, v) = (&system.graph, system.positions(), system.velocities());
        let interval = Interval::new(g, system.time, x.len());
        let (midpoint, node) = (interval.midpoint(g, &x, &v), interval.node(g, &x, &v));
        let h = g.variable(interval.h);
        let half = g.mul(g.ratio(1, 2), h);
        let multipliers = fresh_symbols(g, "reaction", system.constraints.len());
        let jacobian = g.jacobian(&system.constraints, &v);
        let reaction = g.substitute_all(&g.transpose_vec(&jacobian, &g.variables(&multipliers)), &node);
        let forces = g.substitute_all(&system.forces, &midpoint);
        let principle = Principle {
            action: g.mul(h, g.substitute(system.lagrangian, &midpoint)),
            impulse: forces.into_iter().map(|force| g.mul(half, force)).collect(),
            reaction,
            conditions: g.substitute_all(&system.constraints, &midpoint),
            multipliers,
        };
        let p = numbers(g, &g.gradient(system.lagrangian, &v), &values(&system, start))?;
        let guess = with_zeros(&start.v, system.constraints.len());
        let step = Step::new(g, &system.parameter_values(), &interval, &principle)?;
        let start = Node { t: start.t, x: start.q.clone(), p, rate_before: start.v.clone() };
        Discrete::new(step, start, end, guess, None)
    }

    /// The motion of stationary discrete vakonomic action from `start` and the multipliers `μ₀` (h) to the time `end`.
    ///
    /// # Errors
    /// Those of [`Discrete::chetaev`], [`DiscreteError::Force`].
    pub fn vakonomic(system: &System, start: &State, multipliers: &[f64], end: f64) -> Result<Self, DiscreteError> {
        let system = system.clone();
        check_start(&system, start)?;
        refuse_forces(&system)?;
        check_length("multipliers", multipliers, system.constraints.len())?;
        let (g, x, v) = (&system.graph, system.positions(), system.velocities());
        let interval = Interval::new(g, system.time, x.len());
        let midpoint = interval.midpoint(g, &x, &v);
        let symbols = fresh_symbols(g, "multiplier", multipliers.len());
        let augmented = g.add(system.lagrangian, g.dot(&g.variables(&symbols), &system.constraints));
        let principle = Principle {
            action: g.mul(g.variable(interval.h), g.substitute(augmented, &midpoint)),
            impulse: vec![g.zero(); x.len()],
            reaction: vec![g.zero(); x.len()],
            conditions: g.substitute_all(&system.constraints, &midpoint),
            multipliers: symbols.clone(),
        };
        let mut at_start = values(&system, start);
        at_start.extend(symbols.iter().copied().zip(multipliers.iter().copied()));
        let p = numbers(g, &g.gradient(augmented, &v), &at_start)?;
        let guess = start.v.iter().chain(multipliers).copied().collect();
        let step = Step::new(g, &system.parameter_values(), &interval, &principle)?;
        let start = Node { t: start.t, x: start.q.clone(), p, rate_before: start.v.clone() };
        Discrete::new(step, start, end, guess, None)
    }

    /// The motion of stationary discrete action in `(u, w)` of a removal, from `start` to the time `end`, which is the horizon of
    /// [`Ends::Natural`].
    ///
    /// # Errors
    /// [`DiscreteError::HighRate`], [`DiscreteError::Force`], [`DiscreteError::Length`], [`DiscreteError::NotFinite`],
    /// [`DiscreteError::Compile`].
    pub fn removed(
        system: &System,
        removal: &Removal,
        start: &RemovedStart,
        end: f64,
        ends: Ends,
    ) -> Result<Self, DiscreteError> {
        let system = system.clone();
        refuse_forces(&system)?;
        let (m, k) = (removal.parameters.len(), removal.memory.len());
        check_length("parameters", &start.parameters, m)?;
        check_length("rates of the parameters", &start.rates, m)?;
        check_length("memory variables", &start.memory, k)?;
        check_length("costates", &start.costates, k)?;
        let g = &system.graph;
        let lagrangian = substituted_lagrangian(&system, removal)?;
        let mut x: Vec<Symbol> = removal.parameters.iter().map(|u| u.symbol).collect();
        x.extend(removal.memory.iter().map(|w| w.symbol));
        let mut rates: Vec<Symbol> = removal.parameters.iter().map(|u| u.rate).collect();
        rates.extend(fresh_symbols(g, "memory_rate", k));
        let costates = fresh_symbols(g, "costate", k);
        let interval = Interval::new(g, system.time, m + k);
        let midpoint = interval.midpoint(g, &x, &rates);
        // h L + P·(h B − (w_{k+1} − w_k)) = h (L + P·(B − ẇ))
        let slips: Vec<Expr> = (0..k).map(|i| g.sub(removal.memory[i].rate, g.variable(rates[m + i]))).collect();
        let augmented = g.add(lagrangian, g.dot(&g.variables(&costates), &slips));
        let principle = Principle {
            action: g.mul(g.variable(interval.h), g.substitute(augmented, &midpoint)),
            impulse: vec![g.zero(); m + k],
            reaction: vec![g.zero(); m + k],
            conditions: g.substitute_all(&slips, &midpoint),
            multipliers: costates.clone(),
        };
        let mut values = system.parameter_values();
        values.insert(system.time, start.t);
        let rest: Vec<f64> = start.parameters.iter().chain(&start.memory).copied().collect();
        values.extend(x.iter().copied().zip(rest.iter().copied()));
        values.extend(rates.iter().copied().zip(start.rates.iter().copied()));
        values.extend(costates.iter().copied().zip(start.costates.iter().copied()));
        // B does not contain ẇ.
        let memory_rates = numbers(g, &removal.memory.iter().map(|w| w.rate).collect::<Vec<_>>(), &values)?;
        values.extend(rates[m..].iter().copied().zip(memory_rates.iter().copied()));
        let momenta = g.gradient(augmented, &rates);
        let p = numbers(g, &momenta, &values)?;
        let slopes = numbers(g, g.jacobian(&momenta, &costates).entries(), &values)?;
        check_finite("a slope of a momentum", start.t, &slopes)?;
        let slopes = DMatrix::from_row_slice(m + k, k, &slopes);
        let first: Vec<f64> = start.rates.iter().chain(&memory_rates).copied().collect();
        let guess = first.iter().chain(&start.costates).copied().collect();
        let step = Step::new(g, &system.parameter_values(), &interval, &principle)?;
        let inputs: Vec<Symbol> = std::iter::once(system.time).chain(x).collect();
        let coordinates = g.compile(&inputs, &removal.coordinates, &system.parameter_values())?;
        let node = Node { t: start.t, x: rest, p, rate_before: first };
        let costates = Some(Natural { first: start.costates.clone(), slopes });
        Ok(Discrete { costates, ends, ..Discrete::new(step, node, end, guess, Some(coordinates))? })
    }

    fn new(
        step: Step,
        start: Node,
        end: f64,
        guess: Vec<f64>,
        coordinates: Option<Tape>,
    ) -> Result<Self, DiscreteError> {
        for (what, values) in [
            ("a time", [start.t, end].as_slice()),
            ("a start value", &start.x),
            ("a momentum", &start.p),
            ("a start value", &guess),
        ] {
            check_finite(what, start.t, values)?;
        }
        Ok(Discrete { step, start, end, guess, coordinates, costates: None, ends: Ends::GivenStart })
    }

    /// Time of the node `k` of `steps`.
    pub fn time(&self, k: usize, steps: usize) -> f64 {
        self.start.t + (self.end - self.start.t) * (k as f64 / steps as f64)
    }

    /// `q_0, …, q_N` (each n) on the equidistant grid of `steps` steps.
    ///
    /// # Errors
    /// [`DiscreteError::TooFew`], [`DiscreteError::NotFinite`], [`DiscreteError::Singular`], [`DiscreteError::NotConverged`];
    /// [`DiscreteError::NoNaturalEnd`].
    pub fn positions(&mut self, steps: usize) -> Result<Vec<Vec<f64>>, DiscreteError> {
        let nodes = self.nodes(steps)?;
        let Some(tape) = &self.coordinates else { return Ok(nodes.into_iter().map(|node| node.x).collect()) };
        let mut workspace = tape.workspace();
        let mut positions = Vec::with_capacity(nodes.len());
        for node in nodes {
            let inputs: Vec<f64> = std::iter::once(node.t).chain(node.x).collect();
            let mut q = vec![0.0; tape.outputs()];
            tape.evaluate(&inputs, &mut workspace, &mut q);
            check_finite("a coordinate", node.t, &q)?;
            positions.push(q);
        }
        Ok(positions)
    }

    /// The momenta `p_0, …, p_N` at the nodes: `D₂S` of the interval before (the start has that of `(q₀, v₀)`). Length n; for a removal
    /// `(p_u, −P)`, length m + k.
    ///
    /// # Errors
    /// As [`Discrete::positions`].
    pub fn momenta(&mut self, steps: usize) -> Result<Vec<Vec<f64>>, DiscreteError> {
        Ok(self.nodes(steps)?.into_iter().map(|node| node.p).collect())
    }

    fn nodes(&mut self, steps: usize) -> Result<Vec<Node>, DiscreteError> {
        if steps == 0 {
            return Err(DiscreteError::TooFew { what: "the number of steps", found: 0, limit: 1 });
        }
        match (&self.costates, self.ends) {
            (Some(natural), Ends::Natural) => natural.clone().shoot(self, steps),
            _ => self.march(self.start.clone(), steps),
        }
    }

    fn march(&mut self, mut node: Node, steps: usize) -> Result<Vec<Node>, DiscreteError> {
        let h = (self.end - self.start.t) / steps as f64;
        let mut unknowns = self.guess.clone();
        let mut nodes = Vec::with_capacity(steps + 1);
        self.step.start(&mut node, h, &mut unknowns)?;
        for k in 1..=steps {
            if k > 1 {
                self.step.solve(&node, h, &mut unknowns)?;
            }
            let next = self.step.next(&node, h, &unknowns, self.time(k, steps))?;
            nodes.push(std::mem::replace(&mut node, next));
        }
        nodes.push(node);
        Ok(nodes)
    }
}
