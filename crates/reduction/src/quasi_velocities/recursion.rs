//! Quasi-velocities, and the dependent velocities as a recursion in them.

use std::collections::HashMap;

use equations::{Chart, Definitions, Equations, Statement};
use mechanics::System;
use symbolic::{Expr, Graph, Symbol};

use crate::Frame;

/// A quasi-velocity `w`.
#[derive(Clone, Debug)]
pub struct QuasiVelocity {
    /// Symbol of `w`; that of the velocity `q̇ᵢ` where it is one.
    pub symbol: Symbol,
    /// Symbol of `ẇ`.
    pub rate: Symbol,
    /// `w` in `(q, v, t)`.
    pub start: Expr,
    /// Index of the coordinate whose velocity it is, or of the velocity of the frame, if it is one.
    pub coordinate: Option<usize>,
}

/// A velocity that the constraints determine: `Σ coefficient · symbol + offset`.
#[derive(Clone, Debug)]
pub struct DependentVelocity {
    /// Symbol of the velocity.
    pub symbol: Symbol,
    /// The coordinate, or velocity of the frame, whose velocity it is; none for a dependent quasi-velocity.
    pub coordinate: Option<usize>,
    /// Quasi-velocities and earlier dependent velocities, with their coefficients in `(q, t)`.
    pub terms: Vec<(Symbol, Expr)>,
    /// What is left at rest, in `(q, t)`.
    pub offset: Expr,
}

/// How a constraint was eliminated, for multipliers. With `ρ` the value of its row at that moment, the
/// velocities that it defined are `v_k = … + slope_k ρ`, and `added · ρ` went into the rows of constraints
/// eliminated later. So where `δ(p·v − L) = μ·δf` along every `δv`, and `v̄_k` is the derivative of `p·v − L`
/// by `v_k` by way of all velocities that contain it,
///
/// ```text
/// μ = Σ slope_k v̄_k + Σ added · μ of the later ones .
/// ```
#[derive(Clone, Debug)]
pub struct EliminatedConstraint {
    /// Index of the constraint.
    pub constraint: usize,
    /// Symbols of the dependent velocities that it defined, with `∂v_k/∂ρ` in `(q, t)`.
    pub slopes: Vec<(Symbol, Expr)>,
    /// Indices of later constraints, with the factors in `(q, t)`.
    pub added: Vec<(usize, Expr)>,
}

/// `v = S(q, t) w + s(q, t)`, the general solution of `A v + b = 0`.
#[derive(Clone, Debug)]
pub struct QuasiVelocities {
    /// `w`, n − h of them.
    pub free: Vec<QuasiVelocity>,
    /// The dependent velocities, each after those that it contains.
    pub dependent: Vec<DependentVelocity>,
    /// The constraints in the order of their elimination.
    pub eliminated: Vec<EliminatedConstraint>,
    /// Longer coefficients, in `(q, t)`.
    pub coefficients: Definitions,
    /// Pivots that are not constant: where one of them vanishes, this choice of `w` breaks down.
    pub guards: Vec<Expr>,
    /// What was divided by those pivots, in `(q, t)`.
    pub quotients: Vec<Expr>,
    /// Whether `b = 0`: the admissible velocities are a linear space.
    pub homogeneous: bool,
}

impl DependentVelocity {
    /// `Σ coefficient · symbol + offset`.
    pub fn value(&self, g: &Graph) -> Expr {
        let terms: Vec<Expr> = self.terms.iter().map(|&(s, e)| g.mul(e, g.variable(s))).chain([self.offset]).collect();
        g.sum(&terms)
    }
}

impl QuasiVelocities {
    /// The dependent velocities that are a constant multiple of another one, as such.
    pub fn multiples(&self, system: &System) -> HashMap<Symbol, Expr> {
        let g = &system.graph;
        let multiple = |d: &DependentVelocity| match d.terms[..] {
            [(s, e)] if g.is_zero(d.offset) && system.is_constant(e) => Some((d.symbol, g.mul(e, g.variable(s)))),
            _ => None,
        };
        self.dependent.iter().filter_map(multiple).collect()
    }

    /// Hands over guards, chart and the dependent velocities, and those a frame was made from: defined, and
    /// stated for readers. `value`: how each is computed.
    pub(crate) fn hand_over(
        &self,
        g: &Graph,
        value: impl Fn(&DependentVelocity) -> Expr,
        frame: Option<&Frame>,
        equations: &mut Equations,
        definitions: &mut Definitions,
    ) {
        equations.guards = self.guards.clone();
        equations.chart = (!self.quotients.is_empty()).then(|| Chart {
            independent: self.free.iter().map(|w| g.name(w.symbol)).collect(),
            coefficients: self.quotients.clone(),
            may_vanish: !self.guards.is_empty(),
        });
        let dependent = self.dependent.iter().map(|d| (d.symbol, value(d)));
        for (symbol, velocity) in dependent.chain(frame.iter().flat_map(|f| f.recursion.iter().copied())) {
            definitions.define(symbol, velocity);
            let left = g.variable(symbol);
            equations.statements.push(Statement { meaning: "velocity".into(), left, right: velocity });
        }
    }
}
