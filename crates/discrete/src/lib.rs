//! Discrete variational principles of nonholonomic systems: structure-preserving steps without equations of
//! motion.
//!
//! Time is cut into steps `h`; on the interval from node `k` to node `k+1` every function is taken at the
//! midpoint, with `x̄ = (x_k + x_{k+1})/2`, `ẋ ≈ (x_{k+1} − x_k)/h`, `t̄ = t_k + h/2`. Derivatives are by
//! nodes (`D₁`, `D₂`: the left and the right one), of a sum over the intervals; none is by time.
//!
//! **Chetaev** ([`Discrete::chetaev`], discrete d'Alembert). `L_d = h L`, `f_d = f`, `Q_d = h Q`, midpoints:
//!
//! ```text
//! D₂L_d(k−1,k) + D₁L_d(k,k+1) + ½ Q_d(k−1,k) + ½ Q_d(k,k+1) + A_kᵀ κ_k = 0 ,  f_d(k,k+1) = 0 ,  κ_k ≈ h λ .
//! ```
//!
//! `A_k = ∂f/∂v` (h×n) stands at the node, at `(q_k, v_k)`. The reaction is split between the two steps that
//! meet there, `κ_k = (h/2)(λ⁻ + λ⁺)`: the first half brings the state onto the constraint, `p_k = L_v(q_k,
//! v_k)` with `f(q_k, v_k) = 0`, the second makes the constraint hold on the next interval. So the step maps
//! `{f = 0}` onto itself, as RATTLE and the nonholonomic leapfrog of McLachlan and Perlmutter do.
//!
//! **Vakonomic** ([`Discrete::vakonomic`]). `S = Σ h (L + μ_{k+½}·f)` is stationary in all inner `q_k` and in
//! all `μ_{k+½}` (h):
//!
//! ```text
//! D₂S(k−1,k) + D₁S(k,k+1) = 0 ,      f_d(k,k+1) = 0 .
//! ```
//!
//! **Removed constraint** ([`Discrete::removed`]). `S = Σ [ h L + P_{k+½}·(h B − (w_{k+1} − w_k)) ]` is
//! stationary in all inner `u_k` (m) and `w_k` (k), and in all `P_{k+½}` (k), with `P_{k+1} = P_{k+½} − ½h
//! G_w`, `G = L + P·B`. Not for removals that bring `ü` into `L` or `B`, or `u̇` into `q`.
//!
//! All three are marched with node momenta, `p_{k+1} = D₂S(k,k+1)` and `p_k + D₁S(k,k+1) = 0` (Chetaev: with
//! the reactions), from `p₀ = L_v + Aᵀμ₀` (Chetaev: `L_v`) and `p₀ = (G_u̇, −P₀)`. Velocities and multipliers
//! at a node are those with `𝓛_ẋ = p_k` and `f = 0`.
//!
//! # What is kept
//! - The constraint, to round-off: `f = 0` at the nodes in the velocities there, `f_d = 0` on every interval.
//! - Reversibility. Exchange the nodes of an interval and the sign of `h`: the midpoint, the difference
//!   quotient, `S` up to its sign, so all equations stay as they are, `Φ_{−h} Φ_h = 1`. So the error is a
//!   power series in `h²`, and on integrable reversible motions the energy error stays bounded. On others it
//!   may wander: a nonholonomic flow is not symplectic, so steps cannot be either.
//! - Vakonomic and removed: `Φ_h` is the implicit midpoint rule in `(x, p)`, hence symplectic; `p` of a
//!   cyclic coordinate is constant to round-off.
//!
//! # Order
//! 2, and 4, 6, 8 by [`Composition`] of steps, some of them back in time. States are those of the nodes;
//! between nodes, [`Trajectory::at`] takes one shorter step from the node before.
//!
//! # Round-off
//! Each step is solved to round-off; positions and momenta are sums of increments of size `h`, compensated:
//! what a million steps lose is the round-off of the increments and not that of the sums.
//!
//! Sources: J. E. Marsden, M. West, *Discrete mechanics and variational integrators*, Acta Numerica 10
//! (2001); J. Cortés, S. Martínez, *Non-holonomic integrators*, Nonlinearity 14 (2001); R. McLachlan, M.
//! Perlmutter, *Integrators for nonholonomic mechanical systems*, J. Nonlinear Sci. 16 (2006); M. de León, J.
//! C. Marrero, D. Martín de Diego, *Vakonomic mechanics versus non-holonomic mechanics*, J. Geom. Phys. 35
//! (2000); R. Benito, D. Martín de Diego, *Discrete vakonomic mechanics*, J. Math. Phys. 46 (2005); for
//! symmetry and compositions E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, chapters II
//! and V. The discrete removed action is derived here.

use mechanics::{Removal, State, System};
use symbolic::{Expr, Symbol};

mod composition;
mod error;
mod newton;
mod removed_start;
mod start;
mod step;
mod sum;
mod trajectory;

pub use composition::Composition;
pub use error::DiscreteError;
use newton::check_finite;
pub use removed_start::RemovedStart;
use start::{
    check_length, check_start, fresh_symbols, numbers, refuse_forces, substituted_lagrangian, values, with_zeros,
};
use step::{Interval, Node, Principle, Step};
use sum::Compensated;
pub use symbolic::limits::NOTHING as START_LIMIT;
pub use trajectory::{Sample, Trajectory};

/// A discrete motion over `[t₀, t₁]` (`t₁ < t₀`: backwards), in any number of steps. Clone it per thread.
///
/// ```
/// use discrete::Discrete;
/// let scene = scene::Scene::parse("sledge", include_str!("../../scene/scenes/sledge.toml"))?;
/// let q = Discrete::chetaev(&scene.system, &scene.start, 1.0)?.trajectory(200)?.at(1.0)?.x;
/// // φ = 0.3 + 1.1 t exactly, x by its integral to order h²
/// assert!((q[2] - 1.4).abs() < 1e-12);
/// let (g, s) = (9.81 * 0.4_f64.sin(), (1.4_f64.sin() - 0.3_f64.sin()) / 1.1);
/// assert!((q[0] - (0.5 * s + g * s * s / 2.0)).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Discrete {
    /// One step.
    #[doc(hidden)]
    pub step: Step,
    composition: Composition,
    /// The node that it starts from.
    #[doc(hidden)]
    pub start: Node,
    end: f64,
}

impl Discrete {
    /// The discrete Lagrange–d'Alembert motion from `start` to the time `end`.
    ///
    /// # Errors
    /// [`DiscreteError::NoFreedom`], [`DiscreteError::Length`], [`DiscreteError::OffConstraint`],
    /// [`DiscreteError::NotFinite`], [`DiscreteError::Compile`].
    pub fn chetaev(system: &System, start: &State, end: f64) -> Result<Self, DiscreteError> {
        let system = system.clone();
        check_start(&system, start)?;
        let (g, x, v) = (&system.graph, system.positions(), system.velocities());
        let interval = Interval::new(g, system.time, x.len());
        let multipliers = fresh_symbols(g, "reaction", system.constraints.len());
        let jacobian = g.jacobian(&system.constraints, &v);
        let principle = Principle {
            lagrangian: system.lagrangian,
            forces: system.forces.clone(),
            reaction: Some(g.transpose_vec(&jacobian, &g.variables(&multipliers))),
            conditions: system.constraints.clone(),
            multipliers,
            x,
            rates: v.clone(),
        };
        let p = numbers(g, &g.gradient(system.lagrangian, &v), &values(&system, start))?;
        let guess = with_zeros(&start.v, system.constraints.len());
        let step = Step::new(g, &system.parameter_values(), &interval, &principle, &guess)?;
        Discrete::new(step, start.t, start.q.clone(), p, guess, end)
    }

    /// The motion of stationary discrete vakonomic action from `start` and multipliers `μ₀` (h) to `end`.
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
        let symbols = fresh_symbols(g, "multiplier", multipliers.len());
        let augmented = g.add(system.lagrangian, g.dot(&g.variables(&symbols), &system.constraints));
        let mut at_start = values(&system, start);
        at_start.extend(symbols.iter().copied().zip(multipliers.iter().copied()));
        let p = numbers(g, &g.gradient(augmented, &v), &at_start)?;
        let principle = Principle {
            lagrangian: augmented,
            forces: vec![g.zero(); x.len()],
            reaction: None,
            conditions: system.constraints.clone(),
            multipliers: symbols,
            x,
            rates: v,
        };
        let guess: Vec<f64> = start.v.iter().chain(multipliers).copied().collect();
        let step = Step::new(g, &system.parameter_values(), &interval, &principle, &guess)?;
        Discrete::new(step, start.t, start.q.clone(), p, guess, end)
    }

    /// The motion of stationary discrete action in `(u, w)` of a removal, from `start` to the time `end`.
    ///
    /// # Errors
    /// [`DiscreteError::HighRate`], [`DiscreteError::Force`], [`DiscreteError::Length`],
    /// [`DiscreteError::NotFinite`], [`DiscreteError::Compile`].
    pub fn removed(system: &System, removal: &Removal, start: &RemovedStart, end: f64) -> Result<Self, DiscreteError> {
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
        // h L + P·(h B − (w_{k+1} − w_k)) = h (L + P·(B − ẇ))
        let slips: Vec<Expr> = (0..k).map(|i| g.sub(removal.memory[i].rate, g.variable(rates[m + i]))).collect();
        let augmented = g.add(lagrangian, g.dot(&g.variables(&costates), &slips));
        let mut values = system.parameter_values();
        values.insert(system.time, start.t);
        let rest: Vec<f64> = start.parameters.iter().chain(&start.memory).copied().collect();
        values.extend(x.iter().copied().zip(rest.iter().copied()));
        values.extend(rates.iter().copied().zip(start.rates.iter().copied()));
        values.extend(costates.iter().copied().zip(start.costates.iter().copied()));
        // B does not contain ẇ.
        let memory_rates = numbers(g, &removal.memory.iter().map(|w| w.rate).collect::<Vec<_>>(), &values)?;
        values.extend(rates[m..].iter().copied().zip(memory_rates.iter().copied()));
        let p = numbers(g, &g.gradient(augmented, &rates), &values)?;
        let guess: Vec<f64> = [&start.rates[..], &memory_rates, &start.costates].concat();
        let principle = Principle {
            lagrangian: augmented,
            forces: vec![g.zero(); m + k],
            reaction: None,
            conditions: slips,
            multipliers: costates,
            x,
            rates,
        };
        let step = Step::new(g, &system.parameter_values(), &interval, &principle, &guess)?;
        Discrete::new(step, start.t, rest, p, guess, end)
    }

    /// `guess` are the rates and multipliers at the start.
    fn new(step: Step, t: f64, x: Vec<f64>, p: Vec<f64>, guess: Vec<f64>, end: f64) -> Result<Self, DiscreteError> {
        for (what, values) in
            [("a time", [t, end].as_slice()), ("a start value", &x), ("a momentum", &p), ("a start value", &guess)]
        {
            check_finite(what, t, values)?;
        }
        let (v, multipliers) = guess.split_at(step.size);
        let (v, multipliers) = (v.to_vec(), multipliers.to_vec());
        let start = Node { t, x: Compensated::new(x), p: Compensated::new(p), v, multipliers };
        Ok(Discrete { step, composition: Composition::Second, start, end })
    }

    /// The same motion in steps of the order of `composition`; without this, of order 2.
    pub fn composed(self, composition: Composition) -> Self {
        Discrete { composition, ..self }
    }

    /// Calls `visit` at every node, the start included.
    #[doc(hidden)]
    pub fn march(
        &mut self,
        mut node: Node,
        steps: usize,
        mut visit: impl FnMut(&mut Step, &Node) -> Result<(), DiscreteError>,
    ) -> Result<(), DiscreteError> {
        let h = (self.end - self.start.t) / steps as f64;
        self.step.forget();
        // momenta that leave a velocity open make no motion, though a finite step may have a solution
        self.step.read(&mut node.clone(), h)?;
        visit(&mut self.step, &node)?;
        for k in 1..=steps {
            let t = self.start.t + (self.end - self.start.t) * (k as f64 / steps as f64);
            self.composed_step(&mut node, h, t)?;
            visit(&mut self.step, &node)?;
        }
        Ok(())
    }

    /// Moves `node` by `h` to the time `t`.
    #[doc(hidden)]
    pub fn composed_step(&mut self, node: &mut Node, h: f64, t: f64) -> Result<(), DiscreteError> {
        let (lengths, begin) = (self.composition.lengths(), node.t);
        let mut done = 0.0;
        for (i, length) in lengths.iter().enumerate() {
            done += length;
            let to = if i + 1 == lengths.len() { t } else { begin + done * h };
            self.step.advance(node, length * h, to)?;
        }
        Ok(())
    }
}

/// Parts that are tested by themselves: for `tests/` of this crate, and for nobody else.
#[doc(hidden)]
pub mod parts {
    pub use crate::step::{Node, Step};
    pub use crate::sum::Compensated;
}
