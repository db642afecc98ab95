//! Quasi-velocities: the velocities that linear constraints admit, as a recursion as long as the constraints are.
//!
//! With `f = A v + b`, the constraints are eliminated one by one, sparsely, and every dependent velocity becomes a short combination of others:
//!
//! ```text
//! v_k = Σ S_kj v_j + s_k ,     v_j a quasi-velocity w or a velocity defined earlier;  S, s in (q, t).
//! ```
//!
//! What stands first is preferred as a pivot: constant coefficients (regular everywhere); a pair `a v₁ + b v₂` with constant `a² + b²`, by
//! way of a quasi-velocity `w` with `v₁ = b w + …`, `v₂ = −a w + …` (the speed along a blade; regular everywhere); else a coefficient that is
//! large at the start, which becomes a guard. Among equals the pivot that fills least (Markowitz), then the latest coordinate.

use std::collections::{BTreeSet, HashMap, HashSet};

use symbolic::{Expr, Symbol};

use crate::Frame;
use equations::Definitions;
use mechanics::{RemovalError, State, System};

mod columns;
mod elimination;

pub use columns::Columns;
use elimination::Elimination;

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
    /// Index of the coordinate whose velocity it is, or of the velocity of the frame; none for a quasi-velocity that turned out to be dependent.
    pub coordinate: Option<usize>,
    /// Quasi-velocities and earlier dependent velocities, with their coefficients in `(q, t)`.
    pub terms: Vec<(Symbol, Expr)>,
    /// What is left at rest, in `(q, t)`.
    pub offset: Expr,
}

/// How a constraint was eliminated, for multipliers. With `ρ` the value of its row at that moment, the velocities that it defined are
/// `v_k = … + slope_k ρ`, and `added · ρ` went into the rows of constraints eliminated later. So where `δ(p·v − L) = μ·δf` along every `δv`, and
/// `v̄_k` is the derivative of `p·v − L` by `v_k` by way of all velocities that contain it,
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
    /// Whether `b = 0`: the admissible velocities are a linear space.
    pub homogeneous: bool,
}

impl QuasiVelocities {
    /// Eliminates the constraints of `system`, from the velocities of `frame` or, without one, of the coordinates. Where a pivot has to be chosen by
    /// its size, that at `start` counts; without a start, that at a point of no significance.
    ///
    /// # Errors
    /// [`RemovalError::NotLinear`] where a constraint is not linear in `v`; [`RemovalError::Dependent`] where the rows of `A` are dependent.
    pub fn new(system: &System, frame: Option<&Frame>, start: Option<&State>) -> Result<Self, RemovalError> {
        let mut elimination = Elimination::new(system, frame, start)?;
        let homogeneous = elimination.is_homogeneous();
        while elimination.step()? {}
        let steps = std::mem::take(&mut elimination.steps);
        let dependent: Vec<DependentVelocity> = steps.into_iter().rev().flatten().collect();
        let coefficients = std::mem::take(&mut elimination.coefficients);
        let guards = std::mem::take(&mut elimination.guards);
        let eliminated = std::mem::take(&mut elimination.eliminated);
        let free = elimination.free(&dependent.iter().map(|d| d.symbol).collect::<HashSet<Symbol>>());
        Ok(QuasiVelocities { free, dependent, eliminated, coefficients, guards, homogeneous })
    }

    /// The dependent velocities that are a constant multiple of another one, as such.
    pub fn multiples(&self, system: &System) -> HashMap<Symbol, Expr> {
        let g = &system.graph;
        let parameters: BTreeSet<Symbol> = system.parameters.iter().map(|p| p.symbol).collect();
        let multiple = |d: &DependentVelocity| match d.terms[..] {
            [(s, e)] if g.is_zero(d.offset) && g.symbols_of(e).is_subset(&parameters) => {
                Some((d.symbol, g.mul(e, g.variable(s))))
            }
            _ => None,
        };
        self.dependent.iter().filter_map(multiple).collect()
    }
}
