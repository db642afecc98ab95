//! Virtual work of generalized forces on what the parametrization varies.

use mechanics::{Removal, System};
use symbolic::{Expr, Symbol};

/// `Q·δq = Q_u·δu + Q_u̇·δu̇ + Q_w·δw`, in `(ü, u̇, u, w, t)`.
pub(crate) struct Work {
    /// `Q_u = (∂q/∂u)ᵀ Q`.
    pub(crate) by_parameter: Vec<Expr>,
    /// `Q_u̇ = (∂q/∂u̇)ᵀ Q`: positions may contain `u̇`.
    pub(crate) by_rate: Vec<Expr>,
    /// `Q_w = (∂q/∂w)ᵀ Q`.
    pub(crate) by_memory: Vec<Expr>,
}

impl Work {
    pub(crate) fn new(system: &System, removal: &Removal) -> Self {
        let g = &system.graph;
        let forces: Vec<Expr> = system.forces.iter().map(|&force| removal.rewrite(system, force)).collect();
        let on = |s: Symbol| g.dot(&forces, g.jacobian(&removal.coordinates, &[s]).entries());
        Work {
            by_parameter: removal.parameters.iter().map(|u| on(u.symbol)).collect(),
            by_rate: removal.parameters.iter().map(|u| on(u.rate)).collect(),
            by_memory: removal.memory.iter().map(|w| on(w.symbol)).collect(),
        }
    }

    pub(crate) fn all(&self) -> Vec<Expr> {
        [&self.by_parameter[..], &self.by_rate, &self.by_memory].concat()
    }
}
