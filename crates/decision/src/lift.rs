//! The parameters and memory variables of a removal along a curve `q(t)`, where they are no coordinates.

use equations::Equations;
use mechanics::{Removal, RemovalStart, State, System, complete_removal_start};
use symbolic::{Expr, Symbol};

use crate::DecisionError;
use crate::family::inputs;
use crate::program::Program;

/// `u` and `w` that are no coordinates: integrated beside the curve, with `u̇` and `ü` from `q̇(u̇, u, w, t) = v` and its rate.
#[derive(Clone)]
pub(crate) struct Lift {
    /// Integrated `u` then `w`; then `u̇`, then `ü`.
    pub(crate) symbols: Vec<Symbol>,
    /// Number of `u` and of `w`.
    pub(crate) parameters: usize,
    pub(crate) memory: usize,
    pub(crate) coordinates: usize,
    /// `∂q̇/∂u̇` (n×m'), then `q̇ − v` at `u̇ = 0`.
    pub(crate) velocities: Program,
    /// `q̈ − a` at `ü = 0`, then the rates of `w` at `ü = 0`.
    pub(crate) accelerations: Program,
    system: System,
    removal: Removal,
}

impl Lift {
    /// `None` where every variable of `removal` is a coordinate.
    pub(crate) fn new(
        system: &System,
        removal: &Removal,
        equations: &Equations,
    ) -> Result<Option<Self>, DecisionError> {
        let g = &system.graph;
        let unsuited = |reason: String| DecisionError::Unsuited { formulation: equations.formulation, reason };
        let own: Vec<_> = removal.parameters.iter().filter(|u| u.coordinate.is_none()).collect();
        let memory: Vec<_> = removal.memory.iter().filter(|w| w.coordinate.is_none()).collect();
        if own.is_empty() && memory.is_empty() {
            return Ok(None);
        }
        let rates: Vec<Symbol> = own.iter().map(|u| u.rate).collect();
        let seconds: Vec<Symbol> = own.iter().map(|u| u.second_rate).collect();
        let by_second = |e: Expr| removal.parameters.iter().any(|u| g.depends_on(e, u.second_rate));
        let slopes = g.jacobian(&equations.velocities, &rates);
        let bent = slopes.entries().iter().any(|&e| rates.iter().any(|&s| g.depends_on(e, s)));
        let second = equations.velocities.iter().chain(memory.iter().map(|w| &w.rate)).any(|&e| by_second(e));
        if bent || second {
            let what = if second { "contain second rates of" } else { "are not linear in the rates of" };
            return Err(unsuited(format!(
                "removal `{}`: velocities {what} its parameters, and a curve q(t) does not tell these without more start data",
                removal.name
            )));
        }
        let at_rest = rates.iter().map(|&s| (s, g.zero())).collect();
        let mut first = slopes.entries().to_vec();
        for (c, &v) in system.coordinates.iter().zip(&equations.velocities) {
            first.push(g.sub(g.substitute(v, &at_rest), g.variable(c.velocity)));
        }
        let coasting = seconds.iter().map(|&s| (s, g.zero())).collect();
        let flow = removal.flow(system);
        let mut then: Vec<Expr> = Vec::new();
        for (c, &v) in system.coordinates.iter().zip(&equations.velocities) {
            let rate = g.substitute(g.total_derivative(v, &flow), &coasting);
            then.push(g.sub(rate, g.variable(c.acceleration)));
        }
        then.extend(memory.iter().map(|w| w.rate));
        let mut symbols: Vec<Symbol> = own.iter().map(|u| u.symbol).chain(memory.iter().map(|w| w.symbol)).collect();
        let velocities = Program::new(g, &inputs(system, &symbols), &first)?;
        symbols.extend(&rates);
        let accelerations = Program::new(g, &inputs(system, &symbols), &then)?;
        symbols.extend(&seconds);
        Ok(Some(Lift {
            parameters: own.len(),
            memory: memory.len(),
            coordinates: system.dimension(),
            symbols,
            velocities,
            accelerations,
            system: system.clone(),
            removal: removal.clone(),
        }))
    }

    /// Values of the integrated `u` and `w` where the curve starts.
    pub(crate) fn start(&self, state: &State) -> Result<Vec<f64>, DecisionError> {
        let RemovalStart { parameters, memory, .. } = complete_removal_start(&self.system, &self.removal, state)?;
        let value = |s: &Symbol| parameters.get(s).or_else(|| memory.get(s)).copied().unwrap_or(0.0);
        Ok(self.symbols[..self.parameters + self.memory].iter().map(value).collect())
    }
}
