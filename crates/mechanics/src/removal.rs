//! Removal of constraints: displacement parameters `u` and memory variables `w` make `f` hold identically.

use std::collections::{BTreeMap, HashMap};

use symbolic::{Expr, Symbol, Vanishing};

use crate::{RemovalError, System};

/// A new displacement parameter `u`, or a coordinate that serves as one.
#[derive(Clone, Debug)]
pub struct DisplacementParameter {
    /// Symbol of `u`.
    pub symbol: Symbol,
    /// Symbol of `u̇`.
    pub rate: Symbol,
    /// Symbol of `ü`.
    pub second_rate: Symbol,
    /// Index of the coordinate that this parameter is, if it is one.
    pub coordinate: Option<usize>,
}

/// A memory variable `w` with `ẇ = B(ü, u̇, u, w, t)`: what the paper writes as an integral over the past.
#[derive(Clone, Debug)]
pub struct MemoryVariable {
    /// Symbol of `w`.
    pub symbol: Symbol,
    /// `B(ü, u̇, u, w, t)`.
    pub rate: Expr,
    /// Index of the coordinate that this variable is, if it is one.
    pub coordinate: Option<usize>,
}

/// The free constants `P(t₀)` of the removed-constraint equations.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstantsRule {
    /// `P(t₀) = 0`.
    Zero,
    /// `P(t₀)` given, one value per free constant, in the order of the memory variables.
    Given(Vec<f64>),
    /// `P(t₁) = 0` at the horizon `t₁` (natural boundary condition, a boundary-value problem).
    Natural {
        /// `t₁`.
        horizon: f64,
    },
}

/// A parametrization that removes the constraints.
///
/// Every `qᵢ` is an expression in `(ü, u̇, u, w, t)`; `q̇ᵢ` is its time derivative with `ẇ = B`.
/// [`Removal::verify`] checks that `f` then vanishes identically.
#[derive(Clone, Debug)]
pub struct Removal {
    /// Name, unique among the removals of a scene.
    pub name: String,
    /// `u`, m of them.
    pub parameters: Vec<DisplacementParameter>,
    /// `w`, k of them.
    pub memory: Vec<MemoryVariable>,
    /// `q(u̇, u, w, t)`, length n.
    pub coordinates: Vec<Expr>,
    /// Start values of parameters, their rates and memory variables that are not coordinates, as expressions
    /// in `(q₀, v₀, t₀)`. What is left out is solved from `(q₀, v₀)`, nearest to zero.
    pub start: BTreeMap<Symbol, Expr>,
    /// The constants that a run uses by default.
    pub constants: ConstantsRule,
    /// What grows where other parameters should serve as `u`, in `(q, t)`: the coefficients of the rates.
    /// Empty where the parametrization is part of what was asked for.
    pub chart: Vec<Expr>,
}

impl Removal {
    /// Rates of all variables of the parametrization: `(u, u̇), (u̇, ü), (w, B), (t, 1)`.
    ///
    /// `ü` itself is held: an expression that contains `ü` has no first-order time derivative here.
    pub fn flow(&self, system: &System) -> Vec<(Symbol, Expr)> {
        let g = &system.graph;
        let mut rates = Vec::new();
        for u in &self.parameters {
            rates.push((u.symbol, g.variable(u.rate)));
            rates.push((u.rate, g.variable(u.second_rate)));
        }
        for w in &self.memory {
            rates.push((w.symbol, w.rate));
        }
        rates.push((system.time, g.one()));
        rates
    }

    /// `q̇(ü, u̇, u, w, t)`, length n.
    pub fn velocities(&self, system: &System) -> Vec<Expr> {
        let flow = self.flow(system);
        self.coordinates.iter().map(|&q| system.graph.total_derivative(q, &flow)).collect()
    }

    /// What vanishes at `(q, q̇)`, unless trivially: `qᵢ(u̇, u, w, t) − qᵢ` and its rate minus `q̇ᵢ`.
    pub fn residuals(&self, system: &System) -> Vec<Expr> {
        let g = &system.graph;
        let velocities = self.velocities(system);
        let pairs = system.coordinates.iter().zip(&self.coordinates).zip(&velocities);
        pairs
            .flat_map(|((c, &q), &v)| [g.sub(q, g.variable(c.position)), g.sub(v, g.variable(c.velocity))])
            .filter(|&e| !g.is_zero(e))
            .collect()
    }

    /// Rewrites an expression in `(q, v, t)` as one in `(ü, u̇, u, w, t)`.
    pub fn rewrite(&self, system: &System, e: Expr) -> Expr {
        let velocities = self.velocities(system);
        let mut map = HashMap::new();
        for (i, c) in system.coordinates.iter().enumerate() {
            map.insert(c.position, self.coordinates[i]);
            map.insert(c.velocity, velocities[i]);
        }
        system.graph.substitute(e, &map)
    }

    /// Substitutes the parametrization into every constraint; each must vanish identically. Whether all are
    /// seen to do so exactly, and not only at random points ([`symbolic::Graph::vanishes`]).
    ///
    /// # Errors
    /// [`RemovalError::ConstraintRemains`] with its residual and bound; [`RemovalError::NotCheckable`] where
    /// it is finite at too few of the points tried; [`RemovalError::WrongCount`] without `n − h` parameters.
    pub fn verify(&self, system: &System) -> Result<bool, RemovalError> {
        let expected = system.dimension().saturating_sub(system.constraints.len());
        if self.parameters.len() != expected {
            let (removal, found) = (self.name.clone(), self.parameters.len());
            return Err(RemovalError::WrongCount { removal, found, expected });
        }
        let g = &system.graph;
        let mut exactly = true;
        for (index, &f) in system.constraints.iter().enumerate() {
            let rest = self.rewrite(system, f);
            if g.vanishes_exactly(rest) {
                continue;
            }
            let verdict = system.vanishes(rest);
            exactly &= verdict == Vanishing::Exactly;
            if verdict.is_zero() {
                continue;
            }
            let (removal, constraint, text) = (self.name.clone(), index + 1, g.plain(f));
            return Err(match verdict {
                Vanishing::No { value: residual, bound: limit } => {
                    RemovalError::ConstraintRemains { removal, constraint, text, residual, limit }
                }
                _ => RemovalError::NotCheckable { removal, constraint, text },
            });
        }
        Ok(exactly)
    }
}
